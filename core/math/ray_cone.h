// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// The rays that one of them stands for, as a cone about it: how wide it is where the ray begins, and how
/// much wider after each metre (Akenine-Möller, Nilsson, Andersson, Barré-Brisebois, Toth and Karras 2019,
/// "Texture Level of Detail Strategies for Real-Time Ray Tracing"). A width is the side of the square that
/// has the area of the cross section. Of width and spread 0, which is the default, it is the ray alone.
struct RayCone {
  float width = 0;   ///< metres
  float spread = 0;  ///< metres a metre

  float width_at(float t) const { return width + spread * t; }
};

}  // namespace vernier
