// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "vernier/error.h"

namespace vernier::apps {

/// Prints each different notice of a scene once, as it comes, and keeps those of a picture for its report.
class NoticeLog {
 public:
  explicit NoticeLog(bool quiet) : quiet_(quiet) {}

  /// From here on notices are about a scene, at some time; those that are printed name it. Empty: there is
  /// but one, or but one time of it so far.
  void begin_pose(const std::string& scene, const std::string& time) {
    scene_ = scene;
    detail_ = time;
    notices_.clear();
    of_pose_.reset();
  }
  /// From here on notices are kept for one picture of it, beside those since begin_pose().
  void begin_picture(const std::string& picture) {
    if (!of_pose_) of_pose_ = notices_.size();
    notices_.resize(*of_pose_);
    detail_ = picture;
  }

  void add(const Notice& notice);
  void add(std::span<const Notice> notices);

  const std::vector<Notice>& notices() const { return notices_; }

 private:
  bool quiet_;
  std::string scene_, detail_;
  std::optional<size_t> of_pose_;  ///< notices that each of its pictures has; none: there is no picture yet
  std::set<std::string> seen_;
  std::vector<Notice> notices_;
};

nlohmann::ordered_json to_json(std::span<const Notice> notices);

}  // namespace vernier::apps
