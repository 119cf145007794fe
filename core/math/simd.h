// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#ifdef __SSE2__
#include <immintrin.h>
#endif

// Four and eight floats at once, through the vector types of GCC and Clang: arithmetic, comparison and ?:
// work lane by lane on any target. Vectors are passed by reference, because passing eight lanes by value has
// no stable ABI below AVX.

namespace vernier {

using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));
using Mask4 = int32_t __attribute__((vector_size(16)));  ///< lanes are 0 or -1
using Mask8 = int32_t __attribute__((vector_size(32)));
using DoubleMask4 = int64_t __attribute__((vector_size(32)));

/// Bit i is lane i.
inline unsigned lane_bits(const Mask4& mask) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(std::bit_cast<__m128>(mask)));
#else
  unsigned bits = 0;
  for (unsigned lane = 0; lane < 4; ++lane) bits |= (mask[lane] & 1u) << lane;
  return bits;
#endif
}

inline unsigned lane_bits(const DoubleMask4& mask) { return lane_bits(__builtin_convertvector(mask, Mask4)); }

inline unsigned lane_bits(const Mask8& mask) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_ps(std::bit_cast<__m256>(mask)));
#else
  unsigned bits = 0;
  for (unsigned lane = 0; lane < 8; ++lane) bits |= (mask[lane] & 1u) << lane;
  return bits;
#endif
}

inline Double4 widened(const Float4& x) { return __builtin_convertvector(x, Double4); }
/// Rounded.
inline Float4 narrowed(const Double4& x) { return __builtin_convertvector(x, Float4); }

/// Index of the lowest bit that is set.
inline unsigned lowest(unsigned bits) { return static_cast<unsigned>(std::countr_zero(bits)); }

/// The sign bits alone.
inline Mask4 signs_of(const Float4& x) {
  return std::bit_cast<Mask4>(x) & std::numeric_limits<int32_t>::min();
}
/// x with its sign flipped where `signs` says.
inline Float4 flipped(const Float4& x, const Mask4& signs) {
  return std::bit_cast<Float4>(std::bit_cast<Mask4>(x) ^ signs);
}
inline Mask8 signs_of(const Float8& x) {
  return std::bit_cast<Mask8>(x) & std::numeric_limits<int32_t>::min();
}
inline Float8 flipped(const Float8& x, const Mask8& signs) {
  return std::bit_cast<Float8>(std::bit_cast<Mask8>(x) ^ signs);
}
inline Float4 magnitude(const Float4& x) { return flipped(x, signs_of(x)); }

/// `a` where it is the greater, else `b`: a NaN in `a` gives `b`.
inline void keep_greater(const Float8& a, Float8& b) { b = a > b ? a : b; }
/// `a` where it is the smaller, else `b`: a NaN in `a` gives `b`.
inline void keep_smaller(const Float8& a, Float8& b) { b = a < b ? a : b; }

/// a b + c, rounded once where the processor can and else twice.
inline Float8 multiply_add(const Float8& a, float b, const Float8& c) {
#ifdef __FMA__
  return std::bit_cast<Float8>(
      _mm256_fmadd_ps(std::bit_cast<__m256>(a), _mm256_set1_ps(b), std::bit_cast<__m256>(c)));
#else
  return a * b + c;
#endif
}

inline Float8 square_root(const Float8& x) {
#ifdef __AVX__
  return std::bit_cast<Float8>(_mm256_sqrt_ps(std::bit_cast<__m256>(x)));
#else
  Float8 root;
  for (unsigned lane = 0; lane < 8; ++lane) root[lane] = std::sqrt(x[lane]);
  return root;
#endif
}

}  // namespace vernier
