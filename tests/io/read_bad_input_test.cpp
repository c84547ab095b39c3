#include <unistd.h>

#include <cstdlib>
#include <ostream>
#include <stdexcept>

#include "io/scene_files.h"

namespace luxel {
namespace {

using testing::SceneFiles;
using testing::square_vertices;

const std::string square(square_vertices);
const std::string square_face = square + "g floor\nusemtl white\nf 1 2 3 4\n";

// A file that cannot be used, and the whole message that says so.
struct BadInput {
  std::string name;  // of the kind of trouble
  std::string file;
  std::string text;
  std::string message;
};

void PrintTo(const BadInput& bad, std::ostream* stream) {
  *stream << bad.name;
}

BadInput bad_obj(const std::string& name, const std::string& text, const std::string& message) {
  return {name, "a.obj", text, "a.obj" + message};
}

// The material library of a square whose material is white.
BadInput bad_mtl(const std::string& name, const std::string& text, const std::string& message) {
  return {name, "a.mtl", text, "a.mtl" + message};
}

// A scene file over a square of group floor and material white.
BadInput bad_json(const std::string& name, const std::string& text, const std::string& message) {
  return {name, "a.json", text, "a.json" + message};
}

BadInput bad_key(const std::string& name, const std::string& key, const std::string& message) {
  return bad_json(name, "{\"mesh\": \"square.obj\",\n" + key + "}", ":2: " + message);
}

class ReadBadInput : public ::testing::TestWithParam<BadInput> {};

TEST_P(ReadBadInput, IsRefusedWithFileLineAndItem) {
  const BadInput& bad = GetParam();
  SceneFiles files;
  files.with("square.obj", square_face).with("library.obj", "mtllib a.mtl\n" + square_face);
  files.with(bad.file, bad.text);

  const std::string message = files.refusal_of(bad.file == "a.mtl" ? "library.obj" : bad.file);

  EXPECT_EQ(message, bad.message);
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Obj, ReadBadInput,
    ::testing::Values(
        bad_obj("Empty", "", ": is empty"), bad_obj("NoFaces", square, ": has no faces"),
        bad_obj("NaN", "v 0 0 0\nv nan 0 0\n", ":2: vertex coordinate \"nan\"; expected a finite number"),
        bad_obj("Infinity", "v 0 inf 0\n", ":1: vertex coordinate \"inf\"; expected a finite number"),
        bad_obj("Overflow", "v 0 1e999 0\n", ":1: vertex coordinate \"1e999\"; expected a finite number"),
        bad_obj("NoNumber", "v 0 0 0\r\nv a b c\r\n",
                ":2: vertex coordinate \"a\"; expected a finite number"),
        bad_obj("DecimalComma", "v 0,5 0 0\n", ":1: vertex coordinate \"0,5\"; expected a finite number"),
        bad_obj("TwoCoordinates", "v 0 0\n", ":1: vertex with 2 numbers; expected v x y z"),
        bad_obj("EightCoordinates", "v 1 2 3 4 5 6 7 8\n",
                ":1: vertex with more than 7 numbers; expected v x y z"),
        bad_obj("FarTooLarge", "v 1e200 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                ": a vertex further than 1e60 m from the origin; expected lengths that can be squared"),
        bad_obj("IndexZero", square + "f 0 1 2\n", ":5: face corner \"0\"; vertices count from 1"),
        bad_obj("IndexBeyondTheEnd", square + "f 1 2 9\n", ":5: face corner \"9\"; the file has 4 vertices"),
        bad_obj("IndexBeforeTheStart", square + "f 1 2 -5\n",
                ":5: face corner \"-5\"; so far there are 4 vertices"),
        bad_obj("IndexOverflow", square + "f 1 2 99999999999999999999\n",
                ":5: face corner \"99999999999999999999\"; so far there are 4 vertices"),
        bad_obj("IndexNoNumber", square + "f 1 2 x\n", ":5: face corner \"x\"; expected a vertex number"),
        bad_obj("IndexFraction", square + "f 1 2 3.5\n", ":5: face corner \"3.5\"; expected a vertex number"),
        bad_obj("CornerForm", square + "f 1 2 3/a\n",
                ":5: face corner \"3/a\"; expected v, v/vt, v//vn or v/vt/vn"),
        bad_obj("TwoCorners", square + "f 1 2\n", ":5: face with 2 corners; expected at least 3"),
        bad_obj("OneCorner", square + "f 1\n", ":5: face with 1 corner; expected at least 3"),
        bad_obj("ZeroByte", "v 0 0 0\nv " + std::string(1, '\0') + "\n",
                ":2: a zero byte; expected a text file"),
        bad_obj("LibraryWithoutName", "mtllib\n", ":1: mtllib without a file name"),
        BadInput{"Extension", "a.blend", "BLENDER",
                 "a.blend: extension \".blend\"; expected .json .obj .ply .stl .off .gltf .glb"}),
    [](const auto& bad) { return bad.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Mtl, ReadBadInput,
    ::testing::Values(
        bad_mtl("KdAboveOne", "newmtl a\n\nKd 0.5 1.2 0.5\n",
                ":3: material \"a\": reflectance Kd 0.5 1.2 0.5; expected 0 to 1"),
        bad_mtl("KdNegative", "newmtl a\nKd -0.1 0 0\n",
                ":2: material \"a\": reflectance Kd -0.1 0 0; expected 0 to 1"),
        bad_mtl("KdNaN", "newmtl a\nKd nan 0 0\n",
                ":2: material \"a\": Kd \"nan 0 0\"; expected three finite numbers r g b"),
        bad_mtl("KdTwoNumbers", "newmtl a\nKd 0.1 0.2\n",
                ":2: material \"a\": Kd \"0.1 0.2\"; expected three finite numbers r g b"),
        bad_mtl("KdSpectral", "newmtl a\nKd spectral a.rfl 1\n",
                ":2: material \"a\": Kd \"spectral a.rfl 1\"; expected three finite numbers r g b"),
        bad_mtl("KeNegative", "newmtl a\nKe 1 -1 1\n",
                ":2: material \"a\": emission Ke 1 -1 1; expected 0 to 1e100"),
        bad_mtl("KeInfinite", "newmtl a\nKe inf 1 1\n",
                ":2: material \"a\": Ke \"inf 1 1\"; expected three finite numbers r g b"),
        bad_mtl("KeOverflow", "newmtl a\nKe 1e308 1 1\n",
                ":2: material \"a\": emission Ke 1e308 1 1; expected 0 to 1e100"),
        bad_mtl("NoMaterial", "Kd 1 1 1\n", ":1: \"Kd\" before the first newmtl"),
        bad_mtl("NoName", "newmtl a\nnewmtl\n", ":2: newmtl without a name"),
        bad_mtl("Empty", "", ": is empty")),
    [](const auto& bad) { return bad.param.name; });

INSTANTIATE_TEST_SUITE_P(
    SceneFile, ReadBadInput,
    ::testing::Values(
        bad_json("NotJson", "{\"mesh\": \"square.obj\",\n\n \"unit\" \"m\"}",
                 ":3: not JSON: syntax error while parsing object separator - unexpected string literal; "
                 "expected ':'"),
        bad_json("CutOff", "{\"mesh\": \"square.obj\"",
                 ":1: not JSON: syntax error while parsing object - unexpected end of input; expected '}'"),
        bad_json("NumberOverflow", "{\"mesh\": \"square.obj\",\n\"unit\": 1e999}",
                 ":2: not JSON: number overflow parsing '1e999'"),
        bad_json("NoObject", "[1]", ":1: found an array; expected an object {..}"),
        bad_json("NoMesh", "{}", ":1: no \"mesh\""),
        bad_json("MeshGone", "{\"mesh\": \"gone.obj\"}", ":1: mesh: \"gone.obj\" does not exist"),
        bad_json("MeshOfUnknownFormat", "{\"mesh\": \"a.blend\"}", ":1: mesh: \"a.blend\" does not exist"),
        bad_json("MeshEmptyList", "{\"mesh\": []}", ":1: mesh: is an empty list; expected at least one mesh"),
        bad_json("MeshEmptyName", "{\"mesh\": \"\"}", ":1: mesh: is empty; expected a file name"),
        bad_json("KeyTwice", "{\"mesh\": \"square.obj\",\n\"unit\": \"m\",\n\"unit\": \"cm\"}",
                 ":3: key \"unit\" stands here a second time; first on line 2"),
        bad_key("UnknownKey", R"("surface": {})", "unknown key \"surface\"; nearest: \"surfaces\""),
        bad_key("UnknownKeyInside", R"("surfaces": {"floor": {"reflectence": 1}})",
                "surfaces.floor: unknown key \"reflectence\"; nearest: \"reflectance\""),
        bad_key("UnknownMaterial", R"("materials": {"wite": {}})",
                "material \"wite\" is not in the mesh; nearest: \"white\""),
        bad_key("UnknownSurface", R"("surfaces": {"flor": {"exitance": 1}})",
                "surface \"flor\" is not in the mesh; nearest: \"floor\""),
        bad_key("ReflectanceAboveOne", R"("materials": {"white": {"reflectance": [0.5, 1.5, 0.5]}})",
                "materials.white.reflectance: found 1.5; expected 0 to 1"),
        bad_key("ReflectanceNegative", R"("materials": {"white": {"reflectance": -0.1}})",
                "materials.white.reflectance: found -0.1; expected 0 to 1"),
        bad_key("ReflectanceOfTwo", R"("materials": {"white": {"reflectance": [1, 1]}})",
                "materials.white.reflectance: found 2 values; expected three"),
        bad_key("ReflectanceText", R"("materials": {"white": {"reflectance": "white"}})",
                "materials.white.reflectance: found a string; expected a number or [r, g, b]"),
        bad_key("EmissionNegative", R"("surfaces": {"floor": {"exitance": -1}})",
                "surfaces.floor.exitance: found -1; expected 0 to 1e100"),
        bad_key("EmissionHuge", R"("surfaces": {"floor": {"radiance": 1e200}})",
                "surfaces.floor.radiance: found 1e+200; expected 0 to 1e100"),
        bad_key("EmissionTwice", R"("surfaces": {"floor": {"exitance": 1, "power": 1}})",
                "surfaces.floor.power: emission is stated twice; expected one of exitance, radiance, power"),
        bad_key("TwoSidedNumber", R"("surfaces": {"floor": {"two_sided": 1}})",
                "surfaces.floor.two_sided: found a number; expected true or false"),
        bad_key("Lights", R"("lights": [{"type": "point"}])",
                "lights: point, directional, spot and sky lights are not built yet; only surfaces emit "
                "(exitance, radiance, power)"),
        bad_key("UnknownUnit", R"("unit": "parsec")",
                "unit: unknown unit \"parsec\"; expected m dm cm mm um km in ft yd mi"),
        bad_key("NegativeUnit", R"("unit": -1)", "unit: expected more than 0 metres"),
        bad_key("CameraWithoutEye", R"("camera": {"target": [0, 0, 0]})", "camera: no \"eye\""),
        bad_key("CameraEyeIsTarget", R"("camera": {"eye": [0, 0, 0], "target": [0, 0, 0]})",
                "camera: eye and target are the same point"),
        bad_key("CameraUpAlongView", R"("camera": {"eye": [0, 3, 0], "target": [0, 0, 0]})",
                "camera: up is along the view, or zero; expected a direction across it"),
        bad_key("CameraFov", R"("camera": {"eye": [0, 0, 1], "target": [0, 0, 0], "fov": 180})",
                "camera.fov: expected more than 0 and less than 180 degrees"),
        bad_key("CameraWidth", R"("camera": {"eye": [0, 0, 1], "target": [0, 0, 0], "width": 0.5})",
                "camera.width: found 0.5; expected a whole number from 1 to 65536"),
        bad_json("TransformShape", R"({"mesh": [{"mesh": "square.obj", "transform": [1, 2, 3]}]})",
                 ":1: mesh[0].transform: expected four rows of four numbers, or 16 numbers row by row"),
        bad_json("TransformFlat",
                 R"({"mesh": [{"mesh": "square.obj", "transform": [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1]}]})",
                 ":1: mesh[0].transform: flattens space; expected an invertible matrix"),
        bad_json("TransformProjective",
                 R"({"mesh": [{"mesh": "square.obj", "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,1]}]})",
                 ":1: mesh[0].transform: last row is not 0 0 0 1"),
        bad_json("NestedTooDeep", "{\"mesh\": " + std::string(100, '['), ":1: nested deeper than 64 levels")),
    [](const auto& bad) { return bad.param.name; });

