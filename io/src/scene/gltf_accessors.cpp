#include "scene/gltf_accessors.h"

#include <cmath>
#include <string_view>

#include "scene/binary_numbers.h"
#include "scene/input_location.h"

namespace luxel {
namespace {

// The elements of an accessor, checked to lie within their buffer; glTF is little-endian.
struct Elements {
  std::string_view bytes;  ///< from the first element on
  std::size_t count;
  std::size_t stride;
};

Elements elements_of(const tinygltf::Model& model, int number, std::size_t size,
                     const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) {
    refuse({file}, "accessor " + std::to_string(number) + ": " + what);
  };
  if (number < 0 || static_cast<std::size_t>(number) >= model.accessors.size()) fail("does not exist");
  const tinygltf::Accessor& accessor = model.accessors[number];
  if (accessor.sparse.isSparse) fail("is sparse, which is not read");
  if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= model.bufferViews.size()) {
    fail("names no buffer view");
  }
  const tinygltf::BufferView& view = model.bufferViews[accessor.bufferView];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
    fail("names no buffer");
  const std::vector<unsigned char>& data = model.buffers[view.buffer].data;
  const std::size_t stride = view.byteStride == 0 ? size : view.byteStride;
  const std::size_t begin = view.byteOffset + accessor.byteOffset;
  if (begin > data.size() || stride < size || accessor.count > data.size() ||
      (accessor.count > 0 && (accessor.count - 1) * stride + size > data.size() - begin)) {
    fail("reaches beyond its buffer");
  }
  const auto* bytes = reinterpret_cast<const char*>(data.data());
  return {{bytes + begin, data.size() - begin}, accessor.count, stride};
}

}  // namespace

std::vector<Vec3> gltf_positions(const tinygltf::Model& model, int accessor,
                                 const std::filesystem::path& file) {
  const Elements elements = elements_of(model, accessor, 3 * sizeof(float), file);
  const tinygltf::Accessor& form = model.accessors[accessor];
  if (form.type != TINYGLTF_TYPE_VEC3 || form.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    refuse({file}, "accessor " + std::to_string(accessor) + ": positions that are not three floats each");
  }
  std::vector<Vec3> positions(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = i * elements.stride + k * sizeof(float);
      positions[i][static_cast<int>(k)] = number_at<float>(elements.bytes, at, std::endian::little);
    }
    if (!positions[i].allFinite())
      refuse({file}, "accessor " + std::to_string(accessor) + ": a position is not finite");
  }
  return positions;
}

std::vector<int> gltf_indices(const tinygltf::Model& model, int accessor, std::size_t limit,
                              const std::filesystem::path& file) {
  const bool exists = accessor >= 0 && static_cast<std::size_t>(accessor) < model.accessors.size();
  const int type = exists ? model.accessors[accessor].componentType : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  const std::size_t size = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 1
                           : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 2
                           : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT   ? 4
                                                                            : 0;
  if (size == 0)
    refuse({file}, "accessor " + std::to_string(accessor) + ": indices that are no whole numbers");
  const Elements elements = elements_of(model, accessor, size, file);
  std::vector<int> indices(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) {
    const std::size_t at = i * elements.stride;
    const std::uint32_t index = size == 1 ? number_at<std::uint8_t>(elements.bytes, at, std::endian::little)
                                : size == 2
                                    ? number_at<std::uint16_t>(elements.bytes, at, std::endian::little)
                                    : number_at<std::uint32_t>(elements.bytes, at, std::endian::little);
    if (index >= limit) {
      refuse({file}, "accessor " + std::to_string(accessor) + ": index " + std::to_string(index) +
                         "; expected less than " + std::to_string(limit));
    }
    indices[i] = static_cast<int>(index);
  }
  return indices;
}

}  // namespace luxel
