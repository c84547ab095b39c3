#include "scene/scene_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "scene/file_text.h"
#include "scene/input_location.h"
#include "scene/json_tree.h"
#include "scene/scene_values.h"
#include "scene/surface_soup.h"

namespace luxel {
namespace {

using Kind = JsonValue::Kind;

struct Unit {
  std::string_view name;
  double metres;
};

// The inch is 0.0254 m exactly, the foot 12 and the yard 36 of them: the international yard and pound
// agreement of 1959.
constexpr std::array units{Unit{"m", 1},       Unit{"dm", 0.1},     Unit{"cm", 0.01},   Unit{"mm", 0.001},
                           Unit{"um", 1e-6},   Unit{"km", 1000},    Unit{"in", 0.0254}, Unit{"ft", 0.3048},
                           Unit{"yd", 0.9144}, Unit{"mi", 1609.344}};

// A picture with more pixels on a side is a slip, not a wish.
constexpr int most_pixels = 65536;

// Sine of the angle below which the camera's up and view directions count as parallel.
constexpr double parallel = 1e-9;

double read_unit(const SceneValue& value) {
  if (value.json.kind == Kind::Number) {
    const double metres = value.number();
    if (!(metres > 0)) value.refuse("expected more than 0 metres");
    return metres;
  }
  if (value.json.kind != Kind::String) {
    value.refuse("found " + std::string(value.json.kind_name()) +
                 "; expected a name such as \"mm\", or metres");
  }
  std::vector<std::string> names;
  for (const Unit& unit : units) {
    if (unit.name == value.text()) return unit.metres;
    names.emplace_back(unit.name);
  }
  std::string known;
  for (const std::string& name : names) known += " " + name;
  value.refuse("unknown unit " + in_quotes(value.text()) + "; expected" + known);
}

Eigen::Affine3d read_transform(const SceneValue& value) {
  constexpr std::string_view expected = "four rows of four numbers, or 16 numbers row by row";
  const auto refuse_shape = [&] { value.refuse("expected " + std::string(expected)); };
  if (value.json.kind != Kind::Array) refuse_shape();
  std::vector<double> numbers;
  for (const JsonValue& row : value.json.elements) {
    if (row.kind == Kind::Number) {
      numbers.push_back(row.number);
    } else if (row.kind == Kind::Array && row.elements.size() == 4) {
      for (const JsonValue& entry : row.elements) {
        numbers.push_back(SceneValue{value.file, entry, value.item, value.name}.number());
      }
    } else {
      refuse_shape();
    }
  }
  if (numbers.size() != 16) refuse_shape();
  Eigen::Affine3d transform;
  transform.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  if (!transform.matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 0)) {
    value.refuse("last row is not 0 0 0 1");
  }
  const double determinant = transform.linear().determinant();
  if (determinant == 0 || !std::isfinite(determinant))
    value.refuse("flattens space; expected an invertible matrix");
  return transform;
}

MeshPlacement read_placement(const SceneValue& value) {
  const auto path_of = [&](const SceneValue& name) {
    if (name.text().empty()) name.refuse("is empty; expected a file name");
    const std::filesystem::path path = value.file.parent_path() / std::filesystem::path(name.text());
    std::error_code error;
    if (!std::filesystem::exists(path, error)) name.refuse(in_quotes(name.text()) + " does not exist");
    return path;
  };
  MeshPlacement placement;
  placement.line = value.json.line;
  if (value.json.kind == Kind::String) {
    placement.file = path_of(value);
    return placement;
  }
  value.allow_keys({"mesh", "transform"});
  placement.file = path_of(value.member("mesh"));
  if (value.json.member("transform")) placement.transform = read_transform(value.member("transform"));
  return placement;
}

std::vector<MeshPlacement> read_placements(const SceneValue& value) {
  if (value.json.kind == Kind::String) return {read_placement(value)};
  if (value.json.kind != Kind::Array) {
    value.refuse("found " + std::string(value.json.kind_name()) + "; expected a file name or a list");
  }
  if (value.json.elements.empty()) value.refuse("is an empty list; expected at least one mesh");
  std::vector<MeshPlacement> placements;
  for (std::size_t i = 0; i < value.json.elements.size(); ++i) {
    const std::string item = value.item + "[" + std::to_string(i) + "]";
    placements.push_back(read_placement({value.file, value.json.elements[i], item, item}));
  }
  return placements;
}

std::optional<EmissionRule> read_emission(const SceneValue& entry) {
  constexpr std::array kinds{std::pair{"exitance", EmissionRule::Kind::Exitance},
                             std::pair{"radiance", EmissionRule::Kind::Radiance},
                             std::pair{"power", EmissionRule::Kind::Power}};
  std::optional<EmissionRule> rule;
  for (const auto& [key, kind] : kinds) {
    if (!entry.json.member(key)) continue;
    const SceneValue value = entry.member(key);
    if (rule) value.refuse("emission is stated twice; expected one of exitance, radiance, power");
    rule = EmissionRule{kind, value.colour(0, largest_emission, "0 to 1e100")};
  }
  return rule;
}

std::vector<FinishRule> read_rules(const SceneValue& value) {
  std::vector<FinishRule> rules;
  for (const SceneValue& entry : value.members()) {
    entry.allow_keys({"reflectance", "exitance", "radiance", "power", "two_sided"});
    FinishRule rule;
    rule.name = entry.name;
    rule.line = entry.json.line;
    if (entry.json.member("reflectance")) {
      rule.reflectance = entry.member("reflectance").colour(0, 1, "0 to 1");
    }
    rule.emission = read_emission(entry);
    if (entry.json.member("two_sided")) rule.two_sided = entry.member("two_sided").boolean();
    rules.push_back(std::move(rule));
  }
  return rules;
}

Camera read_camera(const SceneValue& value) {
  value.allow_keys({"eye", "target", "up", "fov", "width", "height"});
  Camera camera;
  camera.eye = value.member("eye").vector();
  camera.target = value.member("target").vector();
  if (value.json.member("up")) camera.up = value.member("up").vector();
  if (value.json.member("fov")) camera.fov = value.member("fov").number();
  if (value.json.member("width")) camera.width = value.member("width").whole_number(1, most_pixels);
  if (value.json.member("height")) camera.height = value.member("height").whole_number(1, most_pixels);
  if (!(camera.fov > 0 && camera.fov < 180))
    value.member("fov").refuse("expected more than 0 and less than 180 degrees");
  const Vec3 view = camera.target - camera.eye;
  if (view.isZero(0)) value.refuse("eye and target are the same point");
  if (camera.up.normalized().cross(view.normalized()).norm() < parallel) {
    value.refuse("up is along the view, or zero; expected a direction across it");
  }
  return camera;
}

void refuse_lights(const SceneValue& value) {
  if (value.json.kind == Kind::Array && value.json.elements.empty()) return;
  value.refuse(
      "point, directional, spot and sky lights are not built yet; only surfaces emit (exitance, radiance, "
      "power)");
}

}  // namespace

SceneDescription read_scene_file(const std::filesystem::path& file) {
  const std::string text = file_text(file);
  const JsonValue json = json_tree(file, text);
  const SceneValue root{file, json, "", ""};
  root.allow_keys({"mesh", "unit", "materials", "surfaces", "lights", "camera"});

  SceneDescription description;
  description.file = file;
  description.meshes = read_placements(root.member("mesh"));
  if (json.member("unit")) description.unit = read_unit(root.member("unit"));
  if (json.member("materials")) description.materials = read_rules(root.member("materials"));
  if (json.member("surfaces")) description.surfaces = read_rules(root.member("surfaces"));
  if (json.member("lights")) refuse_lights(root.member("lights"));
  if (json.member("camera")) description.camera = read_camera(root.member("camera"));
  return description;
}

}  // namespace luxel
