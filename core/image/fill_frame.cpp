// SPDX-License-Identifier: Apache-2.0
#include "core/image/fill_frame.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

namespace vernier {

Image fill_frame(const Image& picture, int width, int height) {
  // The part that has the frame's shape, in whole pixels.
  const double scale = std::min(double(picture.width) / width, double(picture.height) / height);
  const int part_width = std::clamp(int(std::lround(scale * width)), 1, picture.width);
  const int part_height = std::clamp(int(std::lround(scale * height)), 1, picture.height);
  const int left = (picture.width - part_width) / 2, top = (picture.height - part_height) / 2;
  Image part(part_width, part_height, 3);
  for (int y = 0; y < part_height; ++y)
    std::copy_n(picture.pixel(left, top + y), size_t(part_width) * 3, part.pixel(0, y));
  if (part_width == width && part_height == height) return part;

  Image filled(width, height, 3);
  const OIIO::ImageBuf source(OIIO::ImageSpec(part_width, part_height, 3, OIIO::TypeFloat),
                              part.values.data());
  OIIO::ImageBuf target(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat), filled.values.data());
  // A filter without negative lobes; on one thread, since the caller's may be limited.
  OIIO::ImageBufAlgo::resize(target, source, "blackman-harris", 0, {}, 1);
  return filled;
}

}  // namespace vernier
