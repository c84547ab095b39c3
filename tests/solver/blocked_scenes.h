#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "luxel/patch_mesh.h"

// Scenes in which something hides something, made in the tests.
namespace luxel::testing {

/// Builds a mesh of flat polygons, each cut into patches, without the mesher. All points are mapped by
/// `placement` first.
class SceneBuilder {
 public:
  Eigen::Affine3d placement = Eigen::Affine3d::Identity();

  /// A polygon of the occluders: triangles of a fan around the first corner. Gives its number.
  int polygon(const std::vector<Vec3>& corners) {
    std::vector<int> index;
    for (const Vec3& x : corners) index.push_back(number(x, occluder_numbers_, mesh_.occluders.vertices));
    for (std::size_t k = 1; k + 1 < index.size(); ++k) {
      mesh_.occluders.triangles.push_back({index[0], index[k], index[k + 1]});
      mesh_.occluders.polygons.push_back(mesh_.occluders.polygon_count);
    }
    return mesh_.occluders.polygon_count++;
  }

  /// A triangle or quad that lies in the polygon.
  void patch(const std::vector<Vec3>& corners, int polygon) {
    std::array<int, 4> index{-1, -1, -1, -1};
    Vec3 area = Vec3::Zero(), moment = Vec3::Zero();
    auto at = [&](std::size_t k) -> Vec3 { return placement * corners[k]; };
    for (std::size_t k = 0; k < corners.size(); ++k) {
      index[k] = number(corners[k], numbers_, mesh_.vertices);
    }
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      const Vec3 part = 0.5 * (at(k) - at(0)).cross(at(k + 1) - at(0));
      area += part;
      moment += part.norm() * (at(0) + at(k) + at(k + 1)) / 3;
    }
    mesh_.corners.push_back(index);
    mesh_.normals.push_back(area.normalized());
    mesh_.areas.push_back(area.norm());
    mesh_.centroids.push_back(moment / area.norm());
    mesh_.faces.push_back(mesh_.size() - 1);
    mesh_.groups.push_back(0);
    mesh_.materials.push_back(0);
    mesh_.finishes.push_back(0);
    mesh_.polygons.push_back(polygon);
  }

  /// k x k patches of the quad a, b, c, d; `sheets` = 2 puts as many on its back.
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int k, int sheets = 1) {
    const int number = polygon({a, b, c, d});
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j < k; ++j) {
        const Vec3 p = at(a, b, c, d, i, j, k), q = at(a, b, c, d, i + 1, j, k);
        const Vec3 r = at(a, b, c, d, i + 1, j + 1, k), s = at(a, b, c, d, i, j + 1, k);
        patch({p, q, r, s}, number);
        if (sheets == 2) patch({s, r, q, p}, number);
      }
    }
  }

  /// A box turned about its centre, k x k patches a side, seen from outside or from inside.
  void box(const Vec3& low, const Vec3& high, const Eigen::Matrix3d& turn, int k, bool inside,
           int sheets = 1) {
    const Vec3 centre = (low + high) / 2;
    auto corner = [&](int x, int y, int z) -> Vec3 {
      const Vec3 p(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
      return turn.isIdentity() ? p : Vec3(centre + turn * (p - centre));
    };
    auto side = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
      if (inside) {
        quad(a, d, c, b, k, sheets);
      } else {
        quad(a, b, c, d, k, sheets);
      }
    };
    side(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
    side(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
    side(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
    side(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
    side(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
    side(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
  }

  /// A closed prism between two rings of `count` points about the segment from `from` to `to`, seen from
  /// outside: quads around it, triangles on its ends.
  void prism(const Vec3& from, const Vec3& to, double radius, int count) {
    const Vec3 axis = (to - from).normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
    const auto at = [&](const Vec3& centre, int k) -> Vec3 {
      const double angle = 2 * 3.14159265358979323846 * (k % count) / count;
      return centre + radius * (std::cos(angle) * u + std::sin(angle) * v);
    };
    std::vector<Vec3> bottom, top;
    for (int k = 0; k < count; ++k) {
      bottom.push_back(at(from, -k + count));
      top.push_back(at(to, k));
    }
    for (const auto& ring : {bottom, top}) {
      const int number = polygon(ring);
      for (std::size_t k = 1; k + 1 < ring.size(); ++k) patch({ring[0], ring[k], ring[k + 1]}, number);
    }
    for (int k = 0; k < count; ++k) {
      const std::vector<Vec3> side{at(from, k), at(from, k + 1), at(to, k + 1), at(to, k)};
      patch(side, polygon(side));
    }
  }

  PatchMesh take() { return std::move(mesh_); }

 private:
  using Numbers = std::map<std::array<double, 3>, int>;

  static Vec3 at(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int i, int j, int k) {
    const double s = static_cast<double>(i) / k, t = static_cast<double>(j) / k;
    return (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d;
  }

  int number(const Vec3& x, Numbers& numbers, std::vector<Vec3>& points) {
    const auto [found, fresh] = numbers.try_emplace({x.x(), x.y(), x.z()}, static_cast<int>(points.size()));
    if (fresh) points.push_back(placement * x);
    return found->second;
  }

  PatchMesh mesh_;
  Numbers numbers_, occluder_numbers_;
};

inline Eigen::Matrix3d turned(double a, double b, double c) {
  return (Eigen::AngleAxisd(a, Vec3::UnitX()) * Eigen::AngleAxisd(b, Vec3::UnitY()) *
          Eigen::AngleAxisd(c, Vec3::UnitZ()))
      .toRotationMatrix();
}

/// The unit cube with a box in it; closed.
inline PatchMesh room_with_box(int walls, int sides,
                               const Eigen::Affine3d& placement = Eigen::Affine3d::Identity()) {
  SceneBuilder scene;
  scene.placement = placement;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), walls, true);
  scene.box({0.31, 0.27, 0.22}, {0.63, 0.58, 0.71}, Eigen::Matrix3d::Identity(), sides, false);
  return scene.take();
}

/// The unit cube with two boxes in it, turned against it and each other; closed.
inline PatchMesh room_with_turned_boxes(int walls, int sides,
                                        const Eigen::Affine3d& placement = Eigen::Affine3d::Identity()) {
  SceneBuilder scene;
  scene.placement = placement;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), walls, true);
  scene.box({0.15, 0.2, 0.1}, {0.45, 0.45, 0.6}, turned(0.3, 0.5, 0.7), sides, false);
  scene.box({0.55, 0.5, 0.3}, {0.85, 0.8, 0.7}, turned(-0.4, 0.2, 1.1), sides, false);
  return scene.take();
}

}  // namespace luxel::testing
