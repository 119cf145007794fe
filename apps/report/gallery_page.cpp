// SPDX-License-Identifier: Apache-2.0
#include "apps/report/gallery_page.h"

#include <fmt/format.h>

#include <charconv>

#include "vernier/version.h"

namespace vernier::apps {
namespace {

/// Numbers of a header's text, as many as there are.
std::vector<double> numbers(const Metadata& metadata, const std::string& name) {
  std::vector<double> values;
  const auto found = metadata.find(name);
  if (found == metadata.end()) return values;
  const char* at = found->second.data();
  const char* const end = at + found->second.size();
  for (double value = 0; at < end; ++at) {
    const auto [next, problem] = std::from_chars(at, end, value);
    if (problem != std::errc()) break;
    values.push_back(value);
    at = next;
  }
  return values;
}

/// "error 2.3 % (2.1 to 2.6 %)", or nothing.
std::string error_text(const Metadata& metadata, const std::string& name) {
  const auto error = numbers(metadata, name), interval = numbers(metadata, name + "95");
  if (error.empty()) return {};
  std::string text = fmt::format("error {:.2g} %", 100 * error[0]);
  if (interval.size() == 2)
    text += fmt::format(" ({:.2g} to {:.2g} %)", 100 * interval[0], 100 * interval[1]);
  return text;
}

}  // namespace

std::vector<std::string> picture_lines(const Metadata& metadata) {
  std::vector<std::string> lines;
  const std::string denoised = error_text(metadata, "vernier:denoisedRelRmse");
  const std::string rendered = error_text(metadata, "vernier:relRmse");
  if (!denoised.empty()) lines.push_back("denoised: " + denoised);
  if (!rendered.empty()) lines.push_back(denoised.empty() ? rendered : "as rendered: " + rendered);
  if (const auto samples = numbers(metadata, "vernier:samplesPerPixel"); !samples.empty())
    lines.push_back(fmt::format("{:.4g} samples a pixel", samples[0]));
  constexpr double least_told = 1e-3;
  if (const auto bent = numbers(metadata, "vernier:missingBentLight"); !bent.empty() && bent[0] >= least_told)
    lines.push_back(
        fmt::format("up to {:.2g} % of all light, behind bending glass, is missing", 100 * bent[0]));
  return lines;
}

std::string gallery_page(const std::string& title, const std::vector<Card>& cards) {
  HtmlPage page(title,
                fmt::format("vernier {}; errors are relative RMSE with their 95 % intervals", version()));
  page.cards(cards);
  return page.text();
}

}  // namespace vernier::apps
