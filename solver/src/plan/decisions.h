#pragma once

#include <optional>
#include <vector>

#include "luxel/plan.h"

// What is left out, in words: each function tells one decision, or nothing where nothing is left out.
namespace luxel {

std::optional<LeftOut> dark_groups(int groups, int dark, int all);
/// The same where patches are worked on one by one, not in pairs; of one group at least.
LeftOut dark_senders(int groups, int dark, int all);
std::optional<LeftOut> lone_patches(int lone);
std::optional<LeftOut> pairs_between(const std::vector<SystemPlan>& systems);
/// Systems in which nothing can hide anything.
std::optional<LeftOut> left_rays(const std::vector<SystemPlan>& systems);
/// Polygons that cannot hide anything, in the other systems.
std::optional<LeftOut> idle_occluders(const std::vector<SystemPlan>& systems);
std::optional<LeftOut> dark_channels(const std::vector<SystemPlan>& systems);
std::optional<LeftOut> equal_channels(const std::vector<SystemPlan>& systems);
/// Patches with a reflectance of exactly 0 in every channel.
std::optional<LeftOut> black_patches(const PatchField& reflectance);

/// The same of one system of so many patches.
std::optional<LeftOut> dark_channels(const ChannelPlan& channels, int patches);
std::optional<LeftOut> equal_channels(const ChannelPlan& channels, int patches);

/// Rows of closed operators are right to 1e-12: a loss below this cannot be told from none, and is refused as
/// singular.
inline constexpr double smallest_loss = 1e-11;

/// All of so many patches as one closed enclosure.
Enclosures one_closed_enclosure(int patches);

/// Adds a decision if there is one.
void note(std::vector<LeftOut>& list, std::optional<LeftOut> decision);

}  // namespace luxel
