#include "luxel/write_vtk.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <numbers>

#include "io/scratch.h"
#include "io/small_mesh.h"
#include "luxel/input_error.h"
#include "luxel/write_file.h"

namespace luxel {
namespace {

using testing::content;
using testing::Scratch;

// What VTK's own reader finds in the file
std::string read_back(const std::filesystem::path& path) {
  return testing::output_of("/usr/bin/python3 " LUXEL_TEST_DATA "/print_vtk.py " + path.string());
}

::testing::AssertionResult has_line(const std::string& text, const std::string& line) {
  if (text.find("\n" + line + "\n") != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no line '" << line << "' in\n" << text;
}

struct Sample {
  PatchMesh mesh = luxel::testing::half_quad_half_triangles();
  GouraudMesh gouraud = luxel::testing::own_vertices(mesh);
  RadiositySolution solution;
  PatchField vertex_radiosity = PatchField::Constant(6, 3, 2);

  Sample() {
    solution.radiosity = PatchField(3, 3);
    solution.radiosity << 1, 2, 3, 0.1, 0.2, 0.3, 1.0 / 3, 0, 0;
    solution.irradiance = 2 * solution.radiosity;
  }
};

TEST(WriteVtk, PolygonsReadBackWithEveryArrayAndUnit) {
  const Scratch scratch;
  const Sample sample;
  const std::vector<double> row_sum_error = {1e-3, 2e-3, 4e-3};

  write_vtk(scratch / "a.vtp", sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity,
            {.row_sum_error = row_sum_error});

  const std::string text = read_back(scratch / "a.vtp");
  EXPECT_EQ(text.substr(0, text.find('\n')), "class vtkPolyData");
  EXPECT_TRUE(has_line(text, "points 0,0,0 0.5,0,0 1,0,0 1,1,0 0.5,1,0 0,1,0"));
  EXPECT_TRUE(has_line(text, "cell 9 0 1 4 5"));  // 9: a quad, 5: a triangle, in VTK's numbering
  EXPECT_TRUE(has_line(text, "cell 5 1 2 3"));
  EXPECT_TRUE(has_line(text,
                       "cell/radiosity double RGB [W/m^2]: "
                       "1|2|3|0.10000000000000001|0.20000000000000001|0.29999999999999999|"
                       "0.33333333333333331|0|0"));
  EXPECT_TRUE(has_line(text,
                       "cell/irradiance double RGB [W/m^2]: "
                       "2|4|6|0.20000000000000001|0.40000000000000002|0.59999999999999998|"
                       "0.66666666666666663|0|0"));
  EXPECT_TRUE(has_line(text, "cell/emission double RGB [W/m^2]: 0|0|0|1|2|3|0|0|0"));
  EXPECT_NE(text.find("cell/reflectance double RGB [1]: 0.5|0.5|0.5|0.1"), std::string::npos);
  EXPECT_TRUE(has_line(text, "cell/material_id int - []: 0|1|0"));
  EXPECT_TRUE(has_line(text, "cell/group_id int - []: 0|0|0"));
  EXPECT_TRUE(has_line(text, "cell/row_sum_error double - [1]: 0.001|0.002|0.0040000000000000001"));
  EXPECT_NE(text.find("cell/display_rgb unsigned char RGB []: "), std::string::npos);
  EXPECT_NE(text.find("point/radiosity_vertex double RGB [W/m^2]: 2|2|2"), std::string::npos);
  EXPECT_NE(text.find("point/display_rgb unsigned char RGB []: "), std::string::npos);
  EXPECT_TRUE(has_line(text, "field/material_names string - []: white|lamp, \"hot\""));
  EXPECT_TRUE(has_line(text, "field/group_names string - []: floor"));
  EXPECT_TRUE(has_line(text, "field/view_target double XYZ [m]: 0.5|0.5|0"));
  EXPECT_TRUE(has_line(text, "active luminance"));
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(WriteVtk, LuminanceIsThatOfTheRadiance) {
  const Scratch scratch;
  Sample sample;
  sample.solution.radiosity.setConstant(std::numbers::pi);  // luminance 1, for the weights sum to 1

  write_vtk(scratch / "a.vtp", sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity);

  const std::string text = read_back(scratch / "a.vtp");
  const auto at = text.find("cell/luminance double - [W/(m^2 sr)]: ");
  ASSERT_NE(at, std::string::npos) << text;
  // three roundings of products and two of sums
  EXPECT_NEAR(std::stod(text.substr(text.find(": ", at) + 2)), 1, 1e-15);
}

TEST(WriteVtk, UnstructuredGridsHoldTheSameCells) {
  const Scratch scratch;
  const Sample sample;

  write_vtk(scratch / "a.vtu", sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity);

  const std::string text = read_back(scratch / "a.vtu");
  EXPECT_EQ(text.substr(0, text.find('\n')), "class vtkUnstructuredGrid");
  EXPECT_TRUE(has_line(text, "cell 9 0 1 4 5"));
  EXPECT_TRUE(has_line(text, "cell 5 1 3 4"));
  EXPECT_TRUE(has_line(text, "cell/emission double RGB [W/m^2]: 0|0|0|1|2|3|0|0|0"));
}

TEST(WriteVtk, FieldDataHoldsTheReportsFigures) {
  const Scratch scratch;
  const Sample sample;
  Report report;
  report.run.version = "1.2.3";
  report.solver.emplace();
  report.solver->method = "cg";
  report.solver->relative_residual = 0.25;
  report.solver->error_bound = not_known;
  report.energy.emplace();
  report.energy->emitted = {1, 2, 3};

  write_vtk(scratch / "a.vtp", sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity,
            {.report = &report});

  const std::string text = read_back(scratch / "a.vtp");
  EXPECT_TRUE(has_line(text, "field/luxel_version string - []: 1.2.3"));
  EXPECT_TRUE(has_line(text, "field/solver string - []: cg"));
  EXPECT_TRUE(has_line(text, "field/relative_residual double - []: 0.25"));
  EXPECT_TRUE(has_line(text, "field/emitted double RGB [W]: 1|2|3"));
  EXPECT_EQ(text.find("field/error_bound"), std::string::npos);
}

TEST(WriteVtk, TheSameInputGivesTheSameBytes) {
  const Scratch scratch;
  const Sample sample;

  write_vtk(scratch / "a.vtp", sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity);
  write_vtk(scratch / "b.vtp", sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity);

  EXPECT_EQ(content(scratch / "a.vtp"), content(scratch / "b.vtp"));
}

TEST(WriteVtk, AFileThatGrowsBeyondTheLimitLeavesTheOldOne) {
  const Scratch scratch;
  const PatchMesh mesh = luxel::testing::inward_cube(20);
  const GouraudMesh gouraud = luxel::testing::own_vertices(mesh);
  const PatchField vertex_radiosity = PatchField::Random(mesh.vertices.size(), 3).cwiseAbs();
  const auto solution = luxel::testing::solution(PatchField::Random(mesh.size(), 3).cwiseAbs(),
                                                 PatchField::Random(mesh.size(), 3).cwiseAbs());
  write_file(scratch / "a.vtp", "old");
  rlimit limit{}, small{};
  getrlimit(RLIMIT_FSIZE, &limit);
  small = limit;
  small.rlim_cur = 50'000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);

  EXPECT_THROW(write_vtk(scratch / "a.vtp", mesh, gouraud, solution, vertex_radiosity), InputError);

  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(content(scratch / "a.vtp"), "old");
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(WriteVtk, SaysThatADeviceIsFull) {
  const Sample sample;
  std::filesystem::path link =
      std::filesystem::temp_directory_path() / ("luxel-full-" + std::to_string(getpid()) + ".vtp");
  std::filesystem::create_symlink("/dev/full", link);

  EXPECT_THROW(write_vtk(link, sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity),
               InputError);

  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  std::filesystem::remove(link);
}

TEST(WriteVtk, RefusesAnotherExtension) {
  const Scratch scratch;
  const Sample sample;

  EXPECT_THROW(
      write_vtk(scratch / "a.vtk", sample.mesh, sample.gouraud, sample.solution, sample.vertex_radiosity),
      InputError);
  EXPECT_EQ(scratch.entries(), 0);
}

TEST(VtkSeries, CanBeReadAfterEveryStep) {
  const Scratch scratch;
  const Sample sample;
  VtkSeries series(scratch / "run.pvd", sample.mesh, sample.gouraud);
  EXPECT_EQ(scratch.entries(), 0);

  series.add(0, sample.solution.radiosity, sample.vertex_radiosity);
  const std::string first = content(scratch / "run.pvd");
  series.add(1.5, 2 * sample.solution.radiosity, sample.vertex_radiosity);
  const std::string second = content(scratch / "run.pvd");

  EXPECT_NE(first.find("timestep=\"0\" part=\"0\" file=\"run_0000.vtp\""), std::string::npos) << first;
  EXPECT_EQ(first.find("run_0001"), std::string::npos);
  EXPECT_NE(second.find("timestep=\"1.5\" part=\"0\" file=\"run_0001.vtp\""), std::string::npos) << second;
  EXPECT_NE(read_back(scratch / "run_0001.vtp").find("cell/radiosity double RGB [W/m^2]: 2|4|6"),
            std::string::npos);
  EXPECT_TRUE(has_line(read_back(scratch / "run_0001.vtp"), "field/TimeValue double - []: 1.5"));
  EXPECT_EQ(scratch.entries(), 3);
}

}  // namespace
}  // namespace luxel
