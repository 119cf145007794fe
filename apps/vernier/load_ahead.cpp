// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/load_ahead.h"

#include <exception>

#include "apps/vernier/memory_left.h"

namespace vernier::apps {

LoadAhead::~LoadAhead() { wait(); }

void LoadAhead::start(PoseKey key, const std::string& file, uint64_t max_memory, Load load) {
  wait();
  key_ = std::move(key);
  loaded_.reset();
  const auto run = [this, file, max_memory, load = std::move(load)] {
    if (!has_room_for_scene(file, max_memory)) return;
    try {
      Loaded loaded;
      loaded.scene = load(loaded.notices);
      loaded_ = std::move(loaded);
    } catch (const std::exception&) {  // told when it fails in its turn
    }
  };
  loading_ = std::async(std::launch::async, run);
}

void LoadAhead::wait() {
  if (loading_.valid()) loading_.get();
}

std::unique_ptr<PosedScene> LoadAhead::take(const PoseKey& key, NoticeLog& log) {
  wait();
  std::unique_ptr<PosedScene> scene;
  if (key_ == key && loaded_) {
    log.add(loaded_->notices.notices());
    scene = std::move(loaded_->scene);
  }
  key_.reset();
  loaded_.reset();
  return scene;
}

}  // namespace vernier::apps
