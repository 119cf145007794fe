// SPDX-License-Identifier: Apache-2.0
#include "apps/report/html_page.h"
#include "vernier/version.h"

#include <fmt/format.h>

#include <Imath/half.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/report/web_assets.h"
#include "core/image/image_io.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr int small_picture = 236;  // pixels: narrower ones are enlarged to this

std::string base64(std::span<const unsigned char> bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t present = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < present ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= present ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// JSON that may stand in a <script>: no "<" that could end it. File names need not be UTF-8, which JSON is.
std::string script_json(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

Json to_json(const Curve& curve) {
  Json points = Json::array(), band = Json::array();
  for (size_t i = 0; i < curve.points.size(); ++i) {
    const auto& [x, y] = curve.points[i];
    if (!(x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y))) continue;
    points.push_back({x, y});
    if (!curve.band.empty()) band.push_back(curve.band[i]);
  }
  return {{"name", curve.name}, {"points", points}, {"band", band}, {"guide", curve.is_guide}};
}

Json to_json(const Chart& chart) {
  Json curves = Json::array();
  for (const Curve& curve : chart.curves) curves.push_back(to_json(curve));
  return {{"x", chart.x_label}, {"y", chart.y_label}, {"curves", curves}};
}

std::string picture_tag(const Image8& picture, std::string_view escaped_text,
                        std::string_view attributes = {}) {
  return fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\"{} src=\"data:image/png;base64,{}\">",
                     picture.width, picture.height, escaped_text, attributes,
                     base64(encode_image8("png", picture)));
}

/// Half floats, little-endian, in base64.
std::string base64_halves(const Image& image) {
  std::vector<unsigned char> bytes;
  bytes.reserve(2 * image.values.size());
  for (const float value : image.values) {
    const uint16_t bits = Imath::half(std::clamp(value, -65504.f, 65504.f)).bits();
    bytes.push_back(uint8_t(bits & 255));
    bytes.push_back(uint8_t(bits >> 8));
  }
  return base64(bytes);
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

HtmlPage::HtmlPage(std::string_view title, std::string_view subtitle) : title_(escape_html(title)) {
  body_ = fmt::format("<h1>{}</h1>\n<p class=\"subtitle\">{}</p>\n", title_, escape_html(subtitle));
}

void HtmlPage::section(std::string_view heading) {
  body_ += fmt::format("<h2>{}</h2>\n", escape_html(heading));
}

void HtmlPage::heading(std::string_view text) { body_ += fmt::format("<h3>{}</h3>\n", escape_html(text)); }

void HtmlPage::paragraph(std::string_view text) { body_ += fmt::format("<p>{}</p>\n", escape_html(text)); }

void HtmlPage::verdict(std::string_view text) {
  body_ += fmt::format("<p class=\"verdict\">{}</p>\n", escape_html(text));
}

void HtmlPage::key_figures(const std::vector<std::array<std::string, 2>>& names_and_values) {
  body_ += "<dl class=\"key\">\n";
  for (const auto& [name, value] : names_and_values)
    body_ += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_html(name), escape_html(value));
  body_ += "</dl>\n";
}

void HtmlPage::table(const Table& table) {
  const auto row = [&](const std::vector<std::string>& cells, const char* tag) {
    body_ += "<tr>";
    for (const auto& cell : cells) body_ += fmt::format("<{0}>{1}</{0}>", tag, escape_html(cell));
    body_ += "</tr>\n";
  };
  body_ += "<div class=\"wide\"><table>\n";
  if (!table.columns.empty()) {
    body_ += "<thead>";
    row(table.columns, "th");
    body_ += "</thead>\n";
  }
  body_ += "<tbody>\n";
  for (const auto& cells : table.rows) row(cells, "td");
  body_ += "</tbody></table></div>\n";
}

void HtmlPage::facts(const std::vector<std::array<std::string, 2>>& names_and_values) {
  body_ += "<table class=\"facts\"><tbody>\n";
  for (const auto& [name, value] : names_and_values)
    body_ += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escape_html(name), escape_html(value));
  body_ += "</tbody></table>\n";
}

void HtmlPage::list(const std::vector<std::string>& items) {
  body_ += "<ul>\n";
  for (const auto& item : items) body_ += fmt::format("<li>{}</li>\n", escape_html(item));
  body_ += "</ul>\n";
}

