// Whatever cannot be used ends with status 2 and exactly one line on stderr, prints nothing on stdout and
// leaves no file behind.
#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

constexpr const char* cube_obj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 1 1\nv 1 1 1\nv 1 0 1\nv 0 0 1\n"
    "g floor\nusemtl white\nf 1 2 3 4\ng ceiling\nf 5 6 7 8\ng walls\nf 1 8 7 2\nf 2 7 6 3\nf 3 6 5 4\nf 4 5 "
    "8 1\n";

/// One kind of bad input: a file that is written as `name` (nothing where the text is empty), the arguments
/// after `luxel` ({} stands for the test's folder), and words that the message must have.
struct BadInput {
  std::string what;
  std::string name, text;
  std::vector<std::string> arguments;
  std::vector<std::string> expected;
};

void PrintTo(const BadInput& bad, std::ostream* stream) {
  *stream << bad.what;
}

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsOneLineOnStderrAndLeavesNothingBehind) {
  const BadInput& bad = GetParam();
  const Folder folder;
  folder.write("cube.obj", cube_obj);
  if (!bad.name.empty()) folder.write(bad.name, bad.text);
  const auto files_before = folder.files();
  std::vector<std::string> arguments;
  for (std::string argument : bad.arguments) {
    if (const auto at = argument.find("{}"); at != std::string::npos)
      argument.replace(at, 2, folder.path(""));
    arguments.push_back(argument);
  }

  const Outcome outcome = luxel(arguments);

  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  for (const std::string& word : bad.expected)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  EXPECT_EQ(folder.files(), files_before);
}

