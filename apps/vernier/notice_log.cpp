// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/notice_log.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "apps/vernier/messages.h"

namespace vernier::apps {

void NoticeLog::add(const Notice& notice) {
  const Notice kept{notice.severity, one_line(notice.place), one_line(notice.text)};
  const auto is_same = [&](const Notice& n) { return describe(n) == describe(kept); };
  if (std::any_of(notices_.begin(), notices_.end(), is_same)) return;
  notices_.push_back(kept);
  if (quiet_ || !seen_.insert(scene_ + describe(kept)).second) return;
  std::string place;
  for (const std::string* part : std::array<const std::string*, 3>{&scene_, &detail_, &kept.place})
    if (!part->empty()) place += (place.empty() ? "" : ": ") + *part;
  print_notice({kept.severity, place, kept.text});
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
