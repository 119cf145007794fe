// SPDX-License-Identifier: Apache-2.0
#include "apps/machine.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sys/resource.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace vernier::apps {
namespace {

double seconds(const timeval& time) { return double(time.tv_sec) + double(time.tv_usec) * 1e-6; }

rusage usage_of_self() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage;
}

}  // namespace

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
    if (begin != std::string::npos) return line.substr(begin);
  }
  return "unknown";
}

uint64_t peak_memory_bytes() { return static_cast<uint64_t>(usage_of_self().ru_maxrss) * 1024; }

double cpu_seconds() {
  const rusage usage = usage_of_self();
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string platform() {
  std::string features;
#ifdef __x86_64__
  // __builtin_cpu_supports() wants literals. The features are those that glibc has variants for.
  const auto add = [&](bool has, const char* name) {
    if (has) features += fmt::format("{}{}", features.empty() ? "" : " ", name);
  };
  add(__builtin_cpu_supports("avx2"), "avx2");
  add(__builtin_cpu_supports("avx512f"), "avx512f");
  add(__builtin_cpu_supports("fma"), "fma");
  add(__builtin_cpu_supports("fma4"), "fma4");
  add(__builtin_cpu_supports("sse4.1"), "sse4.1");
#endif
  return fmt::format("{}, glibc {}, {}", features.empty() ? "baseline" : features, gnu_get_libc_version(),
                     VERNIER_COMPILER);
}

nlohmann::ordered_json build_versions() {
  nlohmann::ordered_json versions;
  // "name version,name version,...", put together by third_party/dependencies.cmake
  std::istringstream libraries(VERNIER_LIBRARIES);
  for (std::string library; std::getline(libraries, library, ',');) {
    const size_t space = library.find(' ');
    versions[library.substr(0, space)] = library.substr(space + 1);
  }
  versions["compiler"] = VERNIER_COMPILER;
  return versions;
}

}  // namespace vernier::apps