std::vector<std::string> solve(const std::string& file, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"solve", "{}" + file, "-o", "{}out.csv", "-o", "{}out.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

BadInput scene_file(const std::string& what, const std::string& text, std::vector<std::string> expected) {
  return {what, "bad.json", text, solve("bad.json"), std::move(expected)};
}

BadInput obj_file(const std::string& what, const std::string& text, std::vector<std::string> expected) {
  return {what, "bad.obj", text, solve("bad.obj"), std::move(expected)};
}

BadInput option(const std::string& what, std::vector<std::string> more, std::vector<std::string> expected) {
  return {what, "", "", solve("cube.obj", std::move(more)), std::move(expected)};
}

const std::vector<BadInput> command_lines = {
    {"NoCommand", "", "", {}, {"command"}},
    {"UnknownCommand", "", "", {"slove", "{}cube.obj"}, {"slove", "did you mean 'solve'"}},
    {"CommandOfALaterVersion", "", "", {"render"}, {"render"}},
    {"NoScene", "", "", {"solve"}, {"scene"}},
    {"TwoScenes", "", "", {"solve", "{}cube.obj", "{}cube.obj"}, {"unexpected"}},
    option("UnknownOption", {"--pathes", "100"}, {"--pathes", "did you mean '--patches'"}),
    option("OptionWithoutItsValue", {"--patches"}, {"--patches"}),
    option("NumberThatIsNone", {"--tolerance", "small"}, {"--tolerance", "small"}),
    option("ToleranceZero", {"--tolerance", "0"}, {"--tolerance", "'0'"}),
    option("NegativeTolerance", {"--tolerance=-1e-6"}, {"--tolerance", "-1e-6"}),
    option("ToleranceNan", {"--tolerance", "nan"}, {"--tolerance", "nan"}),
    option("AccuracyOutOfRange", {"--accuracy", "3"}, {"--accuracy", "'3'", "1e-8"}),
    option("PatchesZero", {"--patches", "0"}, {"--patches", "'0'"}),
    option("TwoSizesOfPatches", {"--patches", "100", "--as-is"}, {"--patches", "--as-is"}),
    option("UnknownSolver", {"--solver", "magic"}, {"--solver", "magic", "cholesky"}),
    option("BouncesOfADirectSolver", {"--solver", "lu", "--bounces", "3"}, {"--bounces", "neumann"}),
    option("OperatorOfNoKind", {"--operator", "sparse"}, {"--operator", "sparse", "gather"}),
    option("BouncesOfAGather", {"--operator", "gather", "--bounces", "3"}, {"gather", "--bounces", "dense"}),
    option("SymmetricSolverOfAGather", {"--operator", "gather", "--solver", "cg"}, {"gather", "--solver cg"}),
    option("SavedGather", {"--operator", "gather", "--save", "{}x"}, {"gather", "--save", "dense"}),
    option("ExactVisibilityOfAGather", {"--operator", "gather", "--visibility", "exact"},
           {"gather", "exact"}),
    option("SeriesOfAGather", {"--operator", "gather", "-o", "{}x.pvd"}, {"gather", "x.pvd"}),
    option("GatherFinerThanItCan", {"--operator", "gather", "--accuracy", "1e-6"},
           {"gather", "1e-06", "dense"}),
    option("ErrorBarOfNoKind", {"--error-bar", "maybe"}, {"--error-bar", "maybe"}),
    option("MemorySuffixUnknown", {"--memory", "3Q"}, {"--memory", "3Q"}),
    option("ThreadsZero", {"--threads", "0"}, {"--threads", "'0'"}),
    option("MemoryThatDoesNotSuffice", {"--memory", "1M"}, {"--memory", "MiB"}),
    option("OutputOfAnUnknownKind", {"-o", "{}out.xyz"}, {"out.xyz", ".csv"}),
    option("OutputInAFolderThatIsNotThere", {"-o", "{}none/out.csv"}, {"none", "does not exist"}),
    option("OutputAskedForTwice", {"-o", "{}out.csv"}, {"out.csv", "twice"}),
    option("OutputOverTheScene", {"-o", "{}cube.obj"}, {"cube.obj"}),
};

const std::vector<BadInput> scene_files = {
    {"SceneThatIsNotThere", "", "", solve("none.obj"), {"none.obj"}},
    {"SceneOfAnUnknownKind", "scene.txt", "v 0 0 0\n", solve("scene.txt"), {"scene.txt"}},
    scene_file("JsonThatDoesNotParse", "{\n\"mesh\": \"cube.obj\",\n", {"bad.json"}),
    scene_file("SceneWithoutAMesh", "{\"unit\": \"m\"}", {"bad.json", "mesh"}),
    scene_file("MeshThatIsNotThere", "{\"mesh\": \"none.obj\"}", {"none.obj"}),
    scene_file("UnknownKey", R"({"mesh": "cube.obj", "materails": {}})", {"materails", "materials"}),
    scene_file("UnknownMaterial", R"({"mesh": "cube.obj", "materials": {"whte": {"reflectance": 0.5}}})",
               {"whte", "white"}),
    scene_file("UnknownSurface", R"({"mesh": "cube.obj", "surfaces": {"ceilling": {"reflectance": 0.5}}})",
               {"ceilling", "ceiling"}),
    scene_file("ReflectanceAboveOne", R"({"mesh": "cube.obj", "materials": {"white": {"reflectance": 1.2}}})",
               {"white", "1.2"}),
    scene_file("NegativeReflectance",
               R"({"mesh": "cube.obj", "materials": {"white": {"reflectance": -0.1}}})", {"white", "-0.1"}),
    scene_file("NegativeEmission",
               R"({"mesh": "cube.obj", "materials": {"white": {"exitance": [1, -2, 3]}}})", {"white", "-2"}),
    scene_file("TwoChannelsInsteadOfThree",
               R"({"mesh": "cube.obj", "materials": {"white": {"reflectance": [0.1, 0.2]}}})", {"white"}),
    scene_file("ReflectanceOneInAClosedEnclosureThatEmits",
               R"({"mesh": "cube.obj", "materials": {"white": {"reflectance": 1, "exitance": 1}}})",
               {"enclosure"}),
    obj_file("EmptyMesh", "", {"bad.obj"}),
    obj_file("VertexThatIsNoNumber", "v 0 0 zero\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"bad.obj:1", "zero"}),
    obj_file("VertexNan", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"bad.obj:1", "nan"}),
    obj_file("VertexWithTwoCoordinates", "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"bad.obj:1"}),
    obj_file("CornerOutOfRange", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", {"bad.obj:4", "4"}),
    obj_file("CornerZero", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", {"bad.obj:4", "0"}),
    obj_file("FaceOfTwoCorners", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", {"bad.obj:4"}),
    obj_file("OnlyFacesWithoutArea", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", {"bad.obj"}),
};

std::string name_of(const testing::TestParamInfo<BadInput>& info) {
  return info.param.what;
}

INSTANTIATE_TEST_SUITE_P(CommandLine, BadInputTest, testing::ValuesIn(command_lines), name_of);
INSTANTIATE_TEST_SUITE_P(SceneFile, BadInputTest, testing::ValuesIn(scene_files), name_of);

}  // namespace
}  // namespace luxel::test
