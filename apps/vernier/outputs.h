// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/vernier/messages.h"

namespace vernier::apps {

/// The outputs of one run, which do not depend on each other: when one cannot be written, its error is
/// printed and the others follow.
class Outputs {
 public:
  /// Whether `write` went well; catches Error.
  template <typename Write>
  bool attempt(const Write& write) {
    try {
      write();
      return true;
    } catch (const Error& error) {
      print_error(error.what());
    }
    have_failed_ = true;
    return false;
  }

  bool have_failed() const { return have_failed_; }

 private:
  bool have_failed_ = false;
};

}  // namespace vernier::apps
