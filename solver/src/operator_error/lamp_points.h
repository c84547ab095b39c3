#pragma once

#include <span>
#include <vector>

#include "luxel/patch_mesh.h"
#include "operator_error/patch_square.h"

namespace luxel {

/// Points of what emits, drawn by power, from near lamps more often than from far ones. Knows nothing of the
/// gather's lamps.
class LampPoints {
 public:
  /// @param order  the patches, neighbours together: close numbers lead to close points
  /// @param most   share of the area; where more emits there are no points
  LampPoints(const PatchMesh& mesh, const PatchField& emission, std::span<const int> order, double most);

  bool empty() const { return emitters_.empty(); }

  struct Point {
    Vec3 at;             ///< [m]
    Vec3 normal;         ///< there
    int patch = -1;      ///< that it lies on
    double density = 0;  ///< of such points there [1/m2]
  };

  /// How the points are shared out for one patch that looks at them.
  class View {
   public:
    View(const LampPoints& lamps, int patch);

    /// Whether nothing that emits can be in sight.
    bool empty() const { return up_to_.empty(); }
    /// The point for (s, t) in the unit square.
    Point point(double s, double t) const;
    /// With what density points are drawn from a patch [1/m2]: 0 where it does not emit.
    double density(int patch) const;

   private:
    const LampPoints& lamps_;
    std::vector<double> chance_, up_to_;  // of each group; and of it and those before it
  };

 private:
  struct Group {
    int first = 0, end = 0;  // emitters
    double power = 0;
    Vec3 middle = Vec3::Zero();
    double radius = 0;           // of a ball around the middle that holds it [m]
    Vec3 normal = Vec3::Zero();  // of all that it holds, or 0
  };

  const PatchMesh& mesh_;
  std::vector<int> emitters_;  // patches
  std::vector<PatchSquare> squares_;
  std::vector<Vec3> normals_;
  std::vector<double> up_to_;  // power of emitters 0 .. k
  std::vector<Group> groups_;
  std::vector<int> group_of_;     // of each patch, -1: does not emit
  std::vector<double> exitance_;  // of each emitter, all channels together [W/m2]
  std::vector<int> emitter_of_;   // of each patch; -1
};

}  // namespace luxel
