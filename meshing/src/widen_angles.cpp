#include "widen_angles.h"

namespace luxel {

AddedPoints widen_angles([[maybe_unused]] const PlanarDomain& domain,
                         [[maybe_unused]] const std::vector<char>& fixed, [[maybe_unused]] double smallest,
                         [[maybe_unused]] std::size_t most) {
#ifdef LUXEL_WITH_CGAL
  return widen_delaunay_angles(domain, fixed, smallest, most);
#else
  return {};
#endif
}

}  // namespace luxel
