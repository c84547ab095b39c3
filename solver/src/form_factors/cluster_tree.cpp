#include "form_factors/cluster_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "form_factors/coplanar_groups.h"
#include "form_factors/working_frame.h"

namespace luxel {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// How much a turn of the normal by 1 rad weighs against a distance of one scene diagonal when patches are
// gathered: bodies first, then their sides.
constexpr double normal_weight = 0.3;

// A plane's patches are one item of the upper tree only where they fill this share of their rectangle;
// scattered ones (facets of a curved body that happen to be coplanar) are gathered by position instead.
constexpr double filled_share = 0.1;

std::vector<WorkPatch> work_patches(const PatchMesh& mesh, const WorkingFrame& frame) {
  std::vector<WorkPatch> patches(mesh.size());
  for (int p = 0; p < mesh.size(); ++p) patches[p] = work_patch(mesh, p, frame);
  return patches;
}

// Where half of `size` patches end, so that the left half fills whole vectors of 8.
int half_of(int size) {
  const int half = size / 2;
  return half > 8 ? (half + 7) / 8 * 8 : std::max(half, 1);
}

class Builder {
 public:
  explicit Builder(std::vector<WorkPatch> patches) : patches_(std::move(patches)) {}

  ClusterTree build() {
    for (const CoplanarGroup& group : coplanar_groups(patches_, coplanar_tolerance)) {
      for (int p : group.members) patches_[p].plane = group.plane;
      add_items(group.members);
    }
    clusters_.reserve(2 * patches_.size());
    std::vector<int> all(items_.size());
    std::iota(all.begin(), all.end(), 0);
    ClusterTree tree;
    if (!all.empty()) tree.root = build_upper(all.begin(), all.end());
    tree.patches.reserve(patches_.size());
    for (int p : order_) tree.patches.push_back(patches_[p]);
    tree.clusters = std::move(clusters_);
    return tree;
  }

 private:
  using Ints = std::vector<int>::iterator;

  // Coplanar patches that stay together: the leaves of the upper tree.
  struct Item {
    std::vector<int> members;
    Vec3 centre;
    Vec3 normal;
  };

  // A frame in the plane: u along an edge, so that the rectangles of grids are tight.
  struct Frame {
    Vec3 u, v, normal;
    double offset;
    Vec3 at(double s, double t) const { return s * u + t * v + offset * normal; }
  };

  Frame frame(const std::vector<int>& members) const {
    int largest = members[0];
    for (int p : members) {
      if (patches_[p].area > patches_[largest].area) largest = p;
    }
    const WorkPatch& patch = patches_[largest];
    int longest = 0;
    double length = -1;
    for (int k = 0; k < patch.outline.count; ++k) {
      const double l = (patch.outline.next(k) - patch.outline[k]).norm();
      if (l > length * (1 + 1e-9)) longest = k, length = l;
    }
    const Vec3& normal = patch.plane.normal;
    Vec3 u = patch.outline.next(longest) - patch.outline[longest];
    u = (u - u.dot(normal) * normal).normalized();
    return {u, normal.cross(u), normal, patch.plane.offset};
  }

  struct Rectangle {
    double s0 = infinity, s1 = -infinity, t0 = infinity, t1 = -infinity;
    double area() const { return (s1 - s0) * (t1 - t0); }
  };

  template <class Range>
  Rectangle rectangle(const Range& members, const Frame& frame) const {
    Rectangle box;
    for (int p : members) {
      for (int k = 0; k < patches_[p].outline.count; ++k) {
        const double s = frame.u.dot(patches_[p].outline[k]), t = frame.v.dot(patches_[p].outline[k]);
        box.s0 = std::min(box.s0, s), box.s1 = std::max(box.s1, s);
        box.t0 = std::min(box.t0, t), box.t1 = std::max(box.t1, t);
      }
    }
    return box;
  }

