#include <cmath>
#include <numbers>

#include "stress/scene_builder.h"
#include "stress/stress_case.h"

namespace luxel::stress {

namespace {

// Form factor of two identical, directly opposed rectangles a x b at distance c (Howell catalogue C-11), in
// long double: the terms are about a / c times larger than their sum.
double opposed_rectangles(long double a, long double b, long double c) {
  const long double x = a / c, y = b / c, x2 = 1 + x * x, y2 = 1 + y * y;
  const long double sum =
      0.5L * std::log(x2 * y2 / (x2 + y2 - 1)) + x * std::sqrt(y2) * std::atan(x / std::sqrt(y2)) +
      y * std::sqrt(x2) * std::atan(y / std::sqrt(x2)) - x * std::atan(x) - y * std::atan(y);
  return static_cast<double>(2 / (std::numbers::pi_v<long double> * x * y) * sum);
}

// Two a x b rectangles facing each other at distance c, both with this reflectance and E = 1.
StressCase facing_plates(const std::string& name, const std::string& what, double a, double b, double c) {
  const double reflectance = 0.9;
  SceneBuilder builder;
  builder.finish(reflectance, 1).grid("low", {0, 0, 0}, {a, 0, 0}, {0, b, 0}, 1, 1);
  builder.grid("high", {0, 0, c}, {0, b, 0}, {a, 0, 0}, 1, 1);
  StressCase result;
  result.name = name;
  result.what = what;
  const double value = 1 / (1 - reflectance * opposed_rectangles(a, b, c));
  result.expected.radiosity = everywhere(2, value);
  result.expected.tolerance = 1e-7;
  result.expected.tolerance_reason = "form factors right to 1e-8 relative, amplified by 1 / (1 - 0.9)";
  result.expected.source = "B = E / (1 - rho F), F of opposed rectangles: Howell catalogue C-11";
  result.allowed = {Verdict::exact};
  result.problem = [scene = builder.scene()] { return problem_of(scene); };
  return result;
}

StressCase flipped_normals() {
  StressCase result;
  result.name = "flipped_normals";
  result.what = "closed cube whose faces all look outwards: nobody sees anybody";
  result.expected.radiosity = everywhere(6, 1);
  result.expected.tolerance = 0;
  result.expected.tolerance_reason = "no light arrives anywhere";
  result.expected.source = "F = 0 outside a convex body, so B = E";
  result.allowed = {Verdict::exact};
  result.problem = [] {
    return problem_of(SceneBuilder().finish(0.5, 1).box("", {0, 0, 0}, {1, 1, 1}, 1, false).scene());
  };
  return result;
}

StressCase single_plane() {
  StressCase result = flipped_normals();
  result.name = "open_single_plane";
  result.what = "one quad and nothing else";
  result.expected.radiosity = everywhere(1, 1);
  result.expected.source = "a flat patch does not see itself, so B = E";
  result.problem = [] {
    return problem_of(
        SceneBuilder().finish(0.5, 1).grid("plane", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1).scene());
  };
  return result;
}

StressCase tiny_emitter() {
  SceneBuilder builder;
  builder.finish(0.5, 1).grid("emitter", {-0.5, -0.5, 1000}, {0, 1, 0}, {1, 0, 0}, 1, 1);
  builder.finish(0.5, 0).grid("plane", {-5e5, -5e5, 0}, {1e6, 0, 0}, {0, 1e6, 0}, 1, 1);
  StressCase result;
  result.name = "tiny_emitter_huge_dark_plane";
  result.what = "1 m2 of light 1 km above a dark plane of 1e6 x 1e6 m: 5e-13, not 0";
  result.expected.radiosity = {{1, 4.99998363385774e-13, 4.99998363385774e-13}};
  result.expected.tolerance = 1e-6;
  result.expected.tolerance_reason = "form factor of 1e-12 right to 1e-7 relative";
  result.expected.source = "B = rho F21 / (1 - rho^2 F12 F21), F12 by Howell catalogue C-13 in 50 digits";
  result.allowed = {Verdict::exact};
  result.problem = [scene = builder.scene()] { return problem_of(scene); };
  return result;
}

StressCase disconnected_rooms() {
  SceneBuilder builder;
  builder.finish(0.8, 1).box("a_", {0, 0, 0}, {1, 1, 1}, 1, true);
  builder.finish(0.8, 0).box("b_", {1 + 1e-6, 0, 0}, {2, 1, 1}, 1, true);
  StressCase result;
  result.name = "disconnected_rooms";
  result.what = "two closed rooms with a wall of 1e-6 between them, light in the first only";
  result.expected.radiosity = everywhere(6, 5);
  for (int i = 6; i < 12; ++i) result.expected.radiosity.push_back({i, 0, 0});
  result.expected.tolerance = 1e-10;
  result.expected.tolerance_reason = "rows close to 1e-12, amplified by 1 / (1 - 0.8)";
  result.expected.source = "white furnace in the first, no light in the second";
  result.allowed = {Verdict::exact, Verdict::bounded};
  result.problem = [scene = builder.scene()] { return problem_of(scene); };
  return result;
}

// A unit cube with a square hole of edge 0.01 in the middle of its ceiling, rho = 0.99, E = 1 everywhere.
StressCase pinhole() {
  const double reflectance = 0.99, hole = 0.01, low = 0.5 - hole / 2, high = 0.5 + hole / 2;
  SceneBuilder builder;
  builder.finish(reflectance, 1).box("", {0, 0, 0}, {1, 1, 1}, 1, true);
  const Scene cube = builder.scene();
  SceneBuilder open;
  open.finish(reflectance, 1);
  for (int f = 0; f < cube.face_count(); ++f) {
    std::vector<Vec3> corners;
    for (int k = cube.face_offsets[f]; k < cube.face_offsets[f + 1]; ++k) {
      corners.push_back(cube.vertices[cube.face_vertices[k]]);
    }
    if (cube.groups[cube.face_groups[f]] != "ceiling") open.face(cube.groups[cube.face_groups[f]], corners);
  }
  open.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {low, 0, 0}, 1, 1)
      .grid("ceiling", {high, 0, 1}, {0, 1, 0}, {low, 0, 0}, 1, 1);
  open.grid("ceiling", {low, 0, 1}, {0, low, 0}, {hole, 0, 0}, 1, 1);
  open.grid("ceiling", {low, high, 1}, {0, low, 0}, {hole, 0, 0}, 1, 1);
  // the largest form factor to the hole of any point of the walls, hence of any patch
  const double largest_loss = 4.13713759253759e-5;
  StressCase result;
  result.name = "pinhole_box";
  result.what = "closed cube but for a hole of 1e-4 of a side's area, reflectance 0.99";
  result.expected.kind = ExpectationKind::bounds;
  for (int i = 0; i < 9; ++i) {
    result.expected.radiosity.push_back(
        {i, 1 / (1 - reflectance * (1 - largest_loss)), 1 / (1 - reflectance)});
  }
  result.expected.tolerance = 1e-9;
  result.expected.tolerance_reason = "the bounds are rigorous; rounding and the residual only";
  result.expected.source =
      "row sums lie in [1 - f_max, 1], so the discrete maximum principle gives both bounds";
  result.allowed = {Verdict::exact};
  result.problem = [scene = open.scene()] { return problem_of(scene); };
  return result;
}

// 10 x 1 x 1, closed, ten segments of unit quads, rho = 0.5, the end wall x = 0 emits.
StressCase corridor() {
  SceneBuilder builder;
  builder.finish(0.5, 1).grid("x0", {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 1);
  builder.finish(0.5, 0).grid("x1", {10, 0, 0}, {0, 0, 1}, {0, 1, 0}, 1, 1);
  builder.grid("y0", {0, 0, 0}, {0, 0, 1}, {10, 0, 0}, 1, 10)
      .grid("y1", {0, 1, 0}, {10, 0, 0}, {0, 0, 1}, 10, 1);
  builder.grid("floor", {0, 0, 0}, {10, 0, 0}, {0, 1, 0}, 10, 1);
  builder.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {10, 0, 0}, 1, 10);
  const double along[10] = {0.1581818694050,    0.04589517530509,  0.01577555608957,   0.006296692196976,
                            0.002874086029255,  0.001479137977229, 0.0008477497907018, 0.0005433749722499,
                            0.0004202941633131, 0.0005144725972878};
  StressCase result;
  result.name = "long_corridor";
  result.what = "ten segments in a row, each coupled to its neighbours only";
  result.expected.radiosity = {{0, 1.066640121279, 1.066640121279},
                               {1, 0.002046244613923, 0.002046244613923}};
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < 10; ++k) result.expected.radiosity.push_back({2 + 10 * side + k, along[k], along[k]});
  }
  result.expected.tolerance = 1e-7;
  result.expected.tolerance_reason = "form factors right to 1e-7, weakly amplified at reflectance 0.5";
  result.expected.source =
      "42 x 42 system with form factors C-13 and C-15 of the Howell catalogue in 24 digits";
  result.allowed = {Verdict::exact};
  result.problem = [scene = builder.scene()] { return problem_of(scene); };
  return result;
}

}  // namespace

std::vector<StressCase> geometry_cases() {
  return {facing_plates("thin_gap_1e-3", "unit plates 1e-3 apart", 1, 1, 1e-3),
          facing_plates("thin_gap_1e-4", "unit plates 1e-4 apart", 1, 1, 1e-4),
          facing_plates("thin_gap_1e-5", "unit plates 1e-5 apart", 1, 1, 1e-5),
          facing_plates("thin_gap_1e-6", "unit plates 1e-6 apart", 1, 1, 1e-6),
          facing_plates("sliver_1e4", "slivers of 1 x 1e-4 facing each other 1e-4 apart", 1, 1e-4, 1e-4),
          facing_plates("sliver_1e6", "slivers of 1 x 1e-6 facing each other 1e-6 apart", 1, 1e-6, 1e-6),
          facing_plates("far_plates_1e3", "unit plates 1000 apart", 1, 1, 1e3),
          flipped_normals(),
          single_plane(),
          tiny_emitter(),
          disconnected_rooms(),
          pinhole(),
          corridor()};
}

}  // namespace luxel::stress
