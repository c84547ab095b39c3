#include "command_options.h"

#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "luxel/input_error.h"
#include "luxel/read_scene.h"
#include "values.h"

namespace luxel::app {

namespace {

constexpr const char* sizing = "Patches";
constexpr const char* transport = "Form factors";
constexpr const char* solving = "Solving";
constexpr const char* output = "Output";
constexpr const char* resources = "Resources";

constexpr std::size_t description_width = 82;  // with the names before it 112 in all

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
          wrapped(description, description_width))
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

}  // namespace

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
                 wrapped(fmt::format("A mesh or a scene file: {}", fmt::join(scene_extensions(), " ")),
                         description_width))
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
  value_option(app, "--operator", "KIND", "auto, dense, gather or hierarchical",
               "How light is exchanged: dense, every pair of patches; gather, rays from each patch; "
               "hierarchical, pairs of "
               "clusters (the last two in solve only); auto, what the scene, the accuracy and the memory "
               "call for; default: auto",
               [&chosen](const std::string& text) {
                 const auto kind = operator_from_name(text);
                 if (kind) chosen.kind = *kind;
                 return kind.has_value();
               })
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

void add_methods(CLI::App& app, std::vector<Method>& methods) {
  app.add_option_function<std::vector<std::string>>(
         "--solver",
         [&methods](const std::vector<std::string>& names) {
           for (const std::string& each : names) {
             const auto method = method_from_name(each);
             if (!method || *method == Method::automatic) {
               refuse("--solver", each, "the name of a solver: cholesky, lu, cg, gmres, neumann, ...");
             }
             methods.push_back(*method);
           }
         },
         wrapped(
             "Run these solvers only, with commas between: cholesky, lu, cg, gmres, neumann, gauss-seidel, "
             "symmetric-gauss-seidel, southwell; default: all",
             description_width))
      ->delimiter(',')
      ->type_name("METHOD,...")
      ->group(solving);
}

void add_comparison(CLI::App& app, CompareCommand& compare) {
  add_methods(app, compare.methods);
  number_option(app, "--tolerance", "T", 0, false, 1, "a number above 0 and up to 1",
                "Stop each solver at this relative residual; default: 1e-10",
                [&compare](double x) { compare.tolerance = x; })
      ->group(solving);
  app.add_option(
         "--reference", compare.reference,
         wrapped("A .csv of patches to measure errors against, as solve writes it; default: the best direct "
                 "solve with refinement",
                 description_width))
      ->type_name("FILE")
      ->group(solving);
  app.add_flag(
         "--operators", compare.operators,
         wrapped(
             "Also compare on operators by rays and by clusters, on a coarser and a finer one (accuracy x 10 "
             "and / 10), and with half and twice the patches",
             description_width))
      ->group(transport);
  app.add_flag("--wall", compare.wall_time, "Plot errors against wall time instead of CPU time")
      ->group(output);
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

void add_error_bar(CLI::App& app, bool& error_bar) {
  value_option(
      app, "--error-bar", "HOW", "on or off",
      "Estimate the error of the operator by rays from some patches, for at most a fifth of the run: on "
      "or off; default: on",
      [&error_bar](const std::string& text) {
        error_bar = text == "on";
        return text == "on" || text == "off";
      })
      ->group(transport);
}

void add_keep_partial(CLI::App& app, bool& keep_partial) {
  app.add_flag(
         "--keep-partial", keep_partial,
         wrapped(
             "After Ctrl-C, once there is light at all, write what is solved so far, as FILE.partial.EXT; "
             "else nothing is written",
             description_width))
      ->group(output);
}

void add_outputs(CLI::App& app, std::vector<std::string>& outputs, const char* description) {
  app.add_option("-o,--output", outputs, wrapped(description, description_width))
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
                 factors.by_group = factors.transport.form_factors.group_accuracy = text == "group";
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

}  // namespace luxel::app
