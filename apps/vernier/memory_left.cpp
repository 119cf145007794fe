// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/memory_left.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/vernier/picture_output.h"
#include "core/base/resident_memory.h"

namespace vernier::apps {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t unlimited = std::numeric_limits<uint64_t>::max();

/// The number that is alone in a file; `unlimited` where there is none, such as "max".
uint64_t number_in(const char* file) {
  std::ifstream stream(file);
  uint64_t number = 0;
  return stream >> number ? number : unlimited;
}

uint64_t left_of_machine() {
  std::ifstream stream("/proc/meminfo");
  std::string word;
  uint64_t kibibytes = 0;
  while (stream >> word)
    if (word == "MemAvailable:" && stream >> kibibytes) return kibibytes * 1024;
  return unlimited;
}

/// Control groups as containers see them: their own at the root, of version 2 or 1.
uint64_t left_of_group() {
  struct Files {
    const char *most, *used;
  };
  constexpr std::array<Files, 2> versions{
      {{"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"},
       {"/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes"}}};
  uint64_t left = unlimited;
  for (const auto& [most_file, used_file] : versions) {
    const uint64_t most = number_in(most_file), used = number_in(used_file);
    if (most != unlimited && used != unlimited) left = std::min(left, most - std::min(most, used));
  }
  return left;
}

uint64_t left_of_shell_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const uint64_t pages = number_in("/proc/self/statm");
  if (pages == unlimited) return 0;
  const uint64_t used = pages * uint64_t(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<uint64_t>(limit.rlim_cur, used);
}

uint64_t size_of(const fs::path& file) {
  std::error_code error;
  const uintmax_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

uint64_t memory_left() { return std::min({left_of_machine(), left_of_group(), left_of_shell_limit()}); }

uint64_t bytes_of_scene(const std::string& file) {
  const fs::path path(file);
  uint64_t bytes = size_of(path);
  if (path.extension() != ".gltf") return bytes;
  std::ifstream stream(path);
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) return bytes;
  for (const char* list : {"buffers", "images"}) {
    const auto found = json.find(list);
    if (found == json.end() || !found->is_array()) continue;
    for (const auto& entry : *found) {
      const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
      if (uri == entry.end() || !uri->is_string()) continue;
      const auto& text = uri->get_ref<const std::string&>();
      if (!text.starts_with("data:")) bytes += size_of(path.parent_path() / text);
    }
  }
  return bytes;
}

bool has_room_for_scene(const std::string& file, uint64_t max_memory) {
  // Textures, which are decoded, are what grows most: those of a helmet, 3.8 MB as JPEG, take 84 MB. That
  // much is left free once more, for the pictures that are rendered.
  constexpr uint64_t growth = 32, share = 2;
  uint64_t left = memory_left();
  if (max_memory > 0) left = std::min(left, max_memory - std::min(max_memory, resident_bytes()));
  return !is_standard_stream(file) && bytes_of_scene(file) < left / (growth * share);
}

}  // namespace vernier::apps