TEST(ReadBadFile, IsRefusedWhereThereIsNone) {
  EXPECT_EQ(SceneFiles().refusal_of("gone.obj"), "gone.obj: no such file");
  EXPECT_EQ(SceneFiles().refusal_of("gone.json"), "gone.json: no such file");
  EXPECT_EQ(SceneFiles().refusal_of("gone"), "gone: no such file");
}

TEST(ReadBadFile, IsRefusedWhereItIsAFolder) {
  SceneFiles files;
  std::filesystem::create_directory(files / "room.obj");
  std::filesystem::create_directory(files / "room");

  EXPECT_EQ(files.refusal_of("room.obj"), "room.obj: is a directory; expected a file");
  EXPECT_EQ(files.refusal_of("room"), "room: is a directory; expected a file");
}

// Root may read everything; while this lives, the test is nobody.
class WithoutPrivileges {
 public:
  WithoutPrivileges() {
    if (was_root_ && seteuid(65534) != 0) throw std::runtime_error("seteuid failed");
  }
  ~WithoutPrivileges() {
    if (was_root_ && seteuid(0) != 0) std::abort();
  }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;

 private:
  bool was_root_ = geteuid() == 0;
};

TEST(ReadBadFile, IsRefusedWhereItMayNotBeRead) {
  SceneFiles files;
  files.with("a.obj", square_face);
  std::filesystem::permissions(files / "a.obj", std::filesystem::perms::none);
  std::filesystem::permissions(files / "", std::filesystem::perms::others_exec,
                               std::filesystem::perm_options::add);

  const WithoutPrivileges nobody;

  EXPECT_EQ(files.refusal_of("a.obj"), "a.obj: cannot be read: Permission denied");
}

TEST(ReadBadFile, IsRefusedInOneLineWhateverItsWordsHold) {
  SceneFiles files;
  files.with("square.obj", square_face);
  files.with("a.json", R"({"mesh": "square.obj", "a\nb\u0007": 1})");

  EXPECT_EQ(files.refusal_of("a.json"), "a.json:1: unknown key \"a b \"; nearest: \"mesh\"");
}

}  // namespace
}  // namespace luxel
