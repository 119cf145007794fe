// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vernier::ktx2 {

/// How a file's numbers become light.
enum class TransferFunction { linear, srgb, other };

/// The base level of a texture file.
struct Texture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;  ///< four bytes a texel, rows from the top; unassociated alpha
  TransferFunction transfer = TransferFunction::other;
  bool is_basis_universal = false;   ///< else texels that were not compressed
  std::vector<std::string> remarks;  ///< what the file asks for that glTF forbids and that is not done
};

/// Whether the bytes begin with KTX2's signature.
bool is_ktx2(std::span<const uint8_t> file);

/// Texels of its base level as its header has it, of whose truth nothing is known; 0 where it is cut off.
uint64_t stated_texels(std::span<const uint8_t> file);

/// Decodes the base level of a KTX2 file that holds one 2D picture: as ETC1S in BasisLZ, as UASTC LDR 4x4, or
/// as plain texels of one to four channels of eight bits, the latter two with or without Zstandard. Basis
/// Universal's texels are those of Binomial's transcoder to RGBA32, bit for bit; where the descriptor says
/// red and green, green is put in its place. Throws Error(input), which names no file, for anything else, for
/// damage, for more than `max_texels` and, beyond 2^24 texels, for more than 4096 of them a byte of the file.
Texture decode(std::span<const uint8_t> file, uint64_t max_texels = uint64_t{1} << 28);

}  // namespace vernier::ktx2
