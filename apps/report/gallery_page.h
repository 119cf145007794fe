// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/report/html_page.h"

namespace vernier::apps {

/// What the header of a picture tells of it, for the lines of a card: error, samples, what is missing; those
/// of pictures of other programs are few.
std::vector<std::string> picture_lines(const Metadata& metadata);

/// A page of cards.
std::string gallery_page(const std::string& title, const std::vector<Card>& cards);

}  // namespace vernier::apps
