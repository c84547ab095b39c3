#include "scene/gltf_reader.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <utility>

#include "scene/gltf_accessors.h"
#include "scene/gltf_file.h"
#include "scene/input_location.h"
#include "scene/name_table.h"
#include "scene/unused_statements.h"

namespace luxel {
namespace {

// What a file may insist on: of the extensions that change what Luxel reads, this one is understood.
constexpr std::string_view emissive_strength = "KHR_materials_emissive_strength";

// Nodes nested deeper are a cycle.
constexpr int deepest_node = 256;

class GltfReader {
 public:
  GltfReader(const std::filesystem::path& file, EmissionUnit unit)
      : file_(file), unit_(unit), model_(gltf_model(file)) {}

  SurfaceSoup read() {
    for (const std::string& extension : model_.extensionsRequired) {
      if (extension != emissive_strength)
        refuse({file_}, "needs the extension " + in_quotes(extension) + ", which is not read");
    }
    for (const tinygltf::Material& material : model_.materials) read_material(material);
    soup_.stated.push_back({std::string(default_name), {}, {}, {}});
    for (const int node : root_nodes()) read_node(node, Eigen::Affine3d::Identity(), 0);
    if (soup_.face_count() == 0) refuse({file_}, "has no triangles in its scene");
    if (!model_.lights.empty()) unused_.count("KHR_lights_punctual");
    unused_.warn(file_, soup_.warnings);
    soup_.groups = groups_.names();
    soup_.materials = materials_.names();
    return std::move(soup_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { refuse({file_}, message); }

  Rgb colour(const std::vector<double>& numbers, double otherwise) const {
    if (numbers.size() < 3) return Rgb::Constant(otherwise);
    return {numbers[0], numbers[1], numbers[2]};
  }

  void read_material(const tinygltf::Material& material) {
    StatedFinish stated;
    stated.name = material.name.empty() ? "material " + std::to_string(soup_.stated.size()) : material.name;
    const std::string item = "material " + in_quotes(stated.name) + ": ";
    stated.reflectance = colour(material.pbrMetallicRoughness.baseColorFactor, 1);
    if (!((*stated.reflectance >= 0).all() && (*stated.reflectance <= 1).all())) {
      fail(item + "base colour out of range; expected 0 to 1");
    }
    Rgb emission = colour(material.emissiveFactor, 0);
    const auto strength = material.extensions.find(std::string(emissive_strength));
    if (strength != material.extensions.end() && strength->second.Has("emissiveStrength")) {
      emission *= strength->second.Get("emissiveStrength").GetNumberAsDouble();
    }
    if (!((emission >= 0).all() && (emission <= largest_emission).all())) {
      fail(item + "emission out of range; expected 0 to 1e100");
    }
    stated.emission = unit_ == EmissionUnit::Radiance ? Rgb(std::numbers::pi * emission) : emission;
    stated.two_sided = material.doubleSided;
    if (material.pbrMetallicRoughness.baseColorTexture.index >= 0) unused_.count("baseColorTexture");
    if (material.emissiveTexture.index >= 0) unused_.count("emissiveTexture");
    if (material.pbrMetallicRoughness.metallicFactor > 0) unused_.count("metallicFactor");
    if (material.alphaMode != "OPAQUE" && !material.alphaMode.empty()) unused_.count("alphaMode");
    for (const auto& [name, value] : material.extensions) {
      if (name != emissive_strength) unused_.count(name);
    }
    soup_.stated.push_back(std::move(stated));
  }

  // The nodes of the default scene, else of the first one, else all that are no one's children.
  std::vector<int> root_nodes() const {
    if (!model_.scenes.empty()) {
      const int scene = std::max(model_.defaultScene, 0);
      if (static_cast<std::size_t>(scene) >= model_.scenes.size())
        fail("names a default scene that does not exist");
      return model_.scenes[scene].nodes;
    }
    std::vector<bool> is_child(model_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes) {
      for (const int child : node.children) {
        if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) is_child[child] = true;
      }
    }
    std::vector<int> roots;
    for (std::size_t n = 0; n < is_child.size(); ++n) {
      if (!is_child[n]) roots.push_back(static_cast<int>(n));
    }
    return roots;
  }

  Eigen::Affine3d transform_of(const tinygltf::Node& node) const {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (node.matrix.size() == 16) {
      transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
      return transform;
    }
    if (node.translation.size() == 3) transform.translate(Eigen::Map<const Vec3>(node.translation.data()));
    if (node.rotation.size() == 4) {
      const std::vector<double>& q = node.rotation;
      transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
    }
    if (node.scale.size() == 3) transform.scale(Eigen::Map<const Vec3>(node.scale.data()));
    return transform;
  }

  void read_node(int number, const Eigen::Affine3d& parent, int depth) {
    if (number < 0 || static_cast<std::size_t>(number) >= model_.nodes.size())
      fail("names a node that does not exist");
    if (depth > deepest_node)
      fail("nodes are nested deeper than " + std::to_string(deepest_node) + ", or in a circle");
    const tinygltf::Node& node = model_.nodes[number];
    const Eigen::Affine3d transform = parent * transform_of(node);
    if (!transform.matrix().allFinite()) fail("node " + std::to_string(number) + ": transform is not finite");
    if (node.skin >= 0) unused_.count("skin");
    if (node.mesh >= 0) {
      if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
        fail("names a mesh that does not exist");
      const tinygltf::Mesh& mesh = model_.meshes[node.mesh];
      const std::string& name = node.name.empty() ? mesh.name : node.name;
      const std::string group = name.empty() ? std::string(default_name) : name;
      for (const tinygltf::Primitive& primitive : mesh.primitives)
        read_primitive(primitive, transform, group);
    }
    for (const int child : node.children) read_node(child, transform, depth + 1);
  }

  void read_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform,
                      const std::string& group) {
    const bool is_strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    const bool is_fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1 && !is_strip && !is_fan) {
      unused_.count("points or lines");
      return;
    }
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
      fail("a primitive of " + in_quotes(group) + " without POSITION");
    if (!primitive.targets.empty()) unused_.count("morph targets");
    const std::vector<Vec3> points = gltf_positions(model_, position->second, file_);
    std::vector<int> indices;
    if (primitive.indices >= 0) {
      indices = gltf_indices(model_, primitive.indices, points.size(), file_);
    } else {
      for (std::size_t i = 0; i < points.size(); ++i) indices.push_back(static_cast<int>(i));
    }
    if (soup_.vertices.size() + points.size() > std::numeric_limits<int>::max() / 3)
      fail("more than 2^31 / 3 vertices");
    const auto first = static_cast<int>(soup_.vertices.size());
    for (const Vec3& point : points) soup_.vertices.push_back(transform * point);

