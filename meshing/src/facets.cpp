#include "facets.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "corner_positions.h"
#include "ear_clipping.h"
#include "luxel/input_error.h"
#include "polygon.h"
#include "repeated_loops.h"
#include "weld.h"

namespace luxel {

namespace {

// Faces that a thread takes at a time, at least.
constexpr int faces_per_task = 2048;

enum Side : char { no_side = 0, front_side = 1, back_side = 2 };

/// Every face's corners after welding, without corners that repeat the one before.
Loops welded_loops(const Scene& scene, const WeldedVertices& welded) {
  Loops loops;
  loops.offsets.reserve(scene.face_offsets.size());
  loops.entries.reserve(scene.face_vertices.size());
  std::vector<int> loop;
  for (int f = 0; f < scene.face_count(); ++f) {
    loop.clear();
    for (int c = scene.face_offsets[f]; c < scene.face_offsets[f + 1]; ++c) {
      const int v = welded.index[scene.face_vertices[c]];
      if (loop.empty() || loop.back() != v) loop.push_back(v);
    }
    while (loop.size() > 1 && loop.back() == loop.front()) loop.pop_back();
    loops.append(loop);
  }
  return loops;
}

enum class Shape : char { line, patch, polygon, bent };  // flat, a triangle or convex quad; flat; not flat

std::vector<Shape> shapes_of(const Loops& loops, const std::vector<Vec3>& vertices) {
  std::vector<Shape> shapes(loops.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, loops.size(), faces_per_task), [&](const auto& range) {
    CornerPositions positions(vertices);
    for (int f = range.begin(); f < range.end(); ++f) {
      const std::span<const Vec3> points = positions(loops[f]);
      if (!has_area(points)) {
        shapes[f] = Shape::line;
      } else if (!is_flat(points)) {
        shapes[f] = Shape::bent;
      } else {
        const bool patch = points.size() <= 4 && (points.size() < 4 || is_convex(points));
        shapes[f] = patch ? Shape::patch : Shape::polygon;
      }
    }
  });
  return shapes;
}

/// The sides of each face that no earlier face with the same corners has taken.
std::vector<char> free_sides(const Scene& scene, const Loops& loops, const std::vector<Shape>& shapes,
                             std::vector<int>& duplicates) {
  const RepeatedLoops repeated = find_repeated(loops);
  std::vector<char> taken(scene.face_count(), no_side);  // of the first loop, in its own orientation
  std::vector<char> sides(scene.face_count(), no_side);
  for (int f = 0; f < scene.face_count(); ++f) {
    if (shapes[f] == Shape::line) continue;
    char& others = taken[repeated.first[f]];
    const Side own = repeated.reversed[f] ? back_side : front_side;
    const bool two_sided = scene.finishes[scene.face_finishes[f]].two_sided;
    const char wanted = two_sided ? front_side | back_side : own;
    const char gained = wanted & ~others;
    if (gained != wanted) duplicates.push_back(f);
    others |= wanted;
    if (gained & own) sides[f] |= front_side;
    if (gained & ~own) sides[f] |= back_side;
  }
  return sides;
}

std::string count_of_faces(const std::vector<int>& faces, const std::string& one, const std::string& many) {
  return std::to_string(faces.size()) + (faces.size() == 1 ? " face " + one : " faces " + many) +
         " (first: face " + std::to_string(faces.front()) + ")";
}

}  // namespace

std::vector<std::array<int, 3>> triangulate_loop(std::span<const Vec3> loop) {
  const auto [u, v] = plane_axes(area_vector(loop).normalized());
  if (loop.size() == 4 && is_convex(loop)) {
    // Convex but not flat: the shorter diagonal bends the surface less.
    const bool first = (loop[2] - loop[0]).squaredNorm() <= (loop[3] - loop[1]).squaredNorm();
    if (first) return {{0, 1, 2}, {0, 2, 3}};
    return {{0, 1, 3}, {1, 2, 3}};
  }
  std::vector<Vec2> flat;
  for (const Vec3& p : loop) flat.emplace_back((p - loop[0]).dot(u), (p - loop[0]).dot(v));
  return clip_ears(flat);
}

Facets make_facets(const Scene& scene) {
  WeldedVertices welded = weld(scene);
  const Loops loops = welded_loops(scene, welded);
  Facets facets;
  facets.vertices = std::move(welded.positions);
  facets.welded_vertices = welded.welded;

  const std::vector<Shape> shapes = shapes_of(loops, facets.vertices);
  std::vector<int> degenerate, duplicates;
  for (int f = 0; f < scene.face_count(); ++f) {
    if (shapes[f] == Shape::line) degenerate.push_back(f);
  }
  const std::vector<char> sides = free_sides(scene, loops, shapes, duplicates);

  const auto append = [&](std::span<const int> loop, int face) {
    facets.loops.append(loop);
    facets.faces.push_back(face);
    facets.front.push_back((sides[face] & front_side) != 0);
    facets.back.push_back((sides[face] & back_side) != 0);
  };
  facets.loops.offsets.reserve(loops.offsets.size());
  facets.loops.entries.reserve(loops.entries.size());
  facets.faces.reserve(loops.size());
  facets.front.reserve(loops.size());
  facets.back.reserve(loops.size());
  CornerPositions positions(facets.vertices);
  for (int f = 0; f < scene.face_count(); ++f) {
    if (sides[f] == no_side) continue;
    if (shapes[f] != Shape::patch) ++facets.split_faces;
    if (shapes[f] != Shape::bent) {
      append(loops[f], f);
    } else {
      for (const auto& t : triangulate_loop(positions(loops[f]))) {
        const std::array<int, 3> triangle = {loops[f][t[0]], loops[f][t[1]], loops[f][t[2]]};
        if (has_area(positions(triangle))) append(triangle, f);
      }
    }
  }
  if (facets.size() == 0) {
    throw InputError((scene.file.empty() ? "" : scene.file + ": ") + "none of the " +
                     std::to_string(scene.face_count()) + " faces has an area, expected at least one");
  }
  facets.degenerate_faces = static_cast<int>(degenerate.size());
  facets.duplicate_faces = static_cast<int>(duplicates.size());
  if (!degenerate.empty()) {
    facets.warnings.push_back(count_of_faces(degenerate, "has", "have") + " no area and no patch");
  }
  if (!duplicates.empty()) {
    facets.warnings.push_back(count_of_faces(duplicates, "has", "have") +
                              " the same corners and the same side as an earlier one and the two are merged");
  }
  return facets;
}

}  // namespace luxel
