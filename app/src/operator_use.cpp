#include "operator_use.h"

#include <fmt/format.h>

#include "output_files.h"

namespace luxel::app {

std::string operator_cannot(OperatorKind kind, const SolveCommand& command) {
  if (kind != OperatorKind::gather && kind != OperatorKind::hierarchical) return {};
  const OperatorOptions& transport = command.transport;
  const auto only_dense = [](const std::string& option) { return option + ", which only dense can do"; };
  if (!transport.save.empty()) return only_dense("--save");
  if (!transport.load.empty()) return only_dense("--load");
  if (transport.form_factors.visibility == Visibility::exact) return only_dense("--visibility exact");
  if (command.solve.bounces) return only_dense("--bounces");
  const double accuracy = transport.form_factors.accuracy;
  if (accuracy < finest_sampled) {
    return fmt::format("--accuracy {}, expected {} or more; dense can do it", accuracy, finest_sampled);
  }
  for (const std::string& file : command.outputs) {
    if (extension_of(file) == ".pvd") return only_dense("-o " + file);
  }
  const Method method = command.solve.method;
  if (method == Method::automatic || method == Method::neumann || method == Method::gmres) return {};
  if (kind == OperatorKind::hierarchical && method == Method::cg) return {};
  return "--solver " + std::string(name(method)) + ", expected " +
         (kind == OperatorKind::gather ? "" : "cg, ") + "neumann, gmres or auto";
}

}  // namespace luxel::app
