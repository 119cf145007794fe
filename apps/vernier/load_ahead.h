// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "apps/vernier/notice_log.h"
#include "apps/vernier/posed_scene.h"

namespace vernier::apps {

/// Which scene is loaded, and how it is posed.
struct PoseKey {
  std::shared_ptr<SceneLoader> loader;
  std::string variant;
  std::optional<int> frame;

  bool operator==(const PoseKey&) const = default;
};

/// Makes one scene on a thread of its own while another is rendered. It only ever saves time: what fails
/// here, or has no room, is thrown away without a word, to be done again when its turn comes, where the same
/// failure is told in its place.
class LoadAhead {
 public:
  /// Makes the scene, or only reads its file and returns null.
  using Load = std::function<std::unique_ptr<PosedScene>(NoticeLog&)>;

  LoadAhead() = default;
  /// Waits for what is being loaded.
  ~LoadAhead();
  LoadAhead(const LoadAhead&) = delete;
  LoadAhead& operator=(const LoadAhead&) = delete;

  /// Begins, unless there is too little memory, by itself or by --max-memory (0: without), for the file
  /// beside what is rendered. What was loaded before and not taken is dropped.
  void start(PoseKey key, const std::string& file, uint64_t max_memory, Load load);
  /// Waits until nothing is being loaded, so that its loader may be used.
  void wait();
  /// What was loaded under this key, whose notices go to `log`; null when it was not.
  std::unique_ptr<PosedScene> take(const PoseKey& key, NoticeLog& log);

 private:
  struct Loaded {
    std::unique_ptr<PosedScene> scene;
    NoticeLog notices{true};
  };

  std::optional<PoseKey> key_;
  std::optional<Loaded> loaded_;
  std::future<void> loading_;
};

}  // namespace vernier::apps
