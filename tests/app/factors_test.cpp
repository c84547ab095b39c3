// `luxel factors` against the closed forms of the Howell catalogue.
#include <array>
#include <cmath>
#include <sstream>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

using nlohmann::json;

double between_groups(const std::string& mesh_name, const std::string& from, const std::string& to) {
  const Outcome outcome =
      luxel({"factors", mesh(mesh_name), "--as-is", "--by", "group", "--accuracy", "1e-6", "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  if (outcome.status > 1) return NAN;
  const json report = json::parse(outcome.out);
  const auto groups = report["groups"].get<std::vector<std::string>>();
  const auto index = [&](const std::string& name) {
    return std::find(groups.begin(), groups.end(), name) - groups.begin();
  };
  return report["form_factors"][index(from)][index(to)];
}

// C-11: equal parallel squares at the distance of their side; asked for to 1e-6
TEST(Factors, ParallelSquaresHaveTheirClosedForm) {
  EXPECT_NEAR(between_groups("vf_c11_1x1_h1", "surf1", "surf2"), 0.1998248956984, 1e-6 * 0.2);
}

// C-14: perpendicular unit squares with a common edge, where the kernel is singular
TEST(Factors, SquaresWithACommonEdgeHaveTheirClosedForm) {
  EXPECT_NEAR(between_groups("vf_c14_1x1x1", "surf1", "surf2"), 0.20004377607540, 1e-6 * 0.2);
}

// a centred square of half the side, half way, hides its part: closed form in docs/theory.md's C-11
TEST(Factors, SquaresWithABlockerBetweenHaveTheirClosedForm) {
  EXPECT_NEAR(between_groups("occ_mid_square_0p5", "surf1", "surf2"), 0.09950629459898, 1e-6 * 0.2);
}

// A cube of 6 x 6 quads a side with 64 turned leaves in it, each with two sides.
std::string room_with_leaves() {
  std::ostringstream obj;
  obj.precision(17);
  int corners = 0;
  const auto quad = [&](const std::array<Eigen::Vector3d, 4>& q) {
    for (const Eigen::Vector3d& x : q) obj << "v " << x.transpose() << '\n';
    obj << "f " << corners + 1 << ' ' << corners + 2 << ' ' << corners + 3 << ' ' << corners + 4 << '\n';
    corners += 4;
  };
  const auto both_sides = [&](const std::array<Eigen::Vector3d, 4>& q) {
    quad(q);
    quad({q[3], q[2], q[1], q[0]});
  };
  constexpr int k = 6;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](double side, double i, double j) {
      Eigen::Vector3d x;
      x[axis] = side;
      x[(axis + 1) % 3] = i / k;
      x[(axis + 2) % 3] = j / k;
      return x;
    };
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j < k; ++j) {
        quad({at(0, i, j), at(0, i + 1, j), at(0, i + 1, j + 1), at(0, i, j + 1)});
        quad({at(1, i, j), at(1, i, j + 1), at(1, i + 1, j + 1), at(1, i + 1, j)});
      }
    }
  }
  for (int leaf = 0; leaf < 64; ++leaf) {
    const Eigen::Vector3d centre = Eigen::Vector3d(leaf % 4 + 0.5, leaf / 4 % 4 + 0.5, leaf / 16 + 0.5) / 4;
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7 * leaf, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(1.1 * leaf, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(1.9 * leaf, Eigen::Vector3d::UnitZ()))
                                     .toRotationMatrix();
    const Eigen::Vector3d u = 0.07 * turn.col(0), v = 0.05 * turn.col(1);
    both_sides({centre - u - v, centre + u - v, centre + u + v, centre - u + v});
  }
  return obj.str();
}

// The errors of rays have a tail: at 5e-3 the largest row of the leaves is 2.5 times that at the first go.
TEST(Factors, AreComputedAgainWhereClosedRowsAreWorseThanAsked) {
  const Folder folder;
  const std::string leaves = folder.write("leaves.obj", room_with_leaves());

  for (const double accuracy : {1e-2, 5e-3, 3e-3}) {
    const Outcome outcome =
        luxel({"factors", leaves, "--as-is", "--accuracy", std::to_string(accuracy), "--json"});

    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json found = json::parse(outcome.out)["operator"];
    EXPECT_NEAR(found["accuracy"], accuracy, 1e-12);
    EXPECT_LE(found["row_sum_error"]["max"], 2 * accuracy);
    EXPECT_LE(found["row_sum_error"]["rms"], accuracy);
  }
}

// Walls of an L-shaped room that see each other past its inner corner, which both walls there hide together:
// F = 0.0328902 and 0.0986707 by the algebra of rectangles (Pinney and Bean)
TEST(Factors, WallsAroundACornerHaveTheirExactFactor) {
  EXPECT_NEAR(between_groups("lroom_pinney_bean", "srf1", "srf5"), 0.032890247563088, 1e-6 * 0.033);
  EXPECT_NEAR(between_groups("lroom_pinney_bean", "srf2", "srf6"), 0.098670742689264, 1e-6 * 0.099);
}

