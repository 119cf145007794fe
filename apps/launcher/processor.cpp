// SPDX-License-Identifier: Apache-2.0
#include "apps/launcher/processor.h"

#include <algorithm>

namespace vernier::launcher {
namespace {

bool always() { return true; }

#ifdef __x86_64__
// Features of a level that no compiler can ask for here (LZCNT, MOVBE, XSAVE) came with those that it can.

bool has_v2() {
  return __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.2") &&
         __builtin_cpu_supports("popcnt");
}

bool has_v3() {
  return has_v2() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}

bool has_v4() {
  return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}
#endif

constexpr Level known[] = {
#ifdef __x86_64__
    {"x86-64-v4", has_v4}, {"x86-64-v3", has_v3}, {"x86-64-v2", has_v2}, {"x86-64", always},
#endif
    {"native", always},
};

}  // namespace

std::span<const Level> levels() { return known; }

bool is_supported(std::string_view name) {
  const auto level =
      std::find_if(std::begin(known), std::end(known), [&](const Level& l) { return l.name == name; });
  return level == std::end(known) || level->supported();
}

const char* best_level() {
  return std::find_if(std::begin(known), std::end(known), [](const Level& l) { return l.supported(); })->name;
}

}  // namespace vernier::launcher
