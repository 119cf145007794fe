// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/notice_log.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/vernier/messages.h"

namespace vernier::apps {

void NoticeLog::add(const Notice& notice) {
  const std::string line = describe(notice);
  if (!seen_.insert(line).second) return;
  notices_.push_back({notice.severity, one_line(notice.place), one_line(notice.text)});
  if (!quiet_) fmt::print(stderr, "{}\n", line);
}

void NoticeLog::add(std::span<const Notice> notices) {
  for (const Notice& notice : notices) add(notice);
}

nlohmann::ordered_json to_json(std::span<const Notice> notices) {
  auto list = nlohmann::ordered_json::array();
  for (const Notice& notice : notices)
    list.push_back({{"severity", notice.severity == Notice::Severity::warning ? "warning" : "note"},
                    {"place", notice.place},
                    {"text", notice.text}});
  return list;
}

}  // namespace vernier::apps
