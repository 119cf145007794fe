// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "scene/import/asset_files.h"

namespace vernier {

bool is_data_uri(std::string_view uri);

/// RFC 3986, 2.1; a percent sign without two digits stands for itself.
std::string percent_decoded(std::string_view text);

/// Decodes a data URI as browsers do (WHATWG, "Fetch Standard", 6, and "Infra Standard", forgiving-base64):
/// any case, any or no media type, percent-encoding in base64 too, white space in it, with or without its
/// padding. Returns what is wrong, or an empty string.
std::string decode_data_uri(std::string_view uri, Bytes& bytes);

}  // namespace vernier
