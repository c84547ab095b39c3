#pragma once

#include <string>
#include <vector>

#include "commands.h"

namespace CLI {
class App;
}

namespace luxel::app {

// The options of the commands, in groups as their help shows them. Each option checks its value as it is
// read.
// @throws InputError, while the command line is parsed, for a value that is not what the option expects

void add_general(CLI::App& app, GeneralOptions& general);
void add_scene(CLI::App& app, SceneOptions& scene);
void add_operator(CLI::App& app, OperatorOptions& chosen);
void add_solver(CLI::App& app, SolveOptions& options);
void add_error_bar(CLI::App& app, bool& error_bar);
void add_keep_partial(CLI::App& app, bool& keep_partial);
void add_plan(CLI::App& app, Savings& savings);
void add_methods(CLI::App& app, std::vector<Method>& methods);
void add_comparison(CLI::App& app, CompareCommand& compare);
void add_outputs(CLI::App& app, std::vector<std::string>& outputs, const char* description);
void add_full_precision(CLI::App& app, bool& full_precision);
void add_factor_tables(CLI::App& app, FactorsCommand& factors);

}  // namespace luxel::app
