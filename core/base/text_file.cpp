#include "core/base/text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "core/base/error.h"

namespace vernier {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw Error(ErrorKind::output, path, {}, "cannot be written: " + reason);
}

std::string beside(const std::string& path) { return fmt::format("{}.{}.partial", path, getpid()); }

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

void write_and_rename(const std::string& path, std::span<const std::span<const std::byte>> parts,
                      bool to_disk) {
  const std::string temporary = beside(path);
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
  if (!file) refuse(path, std::strerror(errno));
  bool written = true;
  for (const auto& part : parts)  // of which empty ones need not be anywhere, and fwrite wants a place
    written =
        written && (part.empty() || std::fwrite(part.data(), 1, part.size(), file.get()) == part.size());
  if (to_disk) written = written && std::fflush(file.get()) == 0 && ::fdatasync(::fileno(file.get())) == 0;
  int reason = errno;
  const bool closed = std::fclose(file.release()) == 0;
  if (written) reason = errno;
  if (!written || !closed || std::rename(temporary.c_str(), path.c_str()) != 0) {
    if (written && closed) reason = errno;
    std::remove(temporary.c_str());
    refuse(path, std::strerror(reason));
  }
}

}  // namespace

void write_text_file(const std::string& path, std::string_view text) {
  const std::array parts{std::as_bytes(std::span(text))};
  write_and_rename(path, parts, false);
}

void write_file_safely(const std::string& path, std::span<const std::span<const std::byte>> parts) {
  write_and_rename(path, parts, true);
}

void check_writable_text_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse(path, "it is a folder");
  const std::string temporary = beside(path);
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
  if (!file) refuse(path, std::strerror(errno));
  std::remove(temporary.c_str());
}

}  // namespace vernier
