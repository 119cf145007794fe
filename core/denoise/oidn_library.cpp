// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/oidn_library.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

namespace vernier {
namespace {

namespace fs = std::filesystem;

constexpr const char* file_name = "libOpenImageDenoise.so.2";
constexpr const char* advice =
    "install Open Image Denoise 2 (the Python package pyoidn has it) and name its file or folder in "
    "VERNIER_OIDN";

/// What the search has come to; of the two strings one is empty.
struct Search {
  std::optional<OidnLibrary> library;
  std::string why_not;
};

/// Where pip puts the library below an environment's folder, newest Python first.
std::vector<fs::path> in_environment(const fs::path& environment) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& python : fs::directory_iterator(environment / "lib", ignored))
    if (python.path().filename().string().starts_with("python3"))
      for (const char* packages : {"site-packages", "dist-packages"})
        if (fs::path file = python.path() / packages / "pyoidn/oidn/lib" / file_name;
            fs::exists(file, ignored))
          found.push_back(std::move(file));
  std::sort(found.rbegin(), found.rend());
  return found;
}

std::vector<fs::path> in_python_packages() {
  std::vector<fs::path> environments;
  for (const char* variable : {"VIRTUAL_ENV", "CONDA_PREFIX"})
    if (const char* folder = std::getenv(variable)) environments.emplace_back(folder);
  if (const char* home = std::getenv("HOME")) environments.emplace_back(fs::path(home) / ".local");
  environments.insert(environments.end(), {"/usr/local", "/usr"});
  std::vector<fs::path> found;
  for (const fs::path& environment : environments)
    for (fs::path& file : in_environment(environment)) found.push_back(std::move(file));
  return found;
}

/// The library stays loaded: its threads may outlive what used it.
Search load(const std::string& path) {
  void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return {{}, dlerror()};
  Search result;
  OidnLibrary library;
  library.path = path;
  const auto get = [&](auto& function, const char* name) {
    void* const symbol = dlsym(handle, name);
    if (!symbol) result.why_not = path + " has no function " + name;
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(symbol);
  };
  get(library.new_device, "oidnNewDevice");
  get(library.release_device, "oidnReleaseDevice");
  get(library.set_device_bool, "oidnSetDeviceBool");
  get(library.set_device_int, "oidnSetDeviceInt");
  get(library.commit_device, "oidnCommitDevice");
  get(library.get_device_error, "oidnGetDeviceError");
  get(library.new_filter, "oidnNewFilter");
  get(library.release_filter, "oidnReleaseFilter");
  get(library.set_shared_filter_image, "oidnSetSharedFilterImage");
  get(library.set_filter_bool, "oidnSetFilterBool");
  get(library.commit_filter, "oidnCommitFilter");
  get(library.execute_filter, "oidnExecuteFilter");
  if (result.why_not.empty()) result.library = std::move(library);
  return result;
}

Search search() {
  if (const char* named = std::getenv("VERNIER_OIDN")) {
    if (!*named) return {{}, "VERNIER_OIDN is empty, so no Open Image Denoise is looked for"};
    const fs::path path(named);
    Search result = load((fs::is_directory(path) ? path / file_name : path).string());
    if (!result.library) result.why_not = "VERNIER_OIDN: " + result.why_not;
    return result;
  }
  if (Search result = load(file_name); result.library) return result;
  for (const fs::path& file : in_python_packages())
    if (Search result = load(file.string()); result.library) return result;
  return {{}, std::string("there is no ") + file_name + ": " + advice};
}

const Search& searched() {
  static const Search result = search();
  return result;
}

}  // namespace

const OidnLibrary* OidnLibrary::find() { return searched().library ? &*searched().library : nullptr; }

bool OidnLibrary::is_named() {
  const char* named = std::getenv("VERNIER_OIDN");
  return named && *named;
}

const std::string& OidnLibrary::why_not_found() { return searched().why_not; }

}  // namespace vernier
