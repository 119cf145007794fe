// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::apps {

/// The functions of this program, from the symbol table of its file; none when that was stripped.
class OwnSymbols {
 public:
  OwnSymbols();

  bool empty() const { return functions_.empty(); }
  /// Mangled name of the function that holds this address; empty when none does.
  std::string_view name_at(uintptr_t address) const;

 private:
  struct Function {
    uintptr_t begin, end;  ///< as loaded
    size_t name;           ///< offset in names_
  };
  std::vector<Function> functions_;  ///< by address
  std::string names_;
};

}  // namespace vernier::apps
