#include "scene/import/asset_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;

/// Closes a file descriptor at the end of its scope.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

/// Returns what is wrong, or an empty string. Non-blocking so that a FIFO nobody writes to cannot hang the
/// open.
std::string read_regular_file(const std::string& path, int flags, Bytes& bytes) {
  const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | flags));
  struct stat status {};
  if (file.get() < 0 || fstat(file.get(), &status) != 0) return std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return "not a regular file";
  if (status.st_size == 0) return "the file is empty";
  bytes = Bytes(size_t(status.st_size));
  for (size_t done = 0; done < bytes.size;) {
    const ssize_t got = read(file.get(), bytes.data.get() + done, bytes.size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::strerror(errno);
    if (got == 0) return "the file shrank while it was read";
    done += size_t(got);
  }
  return {};
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// RFC 3986, 2.1; a percent sign without two digits stands for itself.
std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
      decoded += char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

std::array<int, 256> base64_table() {
  std::array<int, 256> table;
  table.fill(-1);
  const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < digits.size(); ++i) table[uint8_t(digits[i])] = int(i);
  return table;
}

/// RFC 4648, section 4. Returns false on a character outside the alphabet or an impossible length.
bool decode_base64(std::string_view text, Bytes& bytes) {
  static const std::array<int, 256> table = base64_table();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  bytes = Bytes(text.size() * 3 / 4);
  uint32_t bits = 0;
  int held = 0;
  size_t written = 0;
  for (const char c : text) {
    const int digit = table[uint8_t(c)];
    if (digit < 0) return false;
    bits = bits << 6 | uint32_t(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.data[written++] = uint8_t(bits >> held);
  }
  return true;
}

/// "data:" [media type] [";base64"] "," data (RFC 2397).
Bytes decode_data_uri(std::string_view uri, const std::string& file, const std::string& place) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) throw Error(ErrorKind::input, file, place, "data URI without a comma");
  const std::string_view data = uri.substr(comma + 1);
  Bytes bytes;
  if (uri.substr(0, comma).ends_with(";base64")) {
    if (!decode_base64(data, bytes))
      throw Error(ErrorKind::input, file, place, "data URI is not valid base64");
  } else {
    const std::string decoded = percent_decoded(data);
    bytes = Bytes(decoded.size());
    std::copy(decoded.begin(), decoded.end(), bytes.data.get());
  }
  if (bytes.size == 0) throw Error(ErrorKind::input, file, place, "data URI holds no data");
  return bytes;
}

bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.find_first_of("/?#") > colon;
}

bool has_parent_component(const fs::path& path) {
  for (const auto& component : path)
    if (component == "..") return true;
  return false;
}

}  // namespace

AssetFiles::AssetFiles(std::string scene_path) : scene_path_(std::move(scene_path)) {
  std::error_code error;
  const fs::path parent = fs::path(scene_path_).parent_path();
  folder_ = fs::canonical(parent.empty() ? fs::path(".") : parent, error).string();
  if (error) throw Error(ErrorKind::input, scene_path_, "", "cannot be read: " + error.message());
}

Bytes AssetFiles::read_scene() const {
  Bytes bytes;
  const std::string problem = read_regular_file(scene_path_, 0, bytes);
  if (!problem.empty()) throw Error(ErrorKind::input, scene_path_, "", "cannot be read: " + problem);
  return bytes;
}

Bytes AssetFiles::read_uri(const std::string& uri, const std::string& place) const {
  return uri.starts_with("data:") ? decode_data_uri(uri, scene_path_, place) : read_relative(uri, place);
}

Bytes AssetFiles::read_relative(const std::string& uri, const std::string& place) const {
  const auto fail = [&](const std::string& problem) {
    throw Error(ErrorKind::input, scene_path_, place, fmt::format("'{}' {}", uri.substr(0, 200), problem));
  };
  const std::string name = percent_decoded(uri);
  const fs::path relative(name);
  if (has_scheme(uri)) fail("is not a path relative to the scene file; only those and data URIs are read");
  if (name.empty() || name.find('\0') != std::string::npos) fail("is not a file name");
  if (relative.is_absolute() || has_parent_component(relative))
    fail("leaves the scene file's folder; put the file beside the scene and refer to it by a relative path");
  std::error_code error;
  const std::string path = fs::canonical(fs::path(folder_) / relative, error).string();
  if (error) fail("cannot be read: " + error.message());
  const std::string inside = folder_.ends_with('/') ? folder_ : folder_ + "/";
  if (!path.starts_with(inside)) fail("is a link that leaves the scene file's folder");
  Bytes bytes;
  const std::string problem = read_regular_file(path, O_NOFOLLOW, bytes);
  if (!problem.empty()) fail("cannot be read: " + problem);
  return bytes;
}

}  // namespace vernier
