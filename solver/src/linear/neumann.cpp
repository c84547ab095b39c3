#include "linear/methods.h"

namespace luxel {

PatchField neumann(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch) {
  watch.expect_decrease();
  PatchField residual = system.residual(radiosity);
  if (!watch.start(residual, radiosity)) return radiosity;
  do {
    radiosity += residual;  // E + K B = B + r
    residual.resize(0, 0);  // of a million patches no two at a time
    residual = system.residual(radiosity);
  } while (watch.next(residual, radiosity));
  return radiosity;
}

PatchField neumann_bounces(const RadiositySystem& system, int bounces, IterationWatch& watch) {
  PatchField radiosity = system.emission();
  PatchField residual = system.residual(radiosity);
  watch.start(residual, radiosity);
  while (watch.report().iterations < bounces && watch.report().stopped != Stopped::caller) {
    radiosity += residual;
    residual.resize(0, 0);
    residual = system.residual(radiosity);
    watch.next(residual, radiosity);
  }
  if (watch.report().stopped != Stopped::caller) watch.stop(Stopped::bounces, {});
  return radiosity;
}

}  // namespace luxel
