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

/// Through a symbolic link the file it points to is replaced, not the link.
std::string behind_links(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const auto target = std::filesystem::weakly_canonical(path, error);
  return error ? path : target.string();
}

/// A device or a pipe, such as /dev/stdout: written into, never replaced.
bool is_special(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_other(path, error);
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

void write_and_rename(const std::string& name, std::span<const std::span<const std::byte>> parts,
                      bool to_disk) {
  const bool special = is_special(name);
  const std::string path = special ? name : behind_links(name);
  const std::string temporary = special ? path : beside(path);
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
  if (!file) refuse(path, std::strerror(errno));
  bool written = true;
  for (const auto& part : parts)  // of which empty ones need not be anywhere, and fwrite wants a place
    written =
        written && (part.empty() || std::fwrite(part.data(), 1, part.size(), file.get()) == part.size());
  if (to_disk && !special)
    written = written && std::fflush(file.get()) == 0 && ::fdatasync(::fileno(file.get())) == 0;
  int reason = errno;
  const bool closed = std::fclose(file.release()) == 0;
  if (written) reason = errno;
  if (!written || !closed || (!special && std::rename(temporary.c_str(), path.c_str()) != 0)) {
    if (written && closed) reason = errno;
    if (!special) std::remove(temporary.c_str());
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
  if (is_special(path)) {
    if (::access(path.c_str(), W_OK) != 0) refuse(path, std::strerror(errno));
    return;
  }
  const std::string temporary = beside(behind_links(path));
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
  if (!file) refuse(path, std::strerror(errno));
  std::remove(temporary.c_str());
}

}  // namespace vernier
