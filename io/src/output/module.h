#pragma once

#include <filesystem>
#include <string>

namespace luxel {

/// A symbol of one of the modules that io loads on first use (docs/decisions/0005): looked for beside the
/// program or library that holds this code, in the library folder of its installation, and where the dynamic
/// loader looks. A module stays loaded.
/// @param module  for example "luxel_vtk"
/// @param file    the file that is to be written, for the message
/// @throws InputError if the module is not there, cannot be loaded, or is of another version
void* module_symbol(const std::string& module, const char* symbol, const std::filesystem::path& file);

}  // namespace luxel
