#include "transport/hierarchical/block_end.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/hierarchical/flat_clusters.h"

namespace luxel {

namespace {

void set_flat(BlockEnd& end, const PatchCluster& cluster, const FlatGroup& group) {
  end.area = cluster.area;
  end.weights = cluster.weights;
  end.axes = cluster.axes;
  for (int a = 0; a < 4; ++a) {
    const Vec3 node = cluster.axes.middle + (a & 1 ? 1 : -1) * cluster.axes.spread_s * cluster.axes.u +
                      (a & 2 ? 1 : -1) * cluster.axes.spread_t * cluster.axes.v;
    end.x[a] = node.x(), end.y[a] = node.y(), end.z[a] = node.z();
    end.nx[a] = group.normal.x(), end.ny[a] = group.normal.y(), end.nz[a] = group.normal.z();
  }
  Cluster& bounds = end.bounds;
  bounds.plane = {group.normal, group.offset};
  bounds.centre = cluster.centre;
  bounds.radius = cluster.radius;
}

// Areas that differ by less are those of one rectangle.
constexpr double same_area = 0.01;

void set_box(BlockEnd& end, const PatchCluster& cluster) {
  const double box = (cluster.box[1] - cluster.box[0]) * (cluster.box[3] - cluster.box[2]);
  const double moments = 12 * cluster.axes.spread_s * cluster.axes.spread_t;
  end.rectangle =
      std::abs(box - end.area) < same_area * end.area && std::abs(moments - end.area) < same_area * end.area;
  const auto corner = [&](int s, int t) -> Vec3 {
    return cluster.axes.middle + cluster.box[s] * cluster.axes.u + cluster.box[t] * cluster.axes.v;
  };
  end.bounds.hull.count = 4;
  end.bounds.hull.corners[0] = corner(0, 2);
  end.bounds.hull.corners[1] = corner(1, 2);
  end.bounds.hull.corners[2] = corner(1, 3);
  end.bounds.hull.corners[3] = corner(0, 3);
}

void set_curved(BlockEnd& end, const PatchCluster& cluster, const CurvedCluster& curved) {
  end.area = cluster.area;
  end.weights = cluster.weights;
  end.axes = cluster.axes;
  end.roughness = curved.roughness;
  for (int a = 0; a < 4; ++a) {
    end.x[a] = curved.nodes[a].x(), end.y[a] = curved.nodes[a].y(), end.z[a] = curved.nodes[a].z();
    end.nx[a] = curved.normals[a].x(), end.ny[a] = curved.normals[a].y(), end.nz[a] = curved.normals[a].z();
  }
  Cluster& bounds = end.bounds;
  bounds.planar = false;
  bounds.plane = {curved.normal, curved.normal.dot(cluster.centre)};
  bounds.centre = cluster.centre;
  bounds.radius = cluster.radius;
  bounds.cone_cosine = curved.cone_cosine;
  bounds.cone_sine = curved.cone_sine;
  bounds.cone = std::acos(std::clamp(curved.cone_cosine, -1.0, 1.0));
  bounds.setback = curved.setback;
  bounds.hull.count = 8;
  for (int k = 0; k < 8; ++k) {
    bounds.hull.corners[k] =
        Vec3(k & 1 ? curved.high[0] : curved.low[0], k & 2 ? curved.high[1] : curved.low[1],
             k & 4 ? curved.high[2] : curved.low[2]);
  }
}

}  // namespace

BlockEnd block_end(const PatchHierarchy& hierarchy, int cluster, bool with_shaft) {
  BlockEnd end;
  end.cluster = cluster;
  end.single = hierarchy.single(cluster);
  if (end.single) {
    const int position = cluster - hierarchy.cluster_count();
    const FlatGroup& group = hierarchy.groups[hierarchy.group[position]];
    const FlatPatch patch = flat_patch(*hierarchy.mesh, hierarchy.order[position], hierarchy.frame, group);
    set_flat(end, flat_cluster({&patch, 1}, group), group);
    end.usable = true;
    Polygon& hull = end.bounds.hull;
    hull.count = hierarchy.mesh->corner_count(patch.patch);
    for (int k = 0; k < hull.count; ++k) {
      hull.corners[k] = hierarchy.frame(hierarchy.mesh->vertices[hierarchy.mesh->corners[patch.patch][k]]);
    }
  } else {
    const PatchCluster& inner = hierarchy.clusters[cluster];
    end.usable = inner.usable;
    if (inner.flat_group >= 0) {
      set_flat(end, inner, hierarchy.groups[inner.flat_group]);
      set_box(end, inner);
    } else {
      set_curved(end, inner, hierarchy.curved[inner.curved]);
    }
  }
  if (with_shaft) {
    end.shaft = shaft_end(end.bounds.hull, end.bounds.centre, end.bounds.radius, end.bounds.planar);
  }
  return end;
}

double plane_area(const PatchHierarchy& hierarchy, const BlockEnd& end) {
  if (!end.bounds.planar) return end.area;
  const int position =
      end.single ? end.cluster - hierarchy.cluster_count() : hierarchy.clusters[end.cluster].begin;
  return hierarchy.groups[hierarchy.group[position]].area;
}

std::array<double, 16> BlockKernel::from_other_end() const {
  std::array<double, 16> turned;
  for (int k = 0; k < 16; ++k) turned[4 * (k & 3) + (k >> 2)] = values[k];
  return turned;
}

BlockKernel block_kernel(const BlockEnd& r, const BlockEnd& s) {
  BlockKernel kernel;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const double dx = s.x[b] - r.x[a], dy = s.y[b] - r.y[a], dz = s.z[b] - r.z[a];
      const double from = std::max(r.nx[a] * dx + r.ny[a] * dy + r.nz[a] * dz, 0.0);
      const double to = std::max(-(s.nx[b] * dx + s.ny[b] * dy + s.nz[b] * dz), 0.0);
      const double squared = dx * dx + dy * dy + dz * dz;
      kernel.values[4 * a + b] = from * to / (std::numbers::pi * squared * squared);
    }
  }
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const double value = kernel.values[4 * a + b];
      kernel.largest = std::max(kernel.largest, value);
      kernel.mean += r.weights[a] * s.weights[b] * value;
    }
  }
  double from = 0, to = 0, squared = 0;
  std::array<double, 3> d{}, n{}, m{};
  for (int a = 0; a < 4; ++a) {
    d[0] += 0.25 * (s.x[a] - r.x[a]), d[1] += 0.25 * (s.y[a] - r.y[a]), d[2] += 0.25 * (s.z[a] - r.z[a]);
    n[0] += 0.25 * r.nx[a], n[1] += 0.25 * r.ny[a], n[2] += 0.25 * r.nz[a];
    m[0] += 0.25 * s.nx[a], m[1] += 0.25 * s.ny[a], m[2] += 0.25 * s.nz[a];
  }
  for (int c = 0; c < 3; ++c) {
    from += n[c] * d[c];
    to -= m[c] * d[c];
    squared += d[c] * d[c];
  }
  kernel.middle = std::max(from, 0.0) * std::max(to, 0.0) / (std::numbers::pi * squared * squared);
  return kernel;
}

}  // namespace luxel
