// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/checkpoint_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/fingerprint.h"
#include "vernier/error.h"

namespace vernier {

CheckpointReader::CheckpointReader(const std::string& path) : path_(path) {
  std::error_code error;
  // Opening a pipe would wait for its writer.
  if (std::filesystem::is_other(path, error)) refuse("is not a regular file");
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (file_) left_ = std::filesystem::file_size(path, error);
  if (!file_ || error)
    throw Error(ErrorKind::input, path, {},
                fmt::format("cannot be read: {}", error ? error.message() : std::strerror(errno)));
}

void CheckpointReader::read(std::span<std::byte> bytes) {
  if (bytes.empty()) return;  // an empty array need not be anywhere, and fread wants a place
  if (bytes.size() > left_ || std::fread(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    damaged("it is cut short");
  left_ -= bytes.size();
}

void CheckpointReader::damaged(const std::string& how) const {
  // What the file holds is quoted in `how` and may be long.
  throw Error(ErrorKind::input, path_, {},
              fmt::format("is damaged: {:.200}; use another checkpoint or render without --resume", how));
}

void CheckpointReader::refuse(const std::string& reason) const {
  throw Error(ErrorKind::input, path_, {}, reason);
}

nlohmann::ordered_json read_checkpoint_header(CheckpointReader& reader) {
  constexpr uint32_t longest_header = 1 << 20;
  CheckpointPreamble preamble;
  if (reader.left() < sizeof(preamble)) reader.refuse("is not a checkpoint of 'vernier render'");
  reader.read(std::as_writable_bytes(std::span(&preamble, 1)));
  if (preamble.magic != CheckpointPreamble().magic) reader.refuse("is not a checkpoint of 'vernier render'");
  if (preamble.format != CheckpointPreamble::current_format)
    reader.refuse(fmt::format("is a checkpoint of format {}; this version reads format {}", preamble.format,
                              CheckpointPreamble::current_format));
  if (preamble.header_length > longest_header) reader.damaged("its header is too long");
  std::string text(preamble.header_length, ' ');
  reader.read(std::as_writable_bytes(std::span(text)));
  if (fingerprint(std::as_bytes(std::span(text))) !=
      std::string_view(preamble.header_fingerprint.data(), preamble.header_fingerprint.size()))
    reader.damaged("its header has changed");
  return nlohmann::ordered_json::parse(text);
}

}  // namespace vernier
