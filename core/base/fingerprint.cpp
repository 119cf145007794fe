// SPDX-License-Identifier: Apache-2.0
#include "core/base/fingerprint.h"

#include <OpenImageIO/hash.h>
#include <fmt/format.h>

namespace vernier {

std::string fingerprint(std::span<const std::byte> bytes) {
  const auto hash = OIIO::farmhash::Fingerprint128(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return fmt::format("{:016x}{:016x}", OIIO::farmhash::Uint128High64(hash),
                     OIIO::farmhash::Uint128Low64(hash));
}

}  // namespace vernier
