// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::apps {

/// Numbers of frames, ascending and each once, from "7", "1-48", "1-48x2" (every second one) or a list of
/// such: "1,5,10-20". Throws Error(usage) that says what was probably meant.
std::vector<int> parse_frames(std::string_view text);

/// What parse_frames() takes, for numbers that ascend: "7", "1-48", "1-47x2", else "1,5,7".
std::string frames_text(std::span<const int> frames);

/// Seconds into an animation at which a frame lies: frame 0 at its beginning, as Blender's glTF exporter
/// writes them.
inline double frame_time(int frame, double frames_per_second) { return frame / frames_per_second; }

}  // namespace vernier::apps
