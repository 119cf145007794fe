// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/sampler.h"

#include <cassert>

namespace vernier {
namespace {

constexpr int dimensions = 8;  // of one block
constexpr int index_bits = 32;

template <typename Word>
constexpr Word reverse_bits(Word v) {
  v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
  return (v >> 16) | (v << 16);
}

/// Primitive polynomial (degree, inner coefficients) and initial direction numbers of a Sobol' dimension
/// (Joe and Kuo 2008, "Constructing Sobol Sequences with Better Two-Dimensional Projections", new-joe-kuo-6).
struct SobolDimension {
  int degree;
  uint32_t coefficients;
  std::array<uint32_t, 5> initial;
};
constexpr std::array<SobolDimension, dimensions - 1> sobol_dimensions{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
}};

constexpr std::array<uint32_t, index_bits> direction_numbers(int dimension) {
  std::array<uint32_t, index_bits> v{};
  if (dimension == 0) {  // van der Corput
    for (int i = 0; i < index_bits; ++i) v[i] = 1u << (31 - i);
    return v;
  }
  const auto& [degree, coefficients, initial] = sobol_dimensions[dimension - 1];
  for (int i = 0; i < index_bits; ++i) {
    if (i < degree) {
      v[i] = initial[i] << (31 - i);
      continue;
    }
    v[i] = v[i - degree] ^ (v[i - degree] >> degree);
    for (int k = 1; k < degree; ++k)
      if ((coefficients >> (degree - 1 - k)) & 1) v[i] ^= v[i - k];
  }
  return v;
}

/// Four numbers, one a dimension (vector extension of GCC and Clang).
using Lanes = uint32_t __attribute__((vector_size(16)));

/// Generator matrices applied four index bits at a time, four dimensions at once. Both index and point are
/// bit-reversed, which is the form that owen_hash takes.
struct SobolTables {
  Lanes nibble[dimensions / 4][8][16];
};

constexpr SobolTables make_tables() {
  SobolTables tables{};
  for (int d = 0; d < dimensions; ++d) {
    const auto v = direction_numbers(d);
    for (int position = 0; position < 8; ++position)
      for (uint32_t value = 0; value < 16; ++value) {
        uint32_t sum = 0;
        for (int bit = 0; bit < 4; ++bit)
          if ((value >> bit) & 1) sum ^= reverse_bits(v[31 - (4 * position + bit)]);
        tables.nibble[d / 4][position][value][d % 4] = sum;
      }
  }
  return tables;
}
const SobolTables tables = make_tables();

/// Random permutation in which each bit depends on the seed and the lower bits only: on a reversed number, a
/// nested uniform (Owen) scramble (Laine and Karras 2011; constants of Vegdahl 2021 as in pbrt-v4).
template <typename Word>
Word owen_hash(Word v, Word seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1u;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return v;
}

}  // namespace

Sampler::Sampler(uint32_t stream, uint32_t index, uint64_t seed)
    : stream_hash_(
          mix_bits((uint64_t(mix_bits(seed)) << 32) ^ (stream + 0x9e3779b97f4a7c15ull * (seed + 1)))),
      reversed_index_(reverse_bits(index)) {
  start_block(0);
}

void Sampler::start_block(uint32_t block) {
  block_hash_ = mix_bits((uint64_t(block) << 32) | stream_hash_);
  shuffled_ = owen_hash(reversed_index_, block_hash_);
  dimension_ = 0;
}

void Sampler::make_lanes() {
  assert(dimension_ < dimensions);
  const auto& nibble = tables.nibble[dimension_ / lanes];
  Lanes reversed_point{};
  for (int position = 0; position < 8; ++position)
    reversed_point ^= nibble[position][(shuffled_ >> (4 * position)) & 15];
  const Lanes seeds = (Lanes{1, 2, 3, 4} + dimension_) * 0x9e3779b9u + block_hash_;
  const Lanes point = reverse_bits(owen_hash(reversed_point, seeds));
  for (uint32_t lane = 0; lane < lanes; ++lane) points_[lane] = point[lane];
}

}  // namespace vernier
