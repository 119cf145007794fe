// SPDX-License-Identifier: Apache-2.0
#include "scene/import/meshopt.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <string_view>

namespace vernier {
namespace {

// Each compressed byte stands for at most this many: 16 equal values of a channel take two bits (vertex codec
// 0), and whole blocks of 256 two bits in codec 1. More is damage, found before memory is asked for.
constexpr size_t max_expansion = 2048;

template <typename Names>
bool is_one_of(const std::string& name, const Names& names) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

constexpr std::string_view modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::string_view filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};

/// What is wrong with the parameters; the decoder relies on them.
std::string problem_with(const MeshoptView& view) {
  const bool attributes = view.mode == "ATTRIBUTES";
  if (!is_one_of(view.mode, modes))
    return fmt::format("mode {} is not supported, only {}", view.mode, fmt::join(modes, ", "));
  if (!is_one_of(view.filter, filters))
    return fmt::format("filter {} is not supported, only {}; compress the file without it", view.filter,
                       fmt::join(filters, ", "));
  if (attributes && (view.stride % 4 != 0 || view.stride > 256))
    return "byteStride must be a multiple of 4 up to 256";
  if (!attributes && view.stride != 2 && view.stride != 4) return "byteStride of indices must be 2 or 4";
  if (view.mode == "TRIANGLES" && view.count % 3 != 0)
    return "the count of a triangle list must be a multiple of 3";
  if (view.filter == "OCTAHEDRAL" && view.stride != 4 && view.stride != 8)
    return "the OCTAHEDRAL filter needs a byteStride of 4 or 8";
  if (view.filter == "QUATERNION" && view.stride != 8) return "the QUATERNION filter needs a byteStride of 8";
  if (!attributes && view.filter != "NONE") return "filters apply to attributes only";
  if (view.count > (view.compressed.size() + 256) * max_expansion / view.stride)
    return fmt::format("{} elements cannot come out of {} bytes", view.count, view.compressed.size());
  return {};
}

}  // namespace

std::string decode_meshopt(const MeshoptView& view, Bytes& decoded) {
  if (auto problem = problem_with(view); !problem.empty()) return problem;
  decoded = Bytes(view.count * view.stride);
  const unsigned char* from = view.compressed.data();
  const size_t size = view.compressed.size();
  int error = 0;
  if (view.mode == "ATTRIBUTES")
    error = meshopt_decodeVertexBuffer(decoded.data.get(), view.count, view.stride, from, size);
  else if (view.mode == "TRIANGLES")
    error = meshopt_decodeIndexBuffer(decoded.data.get(), view.count, view.stride, from, size);
  else
    error = meshopt_decodeIndexSequence(decoded.data.get(), view.count, view.stride, from, size);
  // The high half of the first byte tells vertex data, the low half the version of its codec.
  if (error != 0 && view.mode == "ATTRIBUTES" && from[0] > 0xa0 && from[0] <= 0xaf)
    return fmt::format(
        "the data is of vertex codec {}, which the meshoptimizer that Vernier was built with "
        "({}.{}) cannot decode or which is damaged",
        from[0] & 0xf, MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100);
  if (error != 0) return "the compressed data is damaged";
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded.data.get(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(decoded.data.get(), view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded.data.get(), view.count, view.stride);
  return {};
}

}  // namespace vernier