  // Splits members at the median along the longer side of the box of their centroids.
  Ints split_in_plane(Ints begin, Ints end, const Frame& frame) {
    double s0 = infinity, s1 = -infinity, t0 = infinity, t1 = -infinity;
    for (Ints p = begin; p != end; ++p) {
      const double s = frame.u.dot(patches_[*p].centroid), t = frame.v.dot(patches_[*p].centroid);
      s0 = std::min(s0, s), s1 = std::max(s1, s), t0 = std::min(t0, t), t1 = std::max(t1, t);
    }
    const bool along_u = s1 - s0 >= t1 - t0;
    const Vec3 &first = along_u ? frame.u : frame.v, &second = along_u ? frame.v : frame.u;
    // Coordinates to 1e-9: rows of a rotated grid stay rows in spite of rounding.
    auto key = [&](int p) {
      return std::tuple(std::llround(first.dot(patches_[p].centroid) * 1e9),
                        std::llround(second.dot(patches_[p].centroid) * 1e9), p);
    };
    const Ints middle = begin + half_of(static_cast<int>(end - begin));
    std::nth_element(begin, middle, end, [&](int a, int b) { return key(a) < key(b); });
    return middle;
  }

  void add_items(const std::vector<int>& group) {
    std::vector<int> members = group;
    const Frame axes = frame(group);
    add_filled(members.begin(), members.end(), axes);
  }

  void add_filled(Ints begin, Ints end, const Frame& axes) {
    std::vector<int> members(begin, end);
    double total = 0;
    for (int p : members) total += patches_[p].area;
    if (members.size() > 1 && total < filled_share * rectangle(members, axes).area()) {
      const Ints middle = split_in_plane(begin, end, axes);
      add_filled(begin, middle, axes);
      add_filled(middle, end, axes);
      return;
    }
    Vec3 centre = Vec3::Zero();
    for (int p : members) centre += patches_[p].centroid;
    items_.push_back({members, centre / static_cast<double>(members.size()), axes.normal});
  }

