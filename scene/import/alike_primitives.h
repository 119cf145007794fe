// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "scene/import/tinygltf.h"

namespace vernier {

/// A primitive by the numbers of its mesh and within it.
struct PrimitiveId {
  int mesh = 0, primitive = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 reads what the compiler writes
  auto operator<=>(const PrimitiveId&) const = default;
};

/// Primitives of a file that are the same but for their material. Exporters write a shape anew for each
/// material that it is shown with, by the same accessors, and a thousand copies of it need not be kept.
class AlikePrimitives {
 public:
  AlikePrimitives() = default;
  explicit AlikePrimitives(const tinygltf::Model& model);

  /// The one to read in place of this one: the first like it where that spares much memory. Else itself, as
  /// what is placed once only is met sooner.
  PrimitiveId to_read(const PrimitiveId& id) const;

 private:
  std::map<PrimitiveId, PrimitiveId> first_;  ///< of those that are not themselves the first
};

}  // namespace vernier
