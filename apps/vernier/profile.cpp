// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/profile.h"

#include <dlfcn.h>
#include <sys/time.h>
#include <ucontext.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <string_view>

#include "apps/vernier/own_symbols.h"

namespace vernier::apps {
namespace {

constexpr int samples_per_second = 100;
constexpr size_t most_samples = size_t{1} << 18;  // later ones are not kept

std::array<std::atomic<uintptr_t>, most_samples> sampled;
std::atomic<size_t> sample_count{0};

uintptr_t program_counter([[maybe_unused]] const void* context) {
#if defined(__x86_64__)
  return uintptr_t(static_cast<const ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP]);
#elif defined(__aarch64__)
  return uintptr_t(static_cast<const ucontext_t*>(context)->uc_mcontext.pc);
#else
  return 0;
#endif
}

void take_sample(int, siginfo_t*, void* context) {
  const size_t i = sample_count.fetch_add(1, std::memory_order_relaxed);
  if (i < most_samples) sampled[i].store(program_counter(context), std::memory_order_relaxed);
}

void set_timer(int microseconds) {
  itimerval timer{};
  timer.it_interval.tv_usec = timer.it_value.tv_usec = microseconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

enum Kind { ray_queries, textures, shading, libraries, kinds };
constexpr std::array<const char*, kinds> kind_names{"ray queries", "textures", "shading", "other libraries"};

/// Kind of work of a function of this program, by its mangled name.
Kind kind_of_function(std::string_view name) {
  const auto has = [&](std::string_view part) { return name.find(part) != std::string_view::npos; };
  for (const char* part : {"7Texture6sample", "Material4read", "Material11read_normal"})
    if (has(part)) return textures;
  for (const char* part : {"Accelerator", "TwoLevel", "WideTree", "TriangleTree", "TriangleOctree",
                           "TriangleList", "WatertightTest", "CoverageFilter"})
    if (has(part)) return ray_queries;
  return shading;
}

Kind kind_of(uintptr_t place, const OwnSymbols& symbols) {
  Dl_info object{};
  // A program counter is a number until it is looked up. NOLINTNEXTLINE(performance-no-int-to-ptr)
  if (dladdr(reinterpret_cast<const void*>(place), &object) == 0 || !object.dli_fname) return libraries;
  if (std::strstr(object.dli_fname, "libembree")) return ray_queries;
  const std::string_view own = symbols.name_at(place);
  return own.empty() ? libraries : kind_of_function(own);
}

}  // namespace

Profiler::Profiler() {
  struct sigaction action {};
  action.sa_sigaction = take_sample;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sample_count = 0;
  if (sigaction(SIGPROF, &action, nullptr) != 0) return;
  set_timer(1'000'000 / samples_per_second);
  running_ = true;
}

void Profiler::stop() {
  if (!running_) return;
  running_ = false;
  set_timer(0);
  // One that is still on its way must not end the process.
  std::signal(SIGPROF, SIG_IGN);
  const size_t count = std::min(sample_count.load(), most_samples);
  for (size_t i = 0; i < count; ++i)
    if (const uintptr_t place = sampled[i].load()) places_.push_back(place);
}

std::vector<ProfilePart> Profiler::parts() const {
  const OwnSymbols symbols;
  if (places_.empty() || symbols.empty()) return {};
  std::array<size_t, kinds> counts{};
  for (const uintptr_t place : places_) ++counts[kind_of(place, symbols)];
  std::vector<ProfilePart> parts;
  for (size_t k = 0; k < kinds; ++k)
    parts.push_back({kind_names[k], double(counts[k]) / double(places_.size())});
  return parts;
}

}  // namespace vernier::apps
