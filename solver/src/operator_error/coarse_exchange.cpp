#include "operator_error/coarse_exchange.h"

#include "transport/gather/packets.h"

namespace luxel {

namespace {

// Hits looked at: a thousand for each of 64 x 64 pairs of parts.
constexpr std::size_t enough_hits = 1 << 22;

/// @param exchange  A_I F_IJ
void set_exchange(Eigen::MatrixXd exchange, CoarseExchange& coarse) {
  const double all = exchange.norm();
  coarse.reciprocity_error = all > 0 ? (exchange - exchange.transpose()).norm() / all : 0;
  coarse.form_factors = std::move(exchange);
  for (int i = 0; i < static_cast<int>(coarse.areas.size()); ++i) {
    if (coarse.areas[i] > 0) coarse.form_factors.row(i) /= coarse.areas[i];
  }
}

}  // namespace

CoarseExchange coarse_exchange(const GatherOperator& transport, const std::vector<std::int32_t>& part,
                               int parts) {
  constexpr int lanes = GatherOperator::lanes;
  CoarseExchange coarse;
  coarse.areas.assign(parts, 0.0);
  Eigen::MatrixXd exchange = Eigen::MatrixXd::Zero(parts, parts);
  const auto packets = transport.packets();
  const std::size_t hits = packets.size() * lanes * transport.rays();
  const std::size_t step = 1 + hits / enough_hits;
  for (std::size_t p = 0; p < packets.size(); p += step) {
    const auto met = transport.hits(p);
    for (int k = 0; k < used_lanes(packets[p]); ++k) {
      const int patch = packets[p][k];
      const double area = transport.areas()[patch];
      coarse.areas[part[patch]] += area;
      for (std::size_t q = k; q < met.size(); q += lanes) {
        if (met[q] < part.size()) exchange(part[patch], part[met[q]]) += area / transport.rays();
      }
    }
  }
  set_exchange(std::move(exchange), coarse);
  return coarse;
}

CoarseExchange coarse_exchange(const std::vector<StratumDefects>& defects,
                               const std::vector<std::int32_t>& part, int parts) {
  CoarseExchange coarse;
  coarse.areas.assign(parts, 0.0);
  Eigen::MatrixXd exchange = Eigen::MatrixXd::Zero(parts, parts);
  for (const StratumDefects& of_stratum : defects) {
    for (const Defect& defect : of_stratum) {
      const std::int32_t own = part[defect.patch];
      coarse.areas[own] += defect.weight;
      for (int p = 0; p < parts; ++p) exchange(own, p) += defect.weight * defect.met[p] / defect.looked;
    }
  }
  set_exchange(std::move(exchange), coarse);
  return coarse;
}

}  // namespace luxel
