#include <Eigen/Dense>

#include "luxel/dense_operator.h"
#include "stress/scene_builder.h"
#include "stress/stress_case.h"

namespace luxel::stress {

namespace {

// Form factors of a unit cube's sides, Howell catalogue C-11 and C-14 in 15 digits.
constexpr double opposite_sides = 0.199824895698387;
constexpr double adjacent_sides = 0.200043776075403;

Problem direct_problem(ExchangeMatrix exchange, std::vector<double> areas, std::vector<double> diagonal,
                       const std::vector<double>& reflectance, const std::vector<double>& emission) {
  const int n = exchange.size();
  Problem problem;
  problem.transport =
      std::make_shared<DenseOperator>(std::move(exchange), std::move(areas), std::move(diagonal));
  problem.reflectance = Eigen::Map<const Eigen::VectorXd>(reflectance.data(), n);
  problem.emission = Eigen::Map<const Eigen::VectorXd>(emission.data(), n);
  return problem;
}

// F_ij = a_j, the integrating sphere: a system of rank one, with patches that see themselves.
StressCase integrating_sphere() {
  StressCase result;
  result.name = "integrating_sphere";
  result.what = "five patches of a sphere, F_ij = a_j: rank one, with a diagonal";
  const double radiosity[5] = {1757.0 / 169, 603.0 / 169, 504.0 / 169, 1273.0 / 338, 2.5};
  for (int i = 0; i < 5; ++i) result.expected.radiosity.push_back({i, radiosity[i], radiosity[i]});
  result.expected.tolerance = 1e-11;
  result.expected.tolerance_reason = "residual 1e-12, amplified by at most 1 / (1 - 0.578)";
  result.expected.source = "H = sum a E / (1 - sum a rho), Jacquez and Kuppenheim 1955, in rationals";
  result.allowed = {Verdict::exact, Verdict::bounded};
  result.problem = [] {
    const std::vector<double> area = {0.1, 0.2, 0.3, 0.25, 0.15};
    ExchangeMatrix exchange(5, Precision::float64);
    std::vector<double> diagonal(5);
    for (int i = 0; i < 5; ++i) {
      diagonal[i] = area[i] * area[i];
      for (int j = 0; j < i; ++j) exchange.set(i, j, area[i] * area[j]);
    }
    return direct_problem(std::move(exchange), area, diagonal, {0.1, 0.9, 0.5, 0.95, 0}, {10, 0, 1, 0, 2.5});
  };
  return result;
}

// A cube whose floor stands in the system twice and was not merged: rows of ceiling and walls sum to 1.2.
Problem double_floor(double reflectance) {
  ExchangeMatrix exchange(7, Precision::float64);  // floor, floor, ceiling, four walls in turn
  for (int floor : {0, 1}) {
    exchange.set(2, floor, opposite_sides);
    for (int wall = 3; wall < 7; ++wall) exchange.set(wall, floor, adjacent_sides);
  }
  for (int wall = 3; wall < 7; ++wall) {
    exchange.set(wall, 2, adjacent_sides);
    for (int other = 3; other < wall; ++other) {
      exchange.set(wall, other, wall - other == 2 ? opposite_sides : adjacent_sides);
    }
  }
  return direct_problem(std::move(exchange), std::vector<double>(7, 1.0), std::vector<double>(7, 0.0),
                        std::vector<double>(7, reflectance), std::vector<double>(7, 1.0));
}

StressCase rows_above_one(const std::string& name, double reflectance) {
  StressCase result;
  result.name = name;
  result.what =
      "rows that sum to 1.2, spectral radius of F 1.148: the unmerged duplicate floor handed to the solvers";
  // floors, ceiling and walls are alike among themselves: three unknowns
  Eigen::Matrix3d coupling;
  coupling << 0, opposite_sides, 4 * adjacent_sides, 2 * opposite_sides, 0, 4 * adjacent_sides,
      2 * adjacent_sides, adjacent_sides, 2 * adjacent_sides + opposite_sides;
  const Eigen::Vector3d exact =
      (Eigen::Matrix3d::Identity() - reflectance * coupling).fullPivLu().solve(Eigen::Vector3d::Ones());
  if (exact.minCoeff() < 0) {
    result.expected = {
        ExpectationKind::singular, {}, 0, "", "rho F has spectral radius 1.148 rho > 1: no positive B"};
    result.allowed = {Verdict::refused};
  } else {
    for (int i = 0; i < 7; ++i) {
      const double value = exact[i < 2 ? 0 : i == 2 ? 1 : 2];
      result.expected.radiosity.push_back({i, value, value});
    }
    result.expected.tolerance = 1e-9;
    result.expected.tolerance_reason = "residual 1e-12, amplified by at most 1 / (1 - 1.148 rho)";
    result.expected.source = "3 x 3 system of floors, ceiling and walls";
    result.allowed = {Verdict::exact, Verdict::bounded};
  }
  result.problem = [reflectance] { return double_floor(reflectance); };
  return result;
}

StressCase one_absorber() {
  StressCase result;
  result.name = "reflectance_1_one_absorber";
  result.what = "closed cube, reflectance 1 but for one grey side: regular, all light ends there";
  // the grey side absorbs what all sides emit: (1 - rho) H = 6, B = E + rho H
  result.expected.radiosity = {{0, 1 + 0.5 * 12, 1 + 0.5 * 12}};
  result.expected.tolerance = 1e-9;
  result.expected.tolerance_reason = "rows close to 1e-12, amplified by the 12 bounces that light lives";
  result.expected.source = "energy balance";
  result.allowed = {Verdict::exact, Verdict::bounded};
  result.problem = [] {
    Scene scene = SceneBuilder().finish(1, 1).box("", {0, 0, 0}, {1, 1, 1}, 1, true).scene();
    return problem_of(painted(std::move(scene), "floor", 0.5, 1));
  };
  return result;
}

StressCase no_emission() {
  StressCase result;
  result.name = "no_emission";
  result.what = "closed cube of reflectance 0.9 in the dark";
  result.expected.radiosity = everywhere(6, 0);
  result.expected.tolerance = 0;
  result.expected.tolerance_reason = "nothing shines";
  result.expected.source = "E = 0 and I - rho F regular";
  result.allowed = {Verdict::exact};
  result.problem = [] {
    return problem_of(SceneBuilder().finish(0.9, 0).box("", {0, 0, 0}, {1, 1, 1}, 1, true).scene());
  };
  return result;
}

StressCase strong_coupling() {
  StressCase result;
  result.name = "cube_reflectance_0.999_one_lamp";
  result.what = "closed cube of reflectance 0.999, one side emits";
  result.expected.radiosity = {{0, 167.361226893290, 167.361226893290},
                               {1, 166.527633111084, 166.527633111084}};
  for (int i = 2; i < 6; ++i) result.expected.radiosity.push_back({i, 166.527784998906, 166.527784998906});
  result.expected.tolerance = 1e-8;
  result.expected.tolerance_reason = "rows close to 1e-12, amplified by 1 / (1 - 0.999)";
  result.expected.source =
      "6 x 6 system with form factors C-11 and C-14 of the Howell catalogue in 50 digits";
  result.allowed = {Verdict::exact, Verdict::bounded};
  result.problem = [] {
    Scene scene = SceneBuilder().finish(0.999, 0).box("", {0, 0, 0}, {1, 1, 1}, 1, true).scene();
    return problem_of(painted(std::move(scene), "floor", 0.999, 1));
  };
  return result;
}

// E = 1e12 on the floor and 1 on the ceiling: the answer is the sum of two, and the small one must not be
// lost in it.
StressCase wide_emission() {
  StressCase result;
  result.name = "emission_spanning_1e12";
  result.what = "two closed cubes, one with E = 1e12, one with E = 1";
  result.expected.radiosity = everywhere(6, 2e12);
  for (int i = 6; i < 12; ++i) result.expected.radiosity.push_back({i, 2, 2});
  result.expected.tolerance = 1e-10;
  result.expected.tolerance_reason =
      "rows close to 1e-12, amplified by 1 / (1 - 0.5); relative to the largest B";
  result.expected.source = "white furnace in each";
  result.allowed = {Verdict::exact, Verdict::bounded};
  result.problem = [] {
    SceneBuilder builder;
    builder.finish(0.5, 1e12).box("a_", {0, 0, 0}, {1, 1, 1}, 1, true);
    return problem_of(builder.finish(0.5, 1).box("b_", {2, 0, 0}, {3, 1, 1}, 1, true).scene());
  };
  return result;
}

StressCase checkerboard() {
  const int n = 8;
  SceneBuilder builder;
  builder.finish(0, 0).box("", {0, 0, 0}, {1, 1, 1}, n, true);
  Scene scene = builder.scene();
  // finishes: black, white, black and shining, white and shining
  scene.finishes.resize(1);
  for (const auto& [reflectance, emission] : {std::pair{0.9, 0.0}, {0.0, 1.0}, {0.9, 1.0}}) {
    scene.finishes.push_back({Rgb::Constant(reflectance), Rgb::Constant(emission), false});
  }
  for (int f = 0; f < scene.face_count(); ++f) {
    const int cell = f % (n * n);
    const bool white = (cell % n + cell / n) % 2 == 1;
    scene.face_finishes[f] = (white ? 1 : 0) + (scene.groups[scene.face_groups[f]] == "ceiling" ? 2 : 0);
  }
  StressCase result;
  result.name = "checkerboard";
  result.what = "closed cube of 8 x 8 cells a side, reflectance 0.9 and 0 in turn, the ceiling shines";
  // black cells of floor and walls stay dark whatever arrives there
  for (int f = 0; f < scene.face_count(); ++f) {
    if (scene.face_finishes[f] == 0) result.expected.radiosity.push_back({f, 0, 0});
    if (scene.face_finishes[f] == 2) result.expected.radiosity.push_back({f, 1, 1});
  }
  result.expected.tolerance = 0;
  result.expected.tolerance_reason = "a black patch sends out its emission and nothing else";
  result.expected.source = "B = E where rho = 0";
  result.allowed = {Verdict::exact};
  result.problem = [scene] { return problem_of(scene); };
  return result;
}

}  // namespace

std::vector<StressCase> algebra_cases() {
  return {integrating_sphere(),
          rows_above_one("rows_above_1_reflectance_0.8", 0.8),
          rows_above_one("rows_above_1_reflectance_0.86", 0.86),
          rows_above_one("rows_above_1_reflectance_0.9", 0.9),
          one_absorber(),
          no_emission(),
          strong_coupling(),
          wide_emission(),
          checkerboard()};
}

}  // namespace luxel::stress
