#include "plan/decisions.h"

#include <algorithm>
#include <string>

namespace luxel {

namespace {

// 12,345,678
std::string count(double value) {
  std::string text = std::to_string(static_cast<long long>(value));
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(at, 1, ',');
  return text;
}

std::string count(double value, const std::string& noun) {
  return count(value) + " " + noun + (value == 1 ? "" : "s");
}

std::string patches(double value) {
  return count(value) + (value == 1 ? " patch" : " patches");
}

double pairs(double size) {
  return size * (size - 1) / 2;
}

double size(const SystemPlan& system) {
  return static_cast<double>(system.patches.size());
}

/// Patches times channels of a kind.
template <class Kind>
double channel_unknowns(const std::vector<SystemPlan>& systems, const Kind& kind) {
  double unknowns = 0;
  for (const SystemPlan& system : systems) {
    for (const int source : system.channels.source) unknowns += kind(source) ? size(system) : 0;
  }
  return unknowns;
}

std::optional<LeftOut> dark_unknowns(double unknowns) {
  if (unknowns == 0) return std::nullopt;
  return LeftOut{"channels without emission", "their light is exactly 0", count(unknowns, "unknown")};
}

std::optional<LeftOut> equal_unknowns(double unknowns) {
  if (unknowns == 0) return std::nullopt;
  return LeftOut{"channels that follow from another",
                 "they have its reflectance on every patch and a multiple of its emission",
                 count(unknowns, "unknown")};
}

}  // namespace

LeftOut dark_senders(int groups, int dark, int all) {
  return {count(groups, "enclosure") + " of " + patches(dark),
          "nothing emits in them, so that their light is exactly 0",
          count(dark) + " of " + patches(all) + " as senders and receivers"};
}

std::optional<LeftOut> dark_groups(int groups, int dark, int all) {
  if (groups == 0) return std::nullopt;
  LeftOut told = dark_senders(groups, dark, all);
  told.saved = count(pairs(all) - pairs(all - dark)) + " of " + count(pairs(all)) + " pairs of patches";
  return told;
}

std::optional<LeftOut> lone_patches(int lone) {
  if (lone == 0) return std::nullopt;
  return LeftOut{patches(lone), "they see no other, so that B = E", count(lone, "unknown")};
}

std::optional<LeftOut> pairs_between(const std::vector<SystemPlan>& systems) {
  if (systems.size() < 2) return std::nullopt;
  double total = 0, inside = 0;
  for (const SystemPlan& system : systems) {
    total += size(system);
    inside += pairs(size(system));
  }
  return LeftOut{"form factors between " + count(static_cast<double>(systems.size())) + " parts of the scene",
                 "no light goes from one to another; each is a system of its own, one at a time in memory",
                 count(pairs(total) - inside) + " of " + count(pairs(total)) + " pairs of patches"};
}

std::optional<LeftOut> left_rays(const std::vector<SystemPlan>& systems) {
  double saved = 0;
  for (const SystemPlan& system : systems) {
    if (system.hiding_polygons == 0) saved += pairs(size(system));
  }
  if (saved == 0) return std::nullopt;
  return LeftOut{"every ray between patches, and what rays are traced against",
                 "no polygon has patches on both sides, so that none can hide anything",
                 "visibility of " + count(saved) + " pairs of patches"};
}

std::optional<LeftOut> idle_occluders(const std::vector<SystemPlan>& systems) {
  double idle = 0, all = 0;
  for (const SystemPlan& system : systems) {
    if (system.hiding_polygons == 0) continue;
    all += system.polygons;
    idle += system.polygons - system.hiding_polygons;
  }
  if (idle == 0) return std::nullopt;
  return LeftOut{count(idle, "polygon") + " as occluder" + (idle == 1 ? "" : "s"),
                 "they have patches on one side only and cannot hide anything",
                 count(idle) + " of " + count(all, "polygon")};
}

std::optional<LeftOut> dark_channels(const std::vector<SystemPlan>& systems) {
  return dark_unknowns(channel_unknowns(systems, [](int source) { return source < 0; }));
}

std::optional<LeftOut> dark_channels(const ChannelPlan& channels, int patches) {
  return dark_unknowns(static_cast<double>(std::count(channels.source.begin(), channels.source.end(), -1)) *
                       patches);
}

std::optional<LeftOut> equal_channels(const std::vector<SystemPlan>& systems) {
  double unknowns = 0;
  for (const SystemPlan& system : systems) {
    unknowns -= size(system) * static_cast<double>(system.channels.solved.size());
  }
  unknowns += channel_unknowns(systems, [](int source) { return source >= 0; });
  return equal_unknowns(unknowns);
}

std::optional<LeftOut> equal_channels(const ChannelPlan& channels, int patches) {
  const auto lit = static_cast<double>(channels.source.size()) -
                   static_cast<double>(std::count(channels.source.begin(), channels.source.end(), -1));
  return equal_unknowns((lit - static_cast<double>(channels.solved.size())) * patches);
}

std::optional<LeftOut> black_patches(const PatchField& reflectance) {
  int black = 0;
  for (Eigen::Index i = 0; i < reflectance.rows(); ++i) black += (reflectance.row(i).array() == 0).all();
  if (black == 0) return std::nullopt;
  return LeftOut{count(black) + (black == 1 ? " patch as unknown" : " patches as unknowns"),
                 "their reflectance is 0, so that B = E", count(black, "unknown")};
}

Enclosures one_closed_enclosure(int patches) {
  Enclosures one;
  one.closed = true;
  one.count = 1;
  one.enclosure.assign(patches, 0);
  one.enclosure_closed = {1};
  one.open_share.assign(patches, 0.0);
  one.back_share.assign(patches, 0.0);
  one.share_error.assign(patches, 0.0);
  one.share_rays.assign(patches, 0);
  return one;
}

void note(std::vector<LeftOut>& list, std::optional<LeftOut> decision) {
  if (decision) list.push_back(std::move(*decision));
}

}  // namespace luxel