    const auto last_material = static_cast<int>(soup_.stated.size()) - 1;
    if (primitive.material >= last_material) fail("names a material that does not exist");
    const int stated = primitive.material < 0 ? last_material : primitive.material;
    const bool is_mirrored = transform.linear().determinant() < 0;
    const std::size_t step = is_strip || is_fan ? 1 : 3;
    for (std::size_t i = 0; i + 2 < indices.size(); i += step) {
      std::array corners{indices[is_fan ? 0 : i], indices[i + 1], indices[i + 2]};
      if (is_mirrored != (is_strip && i % 2 == 1)) std::swap(corners[1], corners[2]);
      for (const int corner : corners) soup_.face_vertices.push_back(first + corner);
      soup_.face_offsets.push_back(static_cast<int>(soup_.face_vertices.size()));
      soup_.face_groups.push_back(groups_.number(group));
      soup_.face_materials.push_back(materials_.number(soup_.stated[stated].name));
      soup_.face_stated.push_back(stated);
    }
  }

  std::filesystem::path file_;
  EmissionUnit unit_;
  tinygltf::Model model_;
  SurfaceSoup soup_;
  NameTable groups_, materials_;
  UnusedStatements unused_;
};

}  // namespace

SurfaceSoup read_gltf(const std::filesystem::path& file, const ReadOptions& options) {
  return GltfReader(file, options.emission_unit).read();
}

}  // namespace luxel
