#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace vernier::test {

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

/// A fresh folder that is removed with all in it at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file in it and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;
  /// Names of what is in it, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::string& path);

}  // namespace vernier::test
