// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "vernier/error.h"

namespace vernier::apps {

/// Prints each different notice once, as it comes, and keeps it for the report.
class NoticeLog {
 public:
  explicit NoticeLog(bool quiet) : quiet_(quiet) {}

  void add(const Notice& notice);
  void add(std::span<const Notice> notices);

  const std::vector<Notice>& notices() const { return notices_; }

 private:
  bool quiet_;
  std::set<std::string> seen_;
  std::vector<Notice> notices_;
};

nlohmann::ordered_json to_json(std::span<const Notice> notices);

}  // namespace vernier::apps