// A triangle 1 x 1e-5 below a unit square: rays for its share of sky start from its middle, which must not
// count against its exact row.
TEST(Factors, SliversDoNotFailForTheirShareOfSky) {
  EXPECT_NEAR(between_groups("vf_sliver_100000", "surf1", "surf2"), 0.51666988823, 1e-6 * 0.52);
}

TEST(Factors, TableOfGroupsGoesToStdout) {
  const Outcome outcome = luxel({"factors", mesh("cube"), "--as-is", "--by", "group"});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("floor"), std::string::npos);
  EXPECT_NE(outcome.out.find("0.19982"), std::string::npos) << outcome.out;
}

TEST(Factors, EveryFormatIsWritten) {
  const Folder folder;

  const Outcome outcome =
      luxel({"factors", mesh("cube"), "--as-is", "-o", folder.path("f.csv"), "-o", folder.path("f.mtx"), "-o",
             folder.path("f.h5"), "-o", folder.path("f.json")});

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"f.csv", "f.h5", "f.json", "f.mtx"}));
  EXPECT_EQ(folder.read("f.csv").rfind("i,j,F\n", 0), 0u);
  EXPECT_EQ(folder.read("f.mtx").rfind("%%MatrixMarket matrix coordinate real general", 0), 0u);
  const json report = json::parse(folder.read("f.json"));
  EXPECT_FALSE(report.contains("solver"));
  EXPECT_FALSE(report.contains("energy"));
}

// From the middle of the floor of a unit cube to a wall: F = (1 - F_ceiling) / 4 by symmetry, with C-4.1's
// ceiling: four corner squares, F = 4 / (2 pi) * 2 * a / sqrt(1 + a^2) * atan(a / sqrt(1 + a^2)), a = 1/2.
TEST(Factors, PointHasItsClosedForm) {
  const Outcome outcome = luxel({"factors", mesh("cube"), "--as-is", "--point", "0.5,0.5,0,0,0,2", "--json"});

  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json point = json::parse(outcome.out)["point"];
  const double a = 0.5, root = std::sqrt(1 + a * a);
  const double ceiling = 4 / (2 * M_PI) * 2 * a / root * std::atan(a / root);
  const auto groups = point["groups"].get<std::vector<std::string>>();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double exact = groups[i] == "floor" ? 0 : groups[i] == "ceiling" ? ceiling : (1 - ceiling) / 4;
    EXPECT_NEAR(point["form_factors"][i].get<double>(), exact, 1e-9) << groups[i];  // exact up to rounding
  }
  EXPECT_NEAR(point["open"].get<double>(), 0, 1e-9);
}

TEST(Factors, RawRowsAreNotScaled) {
  const auto sum_of_row_0 = [](std::vector<std::string> more) {
    const Folder folder;
    std::vector<std::string> arguments = {"factors", mesh("room_with_block"), "--as-is", "--full-precision",
                                          "-o",      folder.path("f.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_LE(luxel(arguments).status, 1);
    std::istringstream rows(folder.read("f.csv"));
    std::string line;
    double sum = 0;
    std::getline(rows, line);
    while (std::getline(rows, line) && line.rfind("0,", 0) == 0)
      sum += std::stod(line.substr(line.rfind(',') + 1));
    return sum;
  };

  EXPECT_NEAR(sum_of_row_0({}), 1, 1e-12);  // closure of the operator as solved
  EXPECT_NE(sum_of_row_0({"--raw"}), sum_of_row_0({}));
}

TEST(Factors, KeptOnesGiveTheSameBitsAsComputedOnes) {
  const Folder folder;
  const std::string scene = folder.write(
      "scene.json",
      scene_text("room_with_block", {{"white", {{"reflectance", 0.7}}}}, {{"ceiling", {{"exitance", 1}}}}));
  const std::string kept = folder.path("room.luxel");
  const auto solve = [&](const std::string& csv, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"solve", scene,           "--patches", "300", "--full-precision",
                                          "-o",    folder.path(csv)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = luxel(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return folder.read(csv);
  };
  ASSERT_EQ(luxel({"factors", scene, "--patches", "300", "--save", kept}).status, 0);

  const std::string computed = solve("computed.csv", {});

  EXPECT_FALSE(computed.empty());
  EXPECT_TRUE(computed == solve("loaded.csv", {"--load", kept}));
}

TEST(Factors, KeptOnesOfOtherPatchesOrCutOffAreRefused) {
  const Folder folder;
  const std::string kept = folder.path("cube.luxel");
  ASSERT_EQ(luxel({"factors", mesh("cube"), "--as-is", "--save", kept}).status, 0);
  const std::string whole = folder.read("cube.luxel");
  folder.write("short.luxel", whole.substr(0, whole.size() - 9));
  folder.write("foreign.luxel", "v 0 0 0\n");

  for (const auto& [scene, file] :
       std::vector<std::pair<std::string, std::string>>{{"tetrahedron", "cube.luxel"},
                                                        {"cube", "short.luxel"},
                                                        {"cube", "foreign.luxel"},
                                                        {"cube", "none.luxel"}}) {
    const Outcome outcome = luxel({"solve", mesh(scene), "--as-is", "--load", folder.path(file)});
    EXPECT_EQ(outcome.status, 2) << file;
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace luxel::test
