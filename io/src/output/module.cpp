#include "module.h"

#include <dlfcn.h>
#include <link.h>

#include <system_error>
#include <vector>

#include "luxel/input_error.h"

namespace luxel {

namespace fs = std::filesystem;

namespace {

// The folder of the program or shared library that this code was linked into
fs::path own_folder() {
  Dl_info info{};
  void* entry = nullptr;
  const auto* here = reinterpret_cast<const void*>(&module_symbol);
  std::error_code error;
  if (dladdr1(here, &info, &entry, RTLD_DL_LINKMAP) != 0 && entry) {
    const char* library = static_cast<const link_map*>(entry)->l_name;
    if (library && *library) return fs::canonical(library, error).parent_path();
  }
  // the program itself has no name in the loader's list
  return fs::canonical("/proc/self/exe", error).parent_path();
}

std::vector<fs::path> module_folders() {
  const fs::path own = own_folder();
  return {
      own,                                     // the build tree, a portable folder
      own / LUXEL_MODULE_FOLDER_FROM_PROGRAM,  // installed: code in a program
      own / "luxel",                           // installed: code in a shared library
#ifdef LUXEL_MODULE_BUILD_FOLDER
      LUXEL_MODULE_BUILD_FOLDER,  // part of another project's build
#endif
  };
}

}  // namespace

void* module_symbol(const std::string& module, const char* symbol, const fs::path& file) {
  const std::string name = module + ".so";
  std::string places;
  void* handle = nullptr;
  const auto load = [&](const std::string& path) {
    handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  };
  const auto fail = [&](const std::string& reason) {
    throw InputError(file.string() + ": cannot be written: " + reason);
  };
  for (const fs::path& folder : module_folders()) {
    const fs::path candidate = (folder / name).lexically_normal();
    std::error_code error;
    if (fs::exists(candidate, error)) {
      load(candidate.string());
      if (!handle) fail("the module " + name + " does not load: " + dlerror());
      break;
    }
    places += candidate.parent_path().string() + ", ";
  }
  if (!handle) load(name);
  if (!handle) fail("the module " + name + " was found neither in " + places + "nor by the dynamic loader");
  void* address = dlsym(handle, symbol);
  if (!address) fail("the module " + name + " is of another version of Luxel");
  return address;
}

}  // namespace luxel
