#include "version.h"

namespace luxel::app {

std::string version_text() {
#if LUXEL_WITH_CGAL
  return "luxel " LUXEL_VERSION
         "\nSources: Apache-2.0. This build contains CGAL's mesh packages, so the program may be given away\n"
         "under GPL-3.0-or-later only; configure with -D LUXEL_WITH_CGAL=OFF for a build without them.\n";
#else
  return "luxel " LUXEL_VERSION "\nLicence: Apache-2.0. This build contains no part of CGAL.\n";
#endif
}

}  // namespace luxel::app
