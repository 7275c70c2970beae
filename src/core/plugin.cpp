#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <tautline/core/error.hpp>
#include <tautline/core/plugin.hpp>

namespace tautline {

namespace {

namespace fs = std::filesystem;

/// Where the plugin lies: in the build tree of the program or of its tests, or where it was installed.
std::string find_plugin(const std::string& file, const std::string& remedy) {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* folder : {"plugins", "../plugins", "../lib/tautline"}) {
    const fs::path candidate = (here / folder / file).lexically_normal();
    if (fs::exists(candidate, error)) return candidate.string();
  }
  throw LibraryError(
      fmt::format("the plugin {} is not beside {} (in plugins/, ../plugins/ or ../lib/tautline/)\n  {}", file,
                  here.string(), remedy));
}

std::string loader_message() {
  const char* message = dlerror();
  return message != nullptr ? message : "no reason given";
}

}  // namespace

void* load_plugin_symbol(const std::string& file, const std::string& symbol, const std::string& remedy) {
  const std::string path = find_plugin(file, remedy);
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw LibraryError(
        fmt::format("the plugin {} cannot be loaded: {}\n  {}", file, loader_message(), remedy));
  void* address = dlsym(library, symbol.c_str());
  if (address == nullptr)
    throw LibraryError(
        fmt::format("the plugin {} lacks {}: build it together with the program", path, symbol));
  return address;
}

}  // namespace tautline
