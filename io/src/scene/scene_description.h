#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "luxel/scene.h"

namespace luxel {

/// Emission as a scene file states it.
struct EmissionRule {
  enum class Kind {
    Exitance,  ///< E [W/m2]
    Radiance,  ///< L [W/(m2 sr)], E = pi L
    Power,     ///< flux of all faces that the rule applies to [W], E = flux / their area
  };
  Kind kind = Kind::Exitance;
  Rgb value = Rgb::Zero();
};

/// What an entry of "materials" or "surfaces" states; what it leaves out stays empty.
struct FinishRule {
  std::string name;  ///< of the material or group
  int line = 0;      ///< where the entry stands in the scene file
  std::optional<Rgb> reflectance;
  std::optional<EmissionRule> emission;
  std::optional<bool> two_sided;
};

/// A mesh file and where it goes.
struct MeshPlacement {
  std::filesystem::path file;
  int line = 0;                                             ///< where the scene file names it
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();  ///< before the unit is applied
};

/// A scene file, read and checked as far as that goes without its meshes.
struct SceneDescription {
  std::filesystem::path file;
  std::vector<MeshPlacement> meshes;
  double unit = 1;  ///< length of one unit [m]
  std::vector<FinishRule> materials;
  std::vector<FinishRule> surfaces;
  std::optional<Camera> camera;  ///< lengths in `unit`
};

}  // namespace luxel
