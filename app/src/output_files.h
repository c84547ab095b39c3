#pragma once

#include <span>
#include <string>

namespace luxel::app {

/// Looks at the output files before anything is computed: each extension is one of `extensions` (".csv",
/// ...), each folder exists and can be written to, no name stands twice, and none is the input itself.
/// @throws InputError naming the first file that cannot be written, and why
void check_outputs(std::span<const std::string> files, std::span<const std::string> extensions,
                   const std::string& input);

/// The same for one file of any name.
void check_output(const std::string& file, const std::string& input);

/// The extension of a file in lower case, with the dot; empty where there is none.
std::string extension_of(const std::string& file);

}  // namespace luxel::app
