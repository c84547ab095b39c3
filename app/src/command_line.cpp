#include "command_line.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "command_options.h"
#include "help_text.h"
#include "luxel/input_error.h"
#include "operator_use.h"
#include "suggestion.h"
#include "version.h"

namespace luxel::app {

namespace {

constexpr std::size_t name_width = 30;  // columns of the help's names

// Names of an app's options as typed, for suggestions.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(fmt::format("--{}", name));
  }
  return names;
}

void refuse_extras(const CLI::App& app, const std::string& scene) {
  for (const std::string& extra : app.remaining()) {
    if (extra.size() > 1 && extra[0] == '-') {
      const std::string typed = extra.substr(0, extra.find('='));
      throw InputError(fmt::format("{}: unknown option '{}'{}", app.get_name(), typed,
                                   suggestion(typed, option_names(app))));
    }
    throw InputError(fmt::format("{}: unexpected '{}' after the scene '{}'", app.get_name(), extra, scene));
  }
}

void check_scene(const CLI::App& app, const SceneOptions& scene) {
  refuse_extras(app, scene.file);
  if (scene.file.empty())
    throw InputError(app.get_name() + ": no scene given, expected a mesh or scene file");
  if (scene.meshing.as_is + (scene.meshing.patch_size > 0) + (scene.meshing.patches > 0) > 1) {
    throw InputError(app.get_name() +
                     ": found more than one of --as-is, --patch-size and --patches, expected one");
  }
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

// What is typed after `luxel`, where it is no command.
[[noreturn]] void refuse_command(const CLI::App& app, const std::string& typed) {
  static const std::vector<std::string> later = {"render"};
  const std::vector<std::string> names = command_names(app);
  if (std::find(later.begin(), later.end(), typed) != later.end()) {
    throw InputError(fmt::format("the command '{}' is not part of this version", typed));
  }
  if (!typed.empty() && typed[0] == '-') {
    throw InputError(fmt::format("unknown option '{}' before the command (see luxel --help)", typed));
  }
  throw InputError(fmt::format("unknown command '{}'{} (expected {})", typed, suggestion(typed, names),
                               fmt::join(names, ", ")));
}

void check_operator(const CLI::App& app, const OperatorOptions& options) {
  if (!options.load.empty() && (options.raw || !options.save.empty())) {
    throw InputError(fmt::format("{}: found --load with {}, expected one of them", app.get_name(),
                                 options.raw ? "--raw" : "--save"));
  }
}

// Commands that need every entry.
void check_dense(const CLI::App& app, const OperatorOptions& options) {
  if (options.kind == OperatorKind::automatic || options.kind == OperatorKind::dense) return;
  throw InputError(fmt::format("{}: found --operator {}, expected dense: it needs every form factor",
                               app.get_name(), name(options.kind)));
}

// What operators without entries have no use for.
void check_use(const SolveCommand& command) {
  const std::string reason = operator_cannot(command.transport.kind, command);
  if (reason.empty()) return;
  throw InputError(fmt::format("solve: found --operator {} with {}", name(command.transport.kind), reason));
}

void check_bounces(const SolveOptions& options) {
  if (!options.bounces || options.method == Method::automatic || options.method == Method::neumann) return;
  throw InputError(
      fmt::format("solve: found --bounces with --solver {}, expected neumann", name(options.method)));
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  CLI::App app("Diffuse light in closed and open scenes by the radiosity method, with error bounds.",
               "luxel");
  app.set_help_flag("--help,-h", "Print this help and stop");
  app.set_version_flag("--version", version_text(), "Print version and licence and stop");
  app.allow_extras();
  app.require_subcommand(0, 1);
  app.get_formatter()->column_width(name_width);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.footer(main_footer);

  SolveCommand solve;
  CLI::App* solve_app = app.add_subcommand("solve", "Light every patch: the main job");
  solve_app->allow_extras()->group("Commands");
  add_scene(*solve_app, solve.scene);
  add_outputs(*solve_app, solve.outputs,
              "Write this file, by its extension .vtp .vtu .pvd .csv .json .ply .png .exr or .hdr; may be "
              "given again");
  add_full_precision(*solve_app, solve.full_precision);
  add_keep_partial(*solve_app, solve.keep_partial);
  add_operator(*solve_app, solve.transport);
  add_error_bar(*solve_app, solve.error_bar);
  add_solver(*solve_app, solve.solve);
  add_plan(*solve_app, solve.savings);
  add_general(*solve_app, solve.general);
  solve_app->footer(solve_footer);

  FactorsCommand factors;
  CLI::App* factors_app =
      app.add_subcommand("factors", "Form factors: of all patches to files, or between groups");
  factors_app->allow_extras()->group("Commands");
  add_scene(*factors_app, factors.scene);
  add_factor_tables(*factors_app, factors);
  add_outputs(*factors_app, factors.outputs,
              "Write this file, by its extension .mtx .csv or .h5 (every F_ij) or .json (the report); may be "
              "given again");
  add_operator(*factors_app, factors.transport);
  add_general(*factors_app, factors.general);
  factors_app->footer(factors_footer);

  InspectCommand inspect;
  CLI::App* inspect_app =
      app.add_subcommand("inspect", "Tell what is in a scene, what is wrong with it and what it needs");
  inspect_app->allow_extras()->group("Commands");
  add_scene(*inspect_app, inspect.scene);
  add_general(*inspect_app, inspect.general);
  inspect_app->footer(inspect_footer);

  CompareCommand compare;
  CLI::App* compare_app = app.add_subcommand("compare", "Every solver on one system: error against run time");
  compare_app->allow_extras()->group("Commands");
  add_scene(*compare_app, compare.scene);
  add_comparison(*compare_app, compare);
  add_outputs(*compare_app, compare.outputs,
              "Write this file, by its extension .csv .json .html .png or .svg; may be given again");
  add_operator(*compare_app, compare.transport);
  add_general(*compare_app, compare.general);
  compare_app->footer(compare_footer);

  StressCommand stress;
  CLI::App* stress_app = app.add_subcommand("stress", "Stiff and extreme cases: each solver's verdict");
  stress_app->allow_extras()->group("Commands");
  stress_app->add_option("NAME", stress.cases, "Run these cases only");
  add_methods(*stress_app, stress.methods);
  add_outputs(*stress_app, stress.outputs,
              "Write this file, by its extension .csv or .json; may be given again");
  add_general(*stress_app, stress.general);
  stress_app->footer(stress_footer);

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    return ShowText{chosen.empty() ? app.help() : chosen.front()->help("luxel")};
  } catch (const CLI::CallForVersion&) {
    return ShowText{version_text()};
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  }

  if (!app.remaining().empty()) refuse_command(app, app.remaining().front());
  if (*solve_app) {
    check_scene(*solve_app, solve.scene);
    check_operator(*solve_app, solve.transport);
    check_bounces(solve.solve);
    check_use(solve);
    return solve;
  }
  if (*factors_app) {
    check_scene(*factors_app, factors.scene);
    check_operator(*factors_app, factors.transport);
    check_dense(*factors_app, factors.transport);
    return factors;
  }
  if (*inspect_app) {
    check_scene(*inspect_app, inspect.scene);
    return inspect;
  }
  if (*compare_app) {
    check_scene(*compare_app, compare.scene);
    check_operator(*compare_app, compare.transport);
    check_dense(*compare_app, compare.transport);
    return compare;
  }
  if (*stress_app) {
    refuse_extras(*stress_app, stress.cases.empty() ? "" : stress.cases.back());
    return stress;
  }
  throw InputError(
      fmt::format("no command given (expected {}; see luxel --help)", fmt::join(command_names(app), ", ")));
}

}  // namespace luxel::app
