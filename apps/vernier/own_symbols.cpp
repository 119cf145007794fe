// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/own_symbols.h"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <fstream>

namespace vernier::apps {
namespace {

template <typename T>
std::vector<T> read_array(std::ifstream& file, uint64_t offset, uint64_t bytes) {
  std::vector<T> items(bytes / sizeof(T));
  file.seekg(std::streamoff(offset));
  file.read(reinterpret_cast<char*>(items.data()), std::streamsize(items.size() * sizeof(T)));
  if (!file) items.clear();
  return items;
}

/// What is added to addresses of the program's file to get those in memory. The program comes first.
uintptr_t load_offset() {
  uintptr_t offset = 0;
  const auto first = [](dl_phdr_info* info, size_t, void* out) {
    *static_cast<uintptr_t*>(out) = info->dlpi_addr;
    return 1;
  };
  dl_iterate_phdr(first, &offset);
  return offset;
}

}  // namespace

OwnSymbols::OwnSymbols() {
  std::ifstream file("/proc/self/exe", std::ios::binary);
  const auto header = read_array<ElfW(Ehdr)>(file, 0, sizeof(ElfW(Ehdr)));
  if (header.empty()) return;
  const auto sections =
      read_array<ElfW(Shdr)>(file, header[0].e_shoff, uint64_t(header[0].e_shnum) * sizeof(ElfW(Shdr)));
  const auto table = std::find_if(sections.begin(), sections.end(),
                                  [](const auto& section) { return section.sh_type == SHT_SYMTAB; });
  if (table == sections.end() || table->sh_link >= sections.size()) return;
  const auto& strings = sections[table->sh_link];
  const auto names = read_array<char>(file, strings.sh_offset, strings.sh_size);
  names_.assign(names.begin(), names.end());
  const uintptr_t offset = load_offset();
  for (const auto& symbol : read_array<ElfW(Sym)>(file, table->sh_offset, table->sh_size))
    if ((symbol.st_info & 0xf) == STT_FUNC && symbol.st_size > 0 && symbol.st_name < names_.size())
      functions_.push_back(
          {offset + symbol.st_value, offset + symbol.st_value + symbol.st_size, symbol.st_name});
  std::sort(functions_.begin(), functions_.end(),
            [](const Function& a, const Function& b) { return a.begin < b.begin; });
}

std::string_view OwnSymbols::name_at(uintptr_t address) const {
  const auto after =
      std::upper_bound(functions_.begin(), functions_.end(), address,
                       [](uintptr_t place, const Function& function) { return place < function.begin; });
  if (after == functions_.begin() || address >= (after - 1)->end) return {};
  return names_.c_str() + (after - 1)->name;
}

}  // namespace vernier::apps
