// SPDX-License-Identifier: Apache-2.0
// Any file is a checkpoint from which rendering can go on, or is refused with an Error. Fingerprints are made
// right first: they are no secret, and would stop nearly every input before the checks behind them.

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/fingerprint.h"
#include "integrators/render/checkpoint.h"
#include "tests/fuzz/scratch_file.h"
#include "vernier/error.h"

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t length_at = 12, fingerprint_at = 16, fingerprint_size = 32, preamble_size = 48;

std::string fingerprint_of(std::string_view bytes) {
  return vernier::fingerprint(std::as_bytes(std::span(bytes)));
}

/// The header with fingerprints of the arrays behind it, as far as it can be understood.
std::string with_fingerprints(const std::string& header, std::string_view arrays) {
  Json json = Json::parse(header, nullptr, false);
  if (!json.is_object() || !json.contains("arrays") || !json["arrays"].is_array()) return header;
  for (Json& array : json["arrays"]) {
    if (!array.is_object() || !array.contains("bytes") || !array["bytes"].is_number_unsigned()) return header;
    const std::string_view own = arrays.substr(0, array["bytes"].get<size_t>());
    array["fingerprint"] = fingerprint_of(own);
    arrays.remove_prefix(own.size());
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string repaired(std::string file) {
  if (file.size() < preamble_size) return file;
  uint32_t length = 0;
  std::memcpy(&length, &file[length_at], sizeof(length));
  if (length > file.size() - preamble_size) return file;
  const std::string arrays = file.substr(preamble_size + length);
  const std::string header = with_fingerprints(file.substr(preamble_size, length), arrays);
  length = uint32_t(header.size());
  std::memcpy(&file[length_at], &length, sizeof(length));
  file.replace(fingerprint_at, fingerprint_size, fingerprint_of(header));
  return file.substr(0, preamble_size) + header + arrays;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const vernier::fuzz::ScratchFile file;
  try {
    vernier::read_checkpoint(file.write("x.ckpt", repaired({reinterpret_cast<const char*>(data), size})));
  } catch (const vernier::Error&) {
  }
  return 0;
}
