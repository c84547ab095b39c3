#include "assembly.h"
#include "luxel/mesh_scene.h"
#include "memory_plan.h"
#include "progress_bar.h"
#include "reporting.h"
#include "run_command.h"
#include "usage.h"

namespace luxel::app {

ExitStatus run(const InspectCommand& command) {
  const Stopwatch watch;
  Report report = new_report("inspect");
  ProgressBar bar(!command.general.quiet);
  const Progress progress = std::ref(bar);
  const PatchMesh mesh = read_and_mesh(command.scene, command.general, progress, report);
  const Enclosures enclosures = find_enclosures(mesh, RayScene(mesh.occluders), 256, progress);
  report.scene.closed = enclosures.closed;
  report.scene.enclosures = enclosures.count;
  add_run_figures(report, watch);
  show(report, command.general, {});
  return done;
}

}  // namespace luxel::app