  int build_upper(Ints begin, Ints end) {
    if (end - begin == 1) {
      Item& item = items_[*begin];
      const Frame axes = frame(item.members);
      return build_planar(item.members.begin(), item.members.end(), axes);
    }
    const int id = static_cast<int>(clusters_.size());
    clusters_.emplace_back();
    Eigen::Array<double, 6, 1> low = Eigen::Array<double, 6, 1>::Constant(infinity), high = -low;
    int patches = 0;
    auto feature = [&](int item) {
      Eigen::Array<double, 6, 1> f;
      f << items_[item].centre.array(), normal_weight * items_[item].normal.array();
      return f;
    };
    for (Ints i = begin; i != end; ++i) {
      low = low.min(feature(*i)), high = high.max(feature(*i));
      patches += static_cast<int>(items_[*i].members.size());
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    auto key = [&](int i) { return std::tuple(std::llround(feature(i)[axis] * 1e9), i); };
    std::sort(begin, end, [&](int a, int b) { return key(a) < key(b); });
    Ints middle = begin + 1;
    int left = static_cast<int>(items_[*begin].members.size());
    const int wanted = half_of(patches);
    while (middle + 1 != end) {
      const int more = left + static_cast<int>(items_[*middle].members.size());
      if (std::abs(more - wanted) > std::abs(left - wanted)) break;
      left = more;
      ++middle;
    }
    const int first = build_upper(begin, middle);
    const int second = build_upper(middle, end);
    clusters_[id] = gathered(first, second);
    return id;
  }

  int build_planar(Ints begin, Ints end, const Frame& axes) {
    const int id = static_cast<int>(clusters_.size());
    clusters_.emplace_back();
    Cluster cluster;
    cluster.begin = static_cast<int>(order_.size());
    cluster.plane = {axes.normal, axes.offset};
    const Rectangle box = rectangle(std::vector<int>(begin, end), axes);
    cluster.centre = axes.at(0.5 * (box.s0 + box.s1), 0.5 * (box.t0 + box.t1));
    if (end - begin == 1) {
      cluster.hull = patches_[*begin].outline;
    } else {
      cluster.hull.count = 4;
      cluster.hull.corners[0] = axes.at(box.s0, box.t0);
      cluster.hull.corners[1] = axes.at(box.s1, box.t0);
      cluster.hull.corners[2] = axes.at(box.s1, box.t1);
      cluster.hull.corners[3] = axes.at(box.s0, box.t1);
    }
    for (Ints p = begin; p != end; ++p) {
      const WorkPatch& patch = patches_[*p];
      cluster.edge = std::max(cluster.edge, patch.edge);
      for (int k = 0; k < patch.outline.count; ++k) {
        cluster.radius = std::max(cluster.radius, (patch.outline[k] - cluster.centre).norm());
        cluster.thickness = std::max(cluster.thickness, std::abs(cluster.plane.distance(patch.outline[k])));
      }
    }
    if (end - begin == 1) {
      order_.push_back(*begin);
    } else {
      const Ints middle = split_in_plane(begin, end, axes);
      cluster.left = build_planar(begin, middle, axes);
      cluster.right = build_planar(middle, end, axes);
    }
    cluster.end = static_cast<int>(order_.size());
    clusters_[id] = cluster;
    return id;
  }

  // The cluster of two clusters that need not be coplanar.
  Cluster gathered(int left, int right) const {
    const Cluster &a = clusters_[left], &b = clusters_[right];
    Cluster cluster;
    cluster.begin = a.begin;
    cluster.end = b.end;
    cluster.left = left;
    cluster.right = right;
    cluster.edge = std::max(a.edge, b.edge);
    Vec3 low = Vec3::Constant(infinity), high = -low, normal = Vec3::Zero();
    for (int k = cluster.begin; k < cluster.end; ++k) {
      const WorkPatch& patch = patches_[order_[k]];
      normal += patch.area * patch.plane.normal;
      for (int c = 0; c < patch.outline.count; ++c) {
        low = low.cwiseMin(patch.outline[c]);
        high = high.cwiseMax(patch.outline[c]);
      }
    }
    cluster.centre = 0.5 * (low + high);
    cluster.planar = false;
    const double length = normal.norm();
    cluster.plane.normal = length > 0 ? Vec3(normal / length) : Vec3::UnitZ();
    cluster.plane.offset = cluster.plane.normal.dot(cluster.centre);
    cluster.setback = {infinity, -infinity};
    cluster.hull.count = 8;
    for (int k = 0; k < 8; ++k) {
      cluster.hull.corners[k] =
          Vec3(k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]);
    }
    for (int k = cluster.begin; k < cluster.end; ++k) {
      const WorkPatch& patch = patches_[order_[k]];
      const Vec3& n = patch.plane.normal;
      const double angle = std::atan2(n.cross(cluster.plane.normal).norm(), n.dot(cluster.plane.normal));
      cluster.cone = std::max(cluster.cone, angle);
      const double setback = patch.plane.distance(cluster.centre);
      cluster.setback.low = std::min(cluster.setback.low, setback);
      cluster.setback.high = std::max(cluster.setback.high, setback);
      for (int c = 0; c < patch.outline.count; ++c) {
        cluster.radius = std::max(cluster.radius, (patch.outline[c] - cluster.centre).norm());
      }
    }
    cluster.cone_cosine = std::cos(cluster.cone);
    cluster.cone_sine = std::sin(cluster.cone);
    return cluster;
  }

  std::vector<WorkPatch> patches_;
  std::vector<Item> items_;
  std::vector<int> order_;
  std::vector<Cluster> clusters_;
};

}  // namespace

ClusterTree cluster_tree(const PatchMesh& mesh) {
  const WorkingFrame frame = working_frame(mesh);
  ClusterTree tree = Builder(work_patches(mesh, frame)).build();
  tree.centre = frame.centre;
  tree.scale = frame.scale;
  tree.sky_begin = mesh.size();
  return tree;
}

}  // namespace luxel