void HtmlPage::command(std::string_view line) { body_ += fmt::format("<pre>{}</pre>\n", escape_html(line)); }

void HtmlPage::figures(const std::vector<Figure>& figures) {
  body_ += "<div class=\"figures\">\n";
  for (const Figure& figure : figures) {
    const std::string caption = escape_html(figure.caption);
    body_ +=
        fmt::format("<figure{}>{}<figcaption>{}</figcaption></figure>\n",
                    figure.pixelated || figure.picture.width < small_picture ? " class=\"pixelated\"" : "",
                    picture_tag(figure.picture, caption), caption);
  }
  body_ += "</div>\n";
}

void HtmlPage::viewer(const Viewer& viewer) {
  const std::string id = fmt::format("pixels-{}", ++viewer_count_);
  body_ += fmt::format("<div class=\"viewer\" data-values=\"{}\">\n", id);
  for (const auto& [name, figure] : viewer.versions) {
    const std::string caption = escape_html(figure.caption);
    body_ += fmt::format("<figure data-name=\"{}\">{}<figcaption>{}</figcaption></figure>\n",
                         escape_html(name), picture_tag(figure.picture, caption), caption);
  }
  body_ += "</div>\n";
  data(id, {{"width", viewer.values.width},
            {"height", viewer.values.height},
            {"scale", viewer.scale},
            {"halves", base64_halves(viewer.values)}});
}

void HtmlPage::cards(const std::vector<Card>& cards) {
  has_cards_ = true;
  body_ += "<div class=\"cards\">\n";
  for (const Card& card : cards) {
    const std::string title = escape_html(card.title);
    body_ += fmt::format("<div class=\"card\"><a href=\"{}\"{}>", escape_html(card.link),
                         card.pictures.size() > 1 ? " class=\"frames\"" : "");
    for (size_t i = 0; i < card.pictures.size(); ++i)
      body_ += picture_tag(card.pictures[i], title, i > 0 ? " hidden" : "");
    body_ += fmt::format("</a><h3>{}</h3>", title);
    for (const auto& line : card.lines) body_ += fmt::format("<p>{}</p>", escape_html(line));
    if (!card.command.empty())
      body_ += fmt::format("<details><summary>command</summary><pre>{}</pre></details>",
                           escape_html(card.command));
    body_ += "</div>\n";
  }
  body_ += "</div>\n";
}

void HtmlPage::charts(const std::vector<Chart>& charts) {
  body_ += "<div class=\"charts\">\n";
  for (const Chart& chart : charts) {
    const int number = ++chart_count_;
    body_ += fmt::format("<div class=\"chart\"><canvas data-chart=\"chart-{}\"></canvas></div>\n", number);
    data(fmt::format("chart-{}", number), to_json(chart));
  }
  body_ += "</div>\n";
}

void HtmlPage::bar(const std::vector<BarPart>& parts) {
  double whole = 0;
  for (const BarPart& part : parts) whole += part.size;
  std::string bar, legend;
  for (const BarPart& part : parts) {
    const double percent = whole > 0 ? 100 * part.size / whole : 0;
    const std::string name = escape_html(part.name);
    bar += fmt::format("<span style=\"width:{:.3f}%\"></span>", percent);
    legend +=
        fmt::format("<span><i></i>{} <b>{}</b> ({:.1f} %)</span>", name, escape_html(part.text), percent);
  }
  body_ += fmt::format("<div class=\"bar\">{}</div>\n<div class=\"legend\">{}</div>\n", bar, legend);
}

void HtmlPage::data(std::string_view id, const Json& json) {
  body_ += fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, script_json(json));
}

std::string HtmlPage::text() const {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"vernier {}\">\n<title>{}</title>\n<style>\n{}</style></head>\n"
      "<body><main>\n{}</main>\n",
      version(), title_, web_assets::page_css, body_);
  const auto program = [&](std::string_view text) { page += fmt::format("<script>\n{}</script>\n", text); };
  if (viewer_count_ > 0) program(web_assets::viewer_js);
  if (has_cards_) program(web_assets::cards_js);
  if (chart_count_ > 0) {
    program(web_assets::chart_js);
    program(web_assets::charts_js);
  }
  return page + "</body></html>\n";
}

}  // namespace vernier::apps
