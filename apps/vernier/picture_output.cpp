// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/picture_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/atomic_file.h"

namespace vernier::apps {
namespace {

namespace fs = std::filesystem;

std::string format_or_default(const std::string& format) { return format.empty() ? "png" : format; }

void write_to_standard_output(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      throw Error(ErrorKind::output,
                  fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
    bytes = bytes.subspan(size_t(count));
  }
}

}  // namespace

std::string named_output(const std::string& output, const std::string& format) {
  return is_standard_stream(output) ? "-." + format_or_default(format) : output;
}

bool is_display_output(const std::string& output, const std::string& format) {
  return is_display_file(named_output(output, format));
}

void check_output(const std::string& output, bool folder_is_made) {
  if (!is_standard_stream(output)) {
    if (folder_is_made)
      check_image_name(output);
    else
      check_writable_image(output);
  } else if (::isatty(STDOUT_FILENO)) {
    throw Error(ErrorKind::usage,
                "-o - writes a picture to standard output, which is a terminal; redirect it");
  }
}

void make_folder_of(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorKind::output, file, {},
                fmt::format("folder '{}' cannot be made: {}", folder.string(), error.message()));
}

void write_output(const std::string& output, const LayeredImage& picture, const Metadata& metadata,
                  const RenderRequest& request) {
  if (!is_standard_stream(output)) {
    write_picture(output, picture, metadata, request.display, request.flags.exr);
    return;
  }
  const std::string format = format_or_default(request.flags.run.format);
  write_to_standard_output(encode_picture(format, picture, metadata, request.display, request.flags.exr));
}

bool is_finished_picture(const std::string& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  const auto texts = read_image_texts(file);
  if (!texts) return false;
  const auto stopped_by = texts->find("vernier:stoppedBy");
  return stopped_by == texts->end() ||
         (stopped_by->second != "interrupted" && stopped_by->second != unfinished);
}

}  // namespace vernier::apps
