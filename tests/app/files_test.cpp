// The files of `luxel solve`, read back by what others read them with.
#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

std::string lit_cube(const Folder& folder) {
  return folder.write("scene.json",
                      scene_text("cube", {{"white", {{"reflectance", 0.5}}}},
                                 {{"ceiling", {{"reflectance", 0.8}, {"exitance", {3, 2, 1}}}}}));
}

// python3-vtk9, Debian's own interpreter: another python3 may stand first in PATH
std::string read_by_vtk(const std::string& file) {
  const Outcome outcome =
      run_program("/usr/bin/python3", {std::string(LUXEL_TEST_DATA) + "/print_vtk.py", file});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

TEST(Files, VtkReadsEveryArrayOfTheInterface) {
  const Folder folder;

  const Outcome outcome = luxel({"solve", lit_cube(folder), "--patches", "60", "-o", folder.path("a.vtp")});

  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string found = read_by_vtk(folder.path("a.vtp"));
  for (const char* array :
       {"cell/radiosity double", "cell/irradiance double", "cell/emission double", "cell/reflectance double",
        "cell/luminance double", "cell/row_sum_error double", "cell/material_id", "cell/group_id",
        "cell/display_rgb unsigned char", "point/radiosity_vertex", "point/display_rgb unsigned char",
        "field/material_names", "field/group_names"}) {
    EXPECT_NE(found.find(std::string("\n") + array), std::string::npos) << array;
  }
}

TEST(Files, SeriesHasOneStepABounce) {
  const Folder folder;

  const Outcome outcome =
      luxel({"solve", lit_cube(folder), "--as-is", "--bounces", "3", "-o", folder.path("b.pvd")});

  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string list = folder.read("b.pvd");
  int steps = 0;
  for (const std::string& file : folder.files()) {
    if (file.rfind("b_", 0) != 0) continue;
    EXPECT_NE(list.find(file), std::string::npos) << file;
    ++steps;
  }
  EXPECT_EQ(steps, 4);  // the emission, then three bounces
}

TEST(Files, PicturesAreWrittenWhole) {
  const Folder folder;

  const Outcome outcome =
      luxel({"solve", lit_cube(folder), "--patches", "60", "-o", folder.path("a.png"), "-o",
             folder.path("a.exr"), "-o", folder.path("a.hdr"), "-o", folder.path("a.ply")});

  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(folder.read("a.png").substr(1, 3), "PNG");
  EXPECT_EQ(folder.read("a.exr").substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_EQ(folder.read("a.hdr").substr(0, 2), "#?");
  EXPECT_EQ(folder.read("a.ply").substr(0, 3), "ply");
  EXPECT_EQ(folder.files().size(), 5u);  // no temporaries beside the four and the scene
}

}  // namespace
}  // namespace luxel::test
