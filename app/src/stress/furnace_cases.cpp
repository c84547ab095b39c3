#include <cmath>

#include "stress/scene_builder.h"
#include "stress/stress_case.h"

namespace luxel::stress {

namespace {

constexpr const char* furnace_source =
    "white furnace: in a closed scene of uniform reflectance rho and emission E, B = E / (1 - rho) on every "
    "patch";

// A room of 2 x 2 quads a side with a floating block: closed, and partly hidden pairs in it.
Scene furnished_room(double reflectance, double emission) {
  SceneBuilder builder;
  builder.finish(reflectance, emission).box("room_", {0, 0, 0}, {1, 1, 1}, 2, true);
  return builder.box("block_", {0.31, 0.27, 0.22}, {0.63, 0.58, 0.71}, 1, false).scene();
}

constexpr int furnished_room_patches = 30;

StressCase furnace(const std::string& name, const std::string& what, const Scene& scene, int patches,
                   double reflectance) {
  StressCase result;
  result.name = name;
  result.what = what;
  result.expected.radiosity = everywhere(patches, 1 / (1 - reflectance));
  // The rows close to 1e-12, and the answer multiplies that by 1 / (1 - rho); the residual asked is as small.
  result.expected.tolerance = std::max(1e-11, 1e-11 / (1 - reflectance));
  result.expected.tolerance_reason =
      "rows close to 1e-12, amplified by 1 / (1 - rho), with a factor 10 in hand";
  result.expected.source = furnace_source;
  result.allowed = {Verdict::exact, Verdict::bounded};
  result.problem = [scene] { return problem_of(scene); };
  return result;
}

StressCase furnished_furnace(const std::string& name, double reflectance) {
  return furnace(name, "closed room with a floating block, uniform reflectance and emission",
                 furnished_room(reflectance, 1), furnished_room_patches, reflectance);
}

Scene cube(double reflectance, double emission, int n = 1) {
  return SceneBuilder().finish(reflectance, emission).box("", {0, 0, 0}, {1, 1, 1}, n, true).scene();
}

StressCase all_white() {
  StressCase result = furnished_furnace("reflectance_1_closed", 0.5);
  result.what = "closed room that absorbs nothing, with emission: no solution";
  result.expected = {ExpectationKind::singular, {}, 0, "", "energy cannot leave: I - F has the eigenvalue 0"};
  result.allowed = {Verdict::refused};
  result.problem = [] { return problem_of(furnished_room(1, 1)); };
  return result;
}

StressCase single_precision() {
  StressCase result = furnished_furnace("tolerance_1e-12_of_float32", 0.9);
  result.what = "residual 1e-12 asked of an operator stored in float32";
  result.problem = [] { return problem_of(furnished_room(0.9, 1), true); };
  return result;
}

StressCase nested() {
  SceneBuilder builder;
  builder.finish(0.5, 1).box("outer_", {0, 0, 0}, {1, 1, 1}, 1, true);
  builder.box("inner_", Vec3::Constant(0.5 - 5e-7), Vec3::Constant(0.5 + 5e-7), 1, false);
  return furnace("nested_size_ratio_1e6", "a cube of edge 1e-6 floating in a unit cube", builder.scene(), 12,
                 0.5);
}

StressCase t_vertices() {
  SceneBuilder builder;
  builder.finish(0.9, 1).box("", {0, 0, 0}, {1, 1, 1}, 1, true);
  const Scene whole = builder.scene();
  // the ceiling again, as 2 x 2 quads whose edges the walls do not share
  SceneBuilder split;
  split.finish(0.9, 1);
  for (int f = 0; f < whole.face_count(); ++f) {
    std::vector<Vec3> corners;
    for (int k = whole.face_offsets[f]; k < whole.face_offsets[f + 1]; ++k) {
      corners.push_back(whole.vertices[whole.face_vertices[k]]);
    }
    if (whole.groups[whole.face_groups[f]] != "ceiling")
      split.face(whole.groups[whole.face_groups[f]], corners);
  }
  split.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2, 2);
  return furnace("t_vertices", "closed cube whose ceiling is cut where the walls are not", split.scene(), 9,
                 0.9);
}

StressCase degenerate_faces() {
  SceneBuilder builder;
  builder.finish(0.5, 1).box("", {0, 0, 0}, {1, 1, 1}, 1, true);
  builder.face("point", {{0.3, 0.3, 0.3}, {0.3, 0.3, 0.3}, {0.3, 0.3, 0.3}});
  builder.face("line", {{0.1, 0.1, 0.5}, {0.5, 0.5, 0.5}, {0.9, 0.9, 0.5}});
  return furnace("degenerate_faces", "closed cube with a point and a line among its faces", builder.scene(),
                 6, 0.5);
}

StressCase duplicate_face() {
  SceneBuilder builder;
  builder.finish(0.5, 1).box("", {0, 0, 0}, {1, 1, 1}, 1, true);
  builder.face("floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  return furnace("duplicate_face", "closed cube with its floor given twice: merged, else rows exceed 1",
                 builder.scene(), 6, 0.5);
}

}  // namespace

std::vector<StressCase> furnace_cases() {
  return {
      furnished_furnace("reflectance_0", 0),
      furnished_furnace("reflectance_0.9", 0.9),
      furnished_furnace("reflectance_0.99", 0.99),
      furnished_furnace("reflectance_0.999", 0.999),
      furnished_furnace("reflectance_0.999999", 0.999999),
      all_white(),
      single_precision(),
      nested(),
      t_vertices(),
      degenerate_faces(),
      duplicate_face(),
      furnace("scale_1e-6", "closed cube of edge 1e-6", moved(cube(0.9, 1, 2), 1e-6, Vec3::Zero()), 24, 0.9),
      furnace("scale_1e6", "closed cube of edge 1e6", moved(cube(0.9, 1, 2), 1e6, Vec3::Zero()), 24, 0.9),
      furnace("offset_1e6", "unit cube 1e6 away from the origin", moved(cube(0.9, 1, 2), 1, {1e6, -1e6, 1e6}),
              24, 0.9),
      furnace("offset_1e8", "unit cube 1e8 away from the origin", moved(cube(0.9, 1, 2), 1, {1e8, -1e8, 1e8}),
              24, 0.9)};
}

}  // namespace luxel::stress
