#include "display_colours.h"

#include <tbb/parallel_for.h>

#include <numbers>

namespace luxel {

std::vector<double> luminances(const PatchField& radiosity) {
  std::vector<double> result(radiosity.rows());
  for (Eigen::Index i = 0; i < radiosity.rows(); ++i) {
    result[i] = luminance(radiosity.row(i).transpose().array()) / std::numbers::pi;
  }
  return result;
}

ToneMap tone_map_for(const PatchMesh& mesh, const std::vector<double>& luminances) {
  return tone_map_for(std::span(luminances), mesh.areas);
}

std::vector<std::uint8_t> display_colours(const PatchField& radiosity, const ToneMap& tone_map) {
  std::vector<std::uint8_t> bytes(3 * radiosity.rows());
  tbb::parallel_for(Eigen::Index(0), radiosity.rows(), [&](Eigen::Index i) {
    const auto colour = tone_map(radiosity.row(i).transpose().array() / std::numbers::pi);
    std::copy(colour.begin(), colour.end(), bytes.begin() + 3 * i);
  });
  return bytes;
}

}  // namespace luxel
