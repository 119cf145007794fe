// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// A double of Open Image Denoise: a library with the functions of its C interface that Vernier calls. It
// writes down what is asked of it, fails when told to, and its filter halves the color.

namespace vernier::test {

/// What the double was asked, and how it is to answer.
struct OidnRecord {
  std::vector<std::string> calls;
  std::string fails_at;  ///< the call that fails; empty: none does
  int failure = 1;       ///< as the library numbers errors; 1: unknown
  int pending = 0;       ///< not asked for yet

  void operator()(const std::string& call) {
    calls.push_back(call);
    if (call == fails_at) pending = failure;
  }
};

}  // namespace vernier::test

/// Exported by the double; null of other libraries.
using OidnRecordFunction = vernier::test::OidnRecord* (*)();
constexpr const char* oidn_record_name = "vernier_oidn_record";
