#include "scene/finish_rules.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <tuple>

#include "scene/input_location.h"
#include "scene/polygon_area.h"

namespace luxel {
namespace {

// The rules that apply to a kind of face; null where none does.
struct Sources {
  const StatedFinish* mesh = nullptr;
  const FinishRule* material = nullptr;
  const FinishRule* surface = nullptr;

  // The value that counts: "surfaces" before "materials".
  template <typename Value>
  const std::optional<Value>& ruled(std::optional<Value> FinishRule::*key) const {
    static const std::optional<Value> none;
    if (surface && surface->*key) return surface->*key;
    return material ? material->*key : none;
  }

  const FinishRule* emission_rule() const {
    if (surface && surface->emission) return surface;
    return material && material->emission ? material : nullptr;
  }

  bool two_sided() const { return ruled(&FinishRule::two_sided).value_or(mesh->two_sided.value_or(false)); }
  bool states_reflectance() const { return mesh->reflectance || ruled(&FinishRule::reflectance); }
  bool states_emission() const { return mesh->emission || emission_rule(); }
};

// For each name of the mesh the rule with that name, or null.
std::vector<const FinishRule*> rules_by_number(const std::vector<FinishRule>& rules,
                                               const std::vector<std::string>& names) {
  std::vector<const FinishRule*> by_number(names.size(), nullptr);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto rule =
        std::find_if(rules.begin(), rules.end(), [&](const FinishRule& r) { return r.name == names[i]; });
    if (rule != rules.end()) by_number[i] = &*rule;
  }
  return by_number;
}

void check_names(const std::vector<FinishRule>& rules, const std::vector<std::string>& names,
                 const std::string& what, const std::filesystem::path& file) {
  for (const FinishRule& rule : rules) {
    if (std::find(names.begin(), names.end(), rule.name) != names.end()) continue;
    refuse({file, rule.line},
           what + " " + in_quotes(rule.name) + " is not in the mesh" + nearest_hint(rule.name, names));
  }
}

// The mesh has a material if a face uses it or a material library defines it.
std::vector<std::string> material_names(const SurfaceSoup& soup) {
  std::vector<std::string> names = soup.materials;
  for (const StatedFinish& stated : soup.stated) {
    if (!stated.name.empty()) names.push_back(stated.name);
  }
  return names;
}

// Faces with the same sources are of one kind.
struct FaceKinds {
  std::vector<int> of_face;
  std::vector<Sources> sources;
  std::vector<int> material;  ///< number of the material of each kind
  std::vector<std::size_t> face_counts;
};

FaceKinds face_kinds(const SurfaceSoup& soup, const SceneDescription& description) {
  const auto material_rules = rules_by_number(description.materials, soup.materials);
  const auto surface_rules = rules_by_number(description.surfaces, soup.groups);
  FaceKinds kinds;
  std::map<std::tuple<int, int, const FinishRule*>, int> numbers;
  kinds.of_face.reserve(soup.face_count());
  std::tuple<int, int, const FinishRule*> last{-1, -1, nullptr};
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::tuple key{soup.face_stated[f], soup.face_materials[f], surface_rules[soup.face_groups[f]]};
    int kind;
    if (key == last) {
      kind = kinds.of_face.back();
    } else {
      const auto [entry, is_new] = numbers.try_emplace(key, static_cast<int>(kinds.sources.size()));
      if (is_new) {
        kinds.sources.push_back(
            {&soup.stated[std::get<0>(key)], material_rules[std::get<1>(key)], std::get<2>(key)});
        kinds.material.push_back(std::get<1>(key));
        kinds.face_counts.push_back(0);
      }
      kind = entry->second;
      last = key;
    }
    kinds.of_face.push_back(kind);
    ++kinds.face_counts[kind];
  }
  return kinds;
}

// The area [m2] over which each rule that states power spreads it.
std::map<const FinishRule*, double> power_areas(const SurfaceSoup& soup, const FaceKinds& kinds) {
  std::map<const FinishRule*, std::vector<std::size_t>> faces;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const FinishRule* rule = kinds.sources[kinds.of_face[f]].emission_rule();
    if (rule && rule->emission->kind == EmissionRule::Kind::Power) faces[rule].push_back(f);
  }
  std::map<const FinishRule*, double> areas;
  for (const auto& [rule, of_rule] : faces) {
    const std::vector<bool> repeated = are_repeated(soup, of_rule);
    double area = 0;
    for (std::size_t i = 0; i < of_rule.size(); ++i) {
      const int sides = kinds.sources[kinds.of_face[of_rule[i]]].two_sided() ? 2 : 1;
      if (!repeated[i]) area += sides * face_area(soup, of_rule[i]);
    }
    areas[rule] = area;
  }
  return areas;
}

