// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/build_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstring>
#include <string_view>

namespace vernier::apps {
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
  const auto look = [](dl_phdr_info* program, size_t, void* found) {
    std::string& result = *static_cast<std::string*>(found);
    for (int i = 0; i < program->dlpi_phnum && result.empty(); ++i) {
      const auto& segment = program->dlpi_phdr[i];
      if (segment.p_type == PT_NOTE)
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader tells places as numbers
        result = id_among(reinterpret_cast<const char*>(program->dlpi_addr + segment.p_vaddr),
                          segment.p_memsz, segment.p_align == 8 ? 8 : 4);
    }
    return 1;  // the program is the first, libraries come after it
  };
  dl_iterate_phdr(look, &id);
  return id;
}

}  // namespace vernier::apps
