// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/memory_limit.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "core/base/quantities.h"
#include "core/base/resident_memory.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

double pixel_count(const RenderSettings& settings) {
  const Crop& crop = settings.crop;
  if (crop.width > 0) return double(crop.width) * crop.height;
  // A picture without a size has the camera's shape and this many pixels along its longer side.
  constexpr double longest = 1280;
  return settings.width > 0 ? double(settings.width) * settings.height : longest * longest;
}

}  // namespace

ImageLimits limits_within(uint64_t max_memory) {
  // What reading takes at its peak, of EXR with halves: 35 bytes. What stays, tables included, is less.
  constexpr uint64_t bytes_per_pixel = 36;
  ImageLimits limits;
  if (max_memory == 0) return limits;
  const uint64_t left = max_memory - std::min(max_memory, resident_bytes());
  limits.max_pixels = std::min(limits.max_pixels, int64_t(left / bytes_per_pixel));
  limits.advice = "scale it down, or raise --max-memory";
  return limits;
}

MemoryLimit leaving_room_for_pictures(MemoryLimit limit, const RenderSettings& settings,
                                      const MemoryUse& use) {
  limit.elsewhere = uint64_t(pixel_count(settings)) * peak_bytes_per_pixel(use);
  limit.has_mips = settings.texture_filter.is_on();
  return limit;
}

void check_picture_size(const RenderSettings& options, const MemoryUse& use, const MemoryLimit& limit) {
  const Crop& crop = options.crop;
  if (crop.width > 0 && (crop.width > options.width - crop.x || crop.height > options.height - crop.y))
    throw Error(ErrorKind::usage,
                fmt::format("--crop {}x{}+{}+{} reaches beyond the picture of {}x{}", crop.width, crop.height,
                            crop.x, crop.y, options.width, options.height));
  const double pixels = pixel_count(options);
  const double bytes = pixels * double(peak_bytes_per_pixel(use));
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (bytes > memory)
    throw Error(ErrorKind::memory,
                fmt::format("a picture of {} pixels needs {} of memory beside the scene and there are {}; "
                            "render parts with --crop",
                            format_count(pixels), format_bytes(bytes), format_bytes(memory)));
  if (limit.bytes == 0) return;
  const double taken = double(resident_bytes());
  if (taken + bytes > double(limit.bytes))
    throw Error(ErrorKind::memory,
                fmt::format("a picture of {} pixels needs {} of memory beside {} that are taken, and "
                            "--max-memory is {}; render parts with --crop, or give it more",
                            format_count(pixels), format_bytes(bytes), format_bytes(taken),
                            format_bytes(double(limit.bytes))));
}

}  // namespace vernier::apps
