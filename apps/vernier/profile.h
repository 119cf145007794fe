// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vernier::apps {

/// Part of the processor time that went to one kind of work.
struct ProfilePart {
  std::string name;
  double share = 0;  ///< of all parts' sum, 1
};

/// Samples where this process is, a hundred times a second of processor time, from construction until stop().
/// The program itself keeps no books, so a run that is not sampled pays nothing. One at a time.
class Profiler {
 public:
  Profiler();
  ~Profiler() { stop(); }
  Profiler(const Profiler&) = delete;
  Profiler& operator=(const Profiler&) = delete;

  void stop();

  /// Ray queries, textures, shading (the rest of rendering), other libraries (mathematics, memory, threads,
  /// system). Empty when nothing was sampled or the program has no symbols to tell its functions apart.
  std::vector<ProfilePart> parts() const;

  size_t samples() const { return places_.size(); }

 private:
  bool running_ = false;
  std::vector<uintptr_t> places_;  ///< program counters
};

}  // namespace vernier::apps
