// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace vernier::test {

/// Scene files that programs are run on.
inline const std::string cornell_box = VERNIER_SOURCE_DIR "/tests/scenes/cornell_box.gltf";
inline const std::string two_spheres = VERNIER_SOURCE_DIR "/tests/scenes/two_spheres.gltf";

struct ProcessResult {
  int exit_code = -1;  ///< as the process returned it; 128 + N when it died of signal N
  std::string out, err;

  /// Lines of `err`.
  std::vector<std::string> err_lines() const;
};

/// When to send which signal to a running program.
struct SendSignal {
  int signal = 0;              ///< 0: none
  std::string when_error_has;  ///< once this text has appeared on its standard error
  int times = 1;
};

/// Runs a program without a shell, its standard input empty and its output captured, and waits for it.
ProcessResult run_process(const std::vector<std::string>& arguments, const SendSignal& signal = {});

/// The `vernier` program of this build with these arguments.
ProcessResult run_vernier(std::vector<std::string> arguments, const SendSignal& signal = {});

}  // namespace vernier::test
