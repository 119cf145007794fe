// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

// Facts of UASTC LDR 4x4, as Binomial's "UASTC Texture Specification" states them; the numbers were taken
// from Khronos's transcoders (github.com/KhronosGroup/Basis-Universal-Transcoders) and the table of modes of
// github.com/JakubValtar/basisu_rs.

namespace vernier::ktx2 {

/// How endpoints are stored: some bits each and, packed apart, a digit in base 3 or 5 on top of them.
struct EndpointRange {
  int bits;
  int base;  ///< of the digit; 1: none
};

/// Where the fields of a block lie, in bits from its start.
struct UastcMode {
  enum class Colors { rgb, rgba, luminance_alpha };
  Colors colors;
  int subsets, planes;
  int selector;  ///< of the subsets' pattern, or else of the second plane's channel; 0: neither
  int digits, endpoints;
  EndpointRange range;
  int weights, weight_bits;
};

constexpr size_t solid_mode = 8;
constexpr size_t reserved_mode = 19;
constexpr size_t own_patterns_mode = 7;  ///< of two subsets in patterns that no other mode has

using enum UastcMode::Colors;
/// By mode; the solid one has but a colour.
constexpr std::array<UastcMode, 19> uastc_modes{{{rgb, 1, 1, 0, 19, 29, {6, 3}, 65, 4},
                                                 {rgb, 1, 1, 0, 0, 21, {8, 1}, 69, 2},
                                                 {rgb, 2, 1, 20, 0, 25, {4, 1}, 73, 3},
                                                 {rgb, 3, 1, 20, 24, 53, {2, 3}, 89, 2},
                                                 {rgb, 2, 1, 20, 25, 53, {3, 5}, 89, 2},
                                                 {rgb, 1, 1, 0, 0, 20, {8, 1}, 68, 3},
                                                 {rgb, 1, 2, 20, 22, 36, {5, 5}, 66, 2},
                                                 {rgb, 2, 1, 20, 25, 53, {3, 5}, 89, 2},
                                                 {rgba, 1, 1, 0, 0, 5, {8, 1}, 0, 0},
                                                 {rgba, 2, 1, 28, 0, 33, {4, 1}, 97, 2},
                                                 {rgba, 1, 1, 0, 20, 33, {4, 3}, 65, 4},
                                                 {rgba, 1, 2, 19, 21, 34, {4, 3}, 66, 2},
                                                 {rgba, 1, 1, 0, 20, 33, {6, 3}, 81, 3},
                                                 {rgba, 1, 2, 28, 0, 30, {8, 1}, 94, 1},
                                                 {rgba, 1, 1, 0, 0, 28, {8, 1}, 92, 2},
                                                 {luminance_alpha, 1, 1, 0, 0, 30, {8, 1}, 62, 4},
                                                 {luminance_alpha, 2, 1, 29, 0, 34, {8, 1}, 98, 2},
                                                 {luminance_alpha, 1, 2, 0, 0, 29, {8, 1}, 61, 2},
                                                 {rgb, 1, 1, 0, 0, 19, {5, 1}, 49, 5}}};

/// A block begins with the code of its mode, the first bit lowest.
struct ModeCode {
  uint8_t code, length;
};
constexpr std::array<ModeCode, 20> mode_codes{{{1, 4},  {53, 6}, {29, 5}, {3, 5},  {19, 5}, {11, 5}, {27, 5},
                                               {7, 5},  {23, 5}, {15, 5}, {2, 3},  {0, 2},  {6, 3},  {31, 5},
                                               {13, 5}, {5, 7},  {21, 6}, {37, 6}, {9, 4},  {69, 7}}};

/// Texels of the second subset, the first texel lowest.
constexpr std::array<uint16_t, 30> two_subsets{0xCCCC, 0x8888, 0x1111, 0xECC8, 0x377F, 0xFEEC, 0x0137, 0x137F,
                                               0xC800, 0x0013, 0xFE80, 0x17FF, 0x0017, 0x00FF, 0xFFF0, 0x0FFF,
                                               0xFF71, 0x8EFF, 0x08CE, 0x008C, 0x7310, 0xCEFF, 0x7331, 0x088C,
                                               0xCEEF, 0x6666, 0xF00F, 0x5555, 0x0F0F, 0x36C9};
constexpr std::array<uint16_t, 19> own_two_subsets{0x00F0, 0x4444, 0x0133, 0xCC80, 0xF0FF, 0x2222, 0xFFC8,
                                                   0xCCCE, 0x3C03, 0x00EE, 0x7700, 0x3003, 0x00CE, 0xFF80,
                                                   0x6FFF, 0x1333, 0x11FF, 0x136C, 0x00EF};

/// Texels of the second and of the third subset.
struct ThreeSubsets {
  uint16_t second, third;
};
constexpr std::array<ThreeSubsets, 11> three_subsets{{{0x3300, 0xCC00},
                                                      {0x00FF, 0xF000},
                                                      {0x000F, 0xF000},
                                                      {0x000F, 0x00F0},
                                                      {0x3333, 0x4444},
                                                      {0x6666, 0x8888},
                                                      {0xCCCC, 0x2222},
                                                      {0xEE00, 0x1111},
                                                      {0x4444, 0x9999},
                                                      {0xF00F, 0x0F00},
                                                      {0x0CC0, 0xC00C}}};

}  // namespace vernier::ktx2
