// SPDX-License-Identifier: Apache-2.0
#include "scene/import/asset_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "scene/import/data_uri.h"
#include "vernier/error.h"

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

/// All that standard input holds; returns what is wrong, or an empty string.
std::string read_standard_input(Bytes& bytes) {
  std::vector<uint8_t> all;
  constexpr size_t block = size_t(1) << 20;
  for (ssize_t got = 1; got != 0;) {
    const size_t done = all.size();
    all.resize(done + block);
    do got = read(STDIN_FILENO, all.data() + done, block);
    while (got < 0 && errno == EINTR);
    if (got < 0) return std::strerror(errno);
    all.resize(done + size_t(got));
  }
  if (all.empty()) return "there is nothing on it";
  bytes = Bytes(all.size());
  std::copy(all.begin(), all.end(), bytes.data.get());
  return {};
}

bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.find_first_of("/?#") > colon;
}

/// Whether the file that a reference names lies outside of the folder it is relative to, told from the name
/// alone: nobody is to learn from a message which files there are.
bool leaves_folder(const fs::path& reference) {
  return reference.is_absolute() || *reference.begin() == "..";
}

std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

constexpr const char* how_to_allow =
    "put the file beside the scene, or pass --allow-outside-files if you trust the scene";

}  // namespace

AssetFiles::AssetFiles(std::string scene_path, bool allow_outside)
    : scene_path_(std::move(scene_path)), allow_outside_(allow_outside) {
  std::error_code error;
  const fs::path parent = fs::path(scene_path_).parent_path();
  folder_ = fs::canonical(parent.empty() ? fs::path(".") : parent, error).string();
  if (error) throw Error(ErrorKind::input, scene_path_, "", "cannot be read: " + error.message());
}

Bytes AssetFiles::read_scene() const {
  Bytes bytes(in_memory_ ? in_memory_->size() : 0);
  if (in_memory_) {
    std::copy(in_memory_->begin(), in_memory_->end(), bytes.data.get());
    return bytes;
  }
  const std::string problem =
      scene_path_ == standard_input ? read_standard_input(bytes) : read_regular_file(scene_path_, 0, bytes);
  if (!problem.empty()) throw Error(ErrorKind::input, scene_path_, "", "cannot be read: " + problem);
  return bytes;
}

AssetContent AssetFiles::read_uri(const std::string& uri, const std::string& place) const {
  if (!is_data_uri(uri)) return read_reference(uri, place);
  AssetContent content;
  content.problem = decode_data_uri(uri, content.bytes);
  return content;
}

AssetContent AssetFiles::read_reference(const std::string& uri, const std::string& place) const {
  const std::string quoted = fmt::format("'{}'", uri.substr(0, 200));
  const auto refuse = [&](const std::string& problem) {
    throw Error(ErrorKind::input, scene_path_, place, fmt::format("{} {}", quoted, problem));
  };
  if (in_memory_)
    refuse(
        "is another file, and a scene in memory lies in no folder; read the scene from its file, or put all "
        "into one .glb");
  if (has_scheme(uri)) refuse("is not a path relative to the scene file; only those and data URIs are read");
  const std::string name = percent_decoded(uri);
  if (name.empty() || name.find('\0') != std::string::npos) refuse("is not a file name");
  const auto checked = [&](const std::string& file) {
    // Dots go by the rules of URIs (RFC 3986, 5.2.4): "sub/../file" needs no folder "sub".
    fs::path reference = fs::path(file).lexically_normal();
    if (leaves_folder(reference) && !allow_outside_)
      refuse(fmt::format("leaves the scene file's folder; {}", how_to_allow));
    return reference;
  };
  std::error_code error;
  AssetContent content;
  fs::path reference = checked(name);
  if (name.find('\\') != std::string::npos && !fs::exists(fs::path(folder_) / reference, error)) {
    reference = checked(with_slashes(name));
    content.remark = fmt::format("{} is written with backslashes; read as '{}'", quoted, reference.string());
  }
  const std::string path = fs::canonical(fs::path(folder_) / reference, error).string();
  if (error == std::errc::no_such_file_or_directory)
    content.problem = fmt::format("{} is missing: {}", quoted, error.message());
  else if (error)
    content.problem = fmt::format("{} cannot be read: {}", quoted, error.message());
  if (error) return content;
  const std::string inside = folder_.ends_with('/') ? folder_ : folder_ + "/";
  if (!(path + "/").starts_with(inside) && !allow_outside_)
    refuse(fmt::format("is a link that leaves the scene file's folder; {}", how_to_allow));
  const std::string problem = read_regular_file(path, O_NOFOLLOW, content.bytes);
  if (!problem.empty()) content.problem = fmt::format("{} cannot be read: {}", quoted, problem);
  return content;
}

}  // namespace vernier
