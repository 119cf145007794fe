// SPDX-License-Identifier: Apache-2.0
#include "core/base/build.h"

#include <elf.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>

#include "vernier/version.h"

namespace vernier {
namespace {

constexpr std::string_view gnu("GNU\0", 4);  // notes count the end of their owner's name

/// The description of the note of type NT_GNU_BUILD_ID among those of a segment (System V ABI, chapter 5).
std::string id_among(const char* notes, size_t size, size_t alignment) {
  const auto padded = [alignment](size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; };
  ElfW(Nhdr) note;
  for (size_t at = 0; at + sizeof(note) <= size;) {
    std::memcpy(&note, notes + at, sizeof(note));
    const size_t name = at + sizeof(note), description = name + padded(note.n_namesz);
    at = description + padded(note.n_descsz);
    if (at > size) break;
    if (note.n_type != NT_GNU_BUILD_ID || std::string_view(notes + name, note.n_namesz) != gnu) continue;
    std::string id;
    for (size_t i = 0; i < note.n_descsz; ++i)
      id += fmt::format("{:02x}", static_cast<unsigned char>(notes[description + i]));
    return id;
  }
  return {};
}

}  // namespace

std::string build_id() {
  std::string id;
  const auto look = [](dl_phdr_info* module, size_t, void* found) {
    const auto segments = std::span(module->dlpi_phdr, module->dlpi_phnum);
    const auto here = reinterpret_cast<ElfW(Addr)>(&build_id);
    const auto holds_this = [&](const auto& segment) {
      const ElfW(Addr) start = module->dlpi_addr + segment.p_vaddr;
      return segment.p_type == PT_LOAD && here >= start && here < start + segment.p_memsz;
    };
    if (std::none_of(segments.begin(), segments.end(), holds_this)) return 0;
    std::string& result = *static_cast<std::string*>(found);
    for (const auto& segment : segments)
      if (segment.p_type == PT_NOTE && result.empty())
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader tells places as numbers
        result = id_among(reinterpret_cast<const char*>(module->dlpi_addr + segment.p_vaddr), segment.p_memsz,
                          segment.p_align == 8 ? 8 : 4);
    return 1;
  };
  dl_iterate_phdr(look, &id);
  return id;
}

std::string platform() {
  std::string features;
#ifdef __x86_64__
  // __builtin_cpu_supports() wants literals. The features are those that glibc has variants for.
  const auto add = [&](bool has, const char* name) {
    if (has) features += fmt::format("{}{}", features.empty() ? "" : " ", name);
  };
  add(__builtin_cpu_supports("avx2"), "avx2");
  add(__builtin_cpu_supports("avx512f"), "avx512f");
  add(__builtin_cpu_supports("fma"), "fma");
  add(__builtin_cpu_supports("fma4"), "fma4");
  add(__builtin_cpu_supports("sse4.1"), "sse4.1");
#endif
  return fmt::format("{}, glibc {}, {}", features.empty() ? "baseline" : features, gnu_get_libc_version(),
                     VERNIER_COMPILER);
}

const char* version() { return VERNIER_VERSION; }

}  // namespace vernier
