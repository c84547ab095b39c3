#include "command_line.h"

#include <algorithm>
#include <functional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "help_text.h"
#include "luxel/input_error.h"
#include "luxel/read_scene.h"
#include "suggestion.h"
#include "values.h"
#include "version.h"

namespace luxel::app {

namespace {

constexpr const char* sizing = "Patches";
constexpr const char* transport = "Form factors";
constexpr const char* solving = "Solving";
constexpr const char* output = "Output";
constexpr const char* resources = "Resources";

// The formatter breaks descriptions only where they have a line break.
std::string wrapped(const std::string& text) {
  constexpr std::size_t width = 82;  // beside the 30 columns of the names: 112 in all
  std::string result;
  std::size_t column = 0;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool breaks = column > 0 && column + 1 + word.size() > width;
    if (column > 0) result += breaks ? '\n' : ' ';
    column = breaks ? word.size() : column + (column > 0) + word.size();
    result += word;
  }
  return result;
}

[[noreturn]] void refuse(const std::string& option, const std::string& found, const std::string& expected) {
  throw InputError(fmt::format("{}: found '{}', expected {}", option, found, expected));
}

// One option with a value; `accept` gives false where the text is not what is expected.
CLI::Option* value_option(CLI::App& app, const std::string& names, const char* type,
                          const std::string& expected, const std::string& description,
                          std::function<bool(const std::string&)> accept) {
  const std::string shown = names.substr(names.find("--"));
  return app
      .add_option_function<std::string>(
          names,
          [=](const std::string& text) {
            if (!accept(text)) refuse(shown, text, expected);
          },
          wrapped(description))
      ->type_name(type);
}

// A number in (low, high], or [low, high] where low is allowed itself.
CLI::Option* number_option(CLI::App& app, const std::string& name, const char* type, double low,
                           bool low_allowed, double high, const std::string& expected,
                           const std::string& description, std::function<void(double)> store) {
  return value_option(app, name, type, expected, description, [=](const std::string& text) {
    const auto value = parse_number(text);
    if (!value || *value > high || *value < low || (*value == low && !low_allowed)) return false;
    store(*value);
    return true;
  });
}

CLI::Option* count_option(CLI::App& app, const std::string& name, const char* type, std::uint64_t low,
                          std::uint64_t high, const std::string& expected, const std::string& description,
                          std::function<void(std::uint64_t)> store) {
  return value_option(app, name, type, expected, description, [=](const std::string& text) {
    const auto value = parse_count(text);
    if (!value || *value < low || *value > high) return false;
    store(*value);
    return true;
  });
}

void add_general(CLI::App& app, GeneralOptions& general) {
  app.add_flag("--json", general.json, "Print one JSON document on stdout instead of the summary")
      ->group(output);
  app.add_flag("--quiet", general.quiet, "No summary, no progress, no warnings")->group(output);
  count_option(
      app, "--threads", "N", 1, 4096, "a whole number from 1 to 4096",
      "Threads to use; default: as many as the machine has. The result has the same bits for any number",
      [&general](std::uint64_t n) { general.threads = static_cast<int>(n); })
      ->group(resources);
  value_option(app, "--memory", "BYTES", "a size above 0, with K, M or G (powers of 1024) if you like: 500M",
               "Memory that may be taken, for example 500M or 2G; default: what the machine has",
               [&general](const std::string& text) {
                 const auto bytes = parse_bytes(text);
                 if (bytes) general.memory = *bytes;
                 return bytes.has_value();
               })
      ->group(resources);
}

void add_scene(CLI::App& app, SceneOptions& scene) {
  app.add_option("SCENE", scene.file,
                 wrapped(fmt::format("A mesh or a scene file: {}", fmt::join(scene_extensions(), " "))))
      ->type_name("");
  app.add_flag("--as-is", scene.meshing.as_is, "One patch per input face")->group(sizing);
  number_option(app, "--patch-size", "LENGTH", 0, false, 1e300, "a length above 0 [m]",
                "Longest edge of a patch, about [m]", [&scene](double x) { scene.meshing.patch_size = x; })
      ->group(sizing);
  count_option(app, "--patches", "N", 1, 1'000'000'000, "a whole number of at least 1",
               "Number of patches, about; default: 5000, or one per face where the input has more",
               [&scene](std::uint64_t n) { scene.meshing.patches = static_cast<int>(n); })
      ->group(sizing);
  value_option(
      app, "--emission-unit", "UNIT", "radiance or exitance",
      "What a mesh file's emission (Ke) is: radiance [W/m2/sr] or exitance [W/m2]; default: radiance",
      [&scene](const std::string& text) {
        scene.emission_is_exitance = text == "exitance";
        return text == "exitance" || text == "radiance";
      });
}

void add_operator(CLI::App& app, OperatorOptions& chosen) {
  FormFactorOptions& options = chosen.form_factors;
  number_option(app, "--accuracy", "A", 1e-8, true, 0.1, "a number from 1e-8 to 0.1",
                "Relative error of the irradiance that the form factors may cause; default: 1e-3",
                [&chosen](double x) {
                  chosen.form_factors.accuracy = x;
                  chosen.accuracy_given = true;
                })
      ->group(transport);
  value_option(
      app, "--visibility", "HOW", "auto, rays or exact",
      "How partly hidden pairs are measured: by rays, by exact clipping, or auto: the cheaper that is "
      "accurate enough; default: auto",
      [&options](const std::string& text) {
        if (text == "auto") options.visibility = Visibility::automatic;
        if (text == "rays") options.visibility = Visibility::rays;
        if (text == "exact") options.visibility = Visibility::exact;
        return text == "auto" || text == "rays" || text == "exact";
      })
      ->group(transport);
  value_option(app, "--operator", "KIND", "auto or dense (no other operator is built)",
               "How the form factors are kept: auto or dense; default: auto",
               [](const std::string& text) { return text == "auto" || text == "dense"; })
      ->group(transport);
  count_option(app, "--seed", "N", 0, UINT64_MAX, "a whole number", "Seed of the random streams; default: 1",
               [&options](std::uint64_t n) { options.seed = n; })
      ->group(transport);
  app.add_option("--save", chosen.save, "Keep the form factors in this file")
      ->type_name("FILE")
      ->group(transport);
  app.add_option("--load", chosen.load, "Use the form factors of this file, kept for the same patches")
      ->type_name("FILE")
      ->group(transport);
}

void add_solver(CLI::App& app, SolveOptions& options) {
  static const std::vector<std::string> methods = {"auto",    "cholesky",     "lu",        "cg",    "gmres",
                                                   "neumann", "gauss-seidel", "southwell", "jacobi"};
  value_option(app, "--solver", "METHOD",
               "auto, cholesky, lu, cg, gmres, neumann (= jacobi), gauss-seidel or southwell",
               "auto, cholesky, lu, cg, gmres, neumann (= jacobi), gauss-seidel or southwell; default: auto",
               [&options](const std::string& text) {
                 if (text == "auto") return options.method = Method::automatic, true;
                 const auto method = method_from_name(text);
                 if (method) options.method = *method;
                 return method.has_value();
               })
      ->group(solving);
  number_option(app, "--tolerance", "T", 0, false, 1, "a number above 0 and up to 1",
                "Stop at this relative residual; default: 1e-6",
                [&options](double x) { options.tolerance = x; })
      ->group(solving);
  number_option(app, "--error", "T", 0, false, 1, "a number above 0 and up to 1",
                "Stop at this error bound instead: largest error of B relative to the largest B",
                [&options](double x) { options.error = x; })
      ->group(solving);
  count_option(app, "--max-iterations", "N", 1, 2'000'000'000, "a whole number of at least 1",
               "Stop after so many iterations; default: 10000",
               [&options](std::uint64_t n) { options.max_iterations = static_cast<int>(n); })
      ->group(solving);
  count_option(app, "--bounces", "K", 0, 2'000'000'000, "a whole number of at least 0",
               "Follow the light for K bounces only (solver neumann); 0 leaves the emission",
               [&options](std::uint64_t n) { options.bounces = static_cast<int>(n); })
      ->group(solving);
}

void add_plan(CLI::App& app, Savings& savings) {
  value_option(app, "--plan", "HOW", "auto or full",
               "auto leaves out what the scene does not need; full computes everything, for the same result; "
               "default: auto",
               [&savings](const std::string& text) {
                 savings = text == "full" ? Savings::none() : Savings();
                 return text == "auto" || text == "full";
               })
      ->group(solving);
}

void add_outputs(CLI::App& app, std::vector<std::string>& outputs, const char* description) {
  app.add_option("-o,--output", outputs, wrapped(description))
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(output);
}

void add_full_precision(CLI::App& app, bool& full_precision) {
  app.add_flag("--full-precision", full_precision, "17 digits in text files instead of 9")->group(output);
}

void add_factor_tables(CLI::App& app, FactorsCommand& factors) {
  value_option(app, "--by", "WHAT", "group", "Form factors between what: group",
               [&factors](const std::string& text) {
                 factors.by_group = text == "group";
                 return factors.by_group;
               })
      ->group(output);
  value_option(app, "--point", "X,Y,Z,NX,NY,NZ", "six numbers with commas between, the last three not all 0",
               "Form factors from a point [m] with this normal to every group",
               [&factors](const std::string& text) {
                 factors.point = parse_point(text);
                 return factors.point.has_value();
               })
      ->group(output);
  app.add_flag("--raw", factors.transport.raw, "Form factors as computed, rows not scaled to close")
      ->group(output);
  add_full_precision(app, factors.full_precision);
}

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
  static const std::vector<std::string> later = {"compare", "stress", "render"};
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
  app.get_formatter()->column_width(30);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.footer(main_footer);

  SolveCommand solve;
  CLI::App* solve_app = app.add_subcommand("solve", "Light every patch: the main job");
  solve_app->allow_extras()->group("Commands");
  add_scene(*solve_app, solve.scene);
  add_outputs(*solve_app, solve.outputs,
              "Write this file, by its extension .vtp .vtu .pvd .csv .json .ply .png .exr or .hdr; may be "
              "given again");
  solve_app->add_flag("--full-precision", solve.full_precision, "17 digits in .csv instead of 9")
      ->group(output);
  add_operator(*solve_app, solve.transport);
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
    return solve;
  }
  if (*factors_app) {
    check_scene(*factors_app, factors.scene);
    check_operator(*factors_app, factors.transport);
    return factors;
  }
  if (*inspect_app) {
    check_scene(*inspect_app, inspect.scene);
    return inspect;
  }
  throw InputError(
      fmt::format("no command given (expected {}; see luxel --help)", fmt::join(command_names(app), ", ")));
}

}  // namespace luxel::app