void check_power(const std::vector<FinishRule>& rules, const std::map<const FinishRule*, double>& areas,
                 const std::filesystem::path& file, std::vector<std::string>& warnings) {
  for (const FinishRule& rule : rules) {
    if (!rule.emission || rule.emission->kind != EmissionRule::Kind::Power) continue;
    const auto area = areas.find(&rule);
    if (area == areas.end()) {
      warnings.push_back(file.string() + ":" + std::to_string(rule.line) + ": power of " +
                         in_quotes(rule.name) + " leaves from no face");
    } else if (!(area->second > 0)) {
      refuse({file, rule.line}, "power of " + in_quotes(rule.name) + " has no area to leave from");
    }
  }
}

Rgb emission_of(const Sources& sources, const std::map<const FinishRule*, double>& areas) {
  const FinishRule* rule = sources.emission_rule();
  if (!rule) return sources.mesh->emission.value_or(Rgb::Zero());
  switch (rule->emission->kind) {
    case EmissionRule::Kind::Exitance:
      return rule->emission->value;
    case EmissionRule::Kind::Radiance:
      return std::numbers::pi * rule->emission->value;
    case EmissionRule::Kind::Power:
      break;
  }
  return rule->emission->value / areas.at(rule);
}

void warn_of_silence(const SurfaceSoup& soup, const FaceKinds& kinds, std::vector<std::string>& warnings) {
  std::size_t undescribed = 0, without_reflectance = 0;
  std::vector<std::string> undescribed_names, without_names;
  const auto add = [&](std::size_t kind, std::size_t& count, std::vector<std::string>& names) {
    const std::string& name = soup.materials[kinds.material[kind]];
    count += kinds.face_counts[kind];
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (std::size_t k = 0; k < kinds.sources.size(); ++k) {
    if (kinds.sources[k].states_reflectance()) continue;
    if (kinds.sources[k].states_emission()) {
      add(k, without_reflectance, without_names);
    } else {
      add(k, undescribed, undescribed_names);
    }
  }
  if (undescribed > 0) {
    warnings.push_back(counted(undescribed, "face") + " of material " + listed(undescribed_names) +
                       " described nowhere: reflectance 0.5, no emission");
  }
  if (without_reflectance > 0) {
    warnings.push_back(counted(without_reflectance, "face") + " of material " + listed(without_names) +
                       " without a stated reflectance: 0.5");
  }
}

}  // namespace

Finishes resolved_finishes(const SurfaceSoup& soup, const SceneDescription& description) {
  check_names(description.materials, material_names(soup), "material", description.file);
  check_names(description.surfaces, soup.groups, "surface", description.file);
  const FaceKinds kinds = face_kinds(soup, description);
  const std::map<const FinishRule*, double> areas = power_areas(soup, kinds);

  Finishes finishes;
  check_power(description.materials, areas, description.file, finishes.warnings);
  check_power(description.surfaces, areas, description.file, finishes.warnings);
  std::map<std::array<double, 7>, int> numbers;  // equal finishes stand once
  std::vector<int> finish_of_kind;
  for (const Sources& sources : kinds.sources) {
    Finish finish;
    finish.reflectance = sources.ruled(&FinishRule::reflectance)
                             .value_or(sources.mesh->reflectance.value_or(finish.reflectance));
    finish.emission = emission_of(sources, areas);
    finish.two_sided = sources.two_sided();
    const Rgb &rho = finish.reflectance, &e = finish.emission;
    const std::array<double, 7> key{rho[0], rho[1], rho[2], e[0], e[1], e[2], finish.two_sided ? 1.0 : 0.0};
    const auto [entry, is_new] = numbers.try_emplace(key, static_cast<int>(finishes.table.size()));
    if (is_new) finishes.table.push_back(finish);
    finish_of_kind.push_back(entry->second);
  }
  finishes.of_face.reserve(soup.face_count());
  for (const int kind : kinds.of_face) finishes.of_face.push_back(finish_of_kind[kind]);
  warn_of_silence(soup, kinds, finishes.warnings);
  return finishes;
}

}  // namespace luxel
