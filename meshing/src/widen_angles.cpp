#include "widen_angles.h"

namespace luxel {

AddedPoints widen_angles([[maybe_unused]] const PlanarDomain& domain,
                         [[maybe_unused]] const std::vector<double>& least, [[maybe_unused]] double smallest,
                         [[maybe_unused]] std::size_t most) {
#ifdef LUXEL_WITH_CGAL
  return widen_delaunay_angles(domain, least, smallest, most);
#else
  return {};
#endif
}

}  // namespace luxel
