#include <algorithm>
#include <cmath>

#include "angle.h"
#include "delaunay.h"
#include "widen_angles.h"

namespace luxel {

namespace {

// A new point makes an angle wider than asked by this factor with the edge that it is made for: what comes
// near it may take some of it away.
constexpr double margin = 1.08;

// A part of a border is halved if it is longer than this many times the shortest edge of the bad triangle:
// halves stay near that length, so sharp corners of the domain do not draw ever shorter parts.
constexpr double shortest_halved = 1.5;

Vec2 vector(const Delaunay::Vertex_handle& v) {
  return {v->point().x(), v->point().y()};
}

struct Part {
  int a, b;
  bool border;
  double least;  // length that its halves must keep
};

struct Bad {
  std::array<Delaunay::Vertex_handle, 3> corners;  // the sharpest first
  double angle;
};

class Widener {
 public:
  Widener(DomainTriangulation& triangulation, const PlanarDomain& domain, const std::vector<double>& least,
          double smallest)
      : delaunay_(triangulation.delaunay), vertices_(triangulation.vertices), smallest_(smallest) {
    for (const auto* list : {&domain.borders, &domain.creases}) {
      for (const auto& [a, b] : *list) {
        parts_.push_back({a, b, list == &domain.borders, least[parts_.size()]});
      }
    }
  }

  /// Ends early where rounding lets two edges cross, in corners of next to no width.
  AddedPoints run(std::size_t most) {
    try {
      widen(most);
    } catch (const Delaunay::Intersection_of_constraints_exception&) {
    }
    return added_;
  }

 private:
  void widen(std::size_t most) {
    for (bool changed = true; changed;) {
      changed = false;
      for (const Bad& bad : find_bad()) {
        if (added_.inside.size() + added_.halved.size() >= most) return;
        Delaunay::Face_handle face;
        if (delaunay_.is_face(bad.corners[0], bad.corners[1], bad.corners[2], face) && mend(bad, face))
          changed = true;
      }
    }
  }

  std::vector<Bad> find_bad() {
    std::unordered_set<std::uint64_t> borders;
    for (const Part& part : parts_) {
      if (part.border) borders.insert(edge_key(part.a, part.b));
    }
    mark_places(delaunay_, borders);
    std::vector<Bad> list;
    for (auto face = delaunay_.finite_faces_begin(); face != delaunay_.finite_faces_end(); ++face) {
      if (face->info() != Place::inside) continue;
      for (int k = 0; k < 3; ++k) {
        const Vec2 p = vector(face->vertex(k));
        const Vec2 u = vector(face->vertex((k + 1) % 3)) - p;
        const Vec2 v = vector(face->vertex((k + 2) % 3)) - p;
        const double angle = std::atan2(std::abs(u.x() * v.y() - u.y() * v.x()), u.dot(v));
        const bool corner = face->is_constrained((k + 1) % 3) && face->is_constrained((k + 2) % 3);
        if (angle >= smallest_ || corner) continue;
        list.push_back({{face->vertex(k), face->vertex((k + 1) % 3), face->vertex((k + 2) % 3)}, angle});
        break;
      }
    }
    std::stable_sort(list.begin(), list.end(), [](const Bad& a, const Bad& b) { return a.angle < b.angle; });
    return list;
  }

  /// Adds one point for a bad triangle; false if there is no room for one.
  bool mend(const Bad& bad, Delaunay::Face_handle face) {
    const Vec2 apex = vector(bad.corners[0]);
    const Vec2 p = vector(bad.corners[1]);
    const Vec2 q = vector(bad.corners[2]);
    const Vec2 middle = 0.5 * (p + q);
    const double shortest = (p - q).norm();
    const auto centre = delaunay_.circumcenter(face);
    const Vec2 way = Vec2(centre.x(), centre.y()) - middle;
    const double farthest = 0.5 * shortest / std::tan(0.5 * margin * smallest_);
    const Vec2 point = middle + way * std::min(1.0, farthest / way.norm());
    const Vec2 start = (apex + p + q) / 3;
    int blocking = -1;
    double longest = 0;
    for (int i = 0; i < static_cast<int>(parts_.size()); ++i) {
      const double length = (vector(vertices_[parts_[i].a]) - vector(vertices_[parts_[i].b])).norm();
      if (length > longest && blocks(parts_[i], start, point)) {
        blocking = i;
        longest = length;
      }
    }
    if (blocking < 0) {
      const auto before = delaunay_.number_of_vertices();
      const auto vertex = delaunay_.insert({point.x(), point.y()}, face);
      if (delaunay_.number_of_vertices() == before) return false;
      vertex->info() = -1;
      added_.inside.push_back(point);
      return true;
    }
    if (0.5 * longest < parts_[blocking].least || longest < shortest_halved * shortest) return false;
    return halve(blocking);
  }

  /// Whether a part is in the way from `start` to `point`, or has `point` in the circle over it.
  bool blocks(const Part& part, const Vec2& start, const Vec2& point) const {
    const Vec2 a = vector(vertices_[part.a]);
    const Vec2 b = vector(vertices_[part.b]);
    if ((point - a).dot(point - b) <= 0) return true;
    const auto side = [](const Vec2& from, const Vec2& to, const Vec2& of) {
      return (to - from).x() * (of - from).y() - (to - from).y() * (of - from).x() > 0;
    };
    return side(a, b, start) != side(a, b, point) && side(start, point, a) != side(start, point, b);
  }

  bool halve(int index) {
    const Part part = parts_[index];
    Delaunay::Face_handle face;
    int opposite = 0;
    if (!delaunay_.is_edge(vertices_[part.a], vertices_[part.b], face, opposite)) return false;
    const Vec2 middle = 0.5 * (vector(vertices_[part.a]) + vector(vertices_[part.b]));
    const int m = static_cast<int>(vertices_.size());
    delaunay_.remove_constrained_edge(face, opposite);
    vertices_.push_back(delaunay_.insert({middle.x(), middle.y()}, vertices_[part.a]->face()));
    delaunay_.insert_constraint(vertices_[part.a], vertices_[m]);
    delaunay_.insert_constraint(vertices_[m], vertices_[part.b]);
    vertices_.back()->info() = m;
    parts_[index].b = m;
    parts_.push_back({m, part.b, part.border, part.least});
    added_.halved.push_back({part.a, part.b});
    return true;
  }

  Delaunay& delaunay_;
  std::vector<Delaunay::Vertex_handle> vertices_;
  double smallest_;
  std::vector<Part> parts_;
  AddedPoints added_;
};

}  // namespace

AddedPoints widen_delaunay_angles(const PlanarDomain& domain, const std::vector<double>& least,
                                  double smallest, std::size_t most) {
  const std::unique_ptr<DomainTriangulation> triangulation = triangulate_domain(domain);
  if (!triangulation) return {};
  return Widener(*triangulation, domain, least, smallest).run(most);
}

}  // namespace luxel
