// SPDX-License-Identifier: Apache-2.0
// Any file is a scene that can be built and traced, or is refused with an Error.

#include <cstring>
#include <string>

#include "tests/scene/try_file.h"
#include "vernier/error.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

constexpr size_t header_size = 12, chunk_header_size = 8;

std::string word(size_t value) {
  const uint32_t low = uint32_t(value);
  return std::string(reinterpret_cast<const char*>(&low), sizeof(low));
}

/// The JSON and what follows its chunk of a .glb; nothing of another file.
bool split(const std::string& file, std::string& json, std::string& rest) {
  if (!file.starts_with("glTF") || file.size() < header_size + chunk_header_size) return false;
  uint32_t length = 0;
  std::memcpy(&length, &file[header_size], sizeof(length));
  if (length > file.size() - header_size - chunk_header_size) return false;
  json = file.substr(header_size + chunk_header_size, length);
  rest = file.substr(header_size + chunk_header_size + length);
  return true;
}

std::string joined(const std::string& json, const std::string& rest) {
  return "glTF" + word(2) + word(header_size + chunk_header_size + json.size() + rest.size()) +
         word(json.size()) + "JSON" + json + rest;
}

/// One of libFuzzer's mutations, to at most so many bytes.
void mutate(std::string& bytes, size_t most) {
  const size_t size = bytes.size();
  bytes.resize(std::max(size, most));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(bytes.data()), size, bytes.size()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    vernier::SceneFile file("x", {data, size});
    vernier::test::try_file(file);
  } catch (const vernier::Error&) {
  }
  return 0;
}

/// Changes either the JSON or what is binary and keeps the container whole around it: nearly all other
/// changes would be refused for the lengths in it, before anything is read. Those are left to one in sixteen.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  std::string json, rest;
  if (seed % 16 == 0 || !split({reinterpret_cast<const char*>(data), size}, json, rest))
    return LLVMFuzzerMutate(data, size, max_size);
  const size_t room = max_size > size ? max_size - size : 0;
  if (seed / 16 % 2 == 0 || rest.size() <= chunk_header_size) {
    mutate(json, json.size() + room);
    json.resize((json.size() + 3) / 4 * 4, ' ');
  } else {
    // The length that the JSON tells stays true.
    const std::string head = rest.substr(0, chunk_header_size);
    std::string binary = rest.substr(chunk_header_size);
    const size_t length = binary.size();
    mutate(binary, length);
    binary.resize(length);
    rest = head + binary;
  }
  const std::string file = joined(json, rest);
  if (file.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, file.data(), file.size());
  return file.size();
}
