// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "vernier/image.h"

namespace vernier::apps {

/// A curve of a chart. Points that have no logarithm are not drawn.
struct Curve {
  std::string name;
  std::vector<std::array<double, 2>> points;  ///< x and y
  std::vector<std::array<double, 2>> band;    ///< low and high of each point; may be empty
  bool is_guide = false;                      ///< drawn thin and dashed: something to compare with
};

/// Curves over logarithmic axes, y being a part of one that is shown in percent.
struct Chart {
  std::string x_label, y_label;
  std::vector<Curve> curves;
};

/// One part of a whole, for a stacked bar.
struct BarPart {
  std::string name;
  double size = 0;
  std::string text;  ///< the size as read by people
};

struct Table {
  std::vector<std::string> columns;  ///< headings; empty: none
  std::vector<std::vector<std::string>> rows;
};

/// A picture and what stands below it.
struct Figure {
  Image8 picture;
  std::string caption;
  bool pixelated = false;  ///< enlarged with hard pixel edges
};

/// One picture in several versions of the same proportions, to be compared; and what is known of its pixels.
struct Viewer {
  struct Version {
    std::string name;  ///< a word or two
    Figure figure;
  };
  std::vector<Version> versions;  ///< the first two are shown at first
  Image values;                   ///< red, green, blue, relative standard error (NaN: not known)
  int scale = 1;                  ///< pixels of the picture along the side of one of `values`
};

/// Pictures that belong together, one or the frames of an animation, and what is said of them.
struct Card {
  std::string title, link;  ///< the link is an address relative to the page
  std::vector<Image8> pictures;
  std::vector<std::string> lines;
  std::string command;  ///< folded away; may be empty
};

std::string escape_html(std::string_view text);

/// A page of HTML put together from top to bottom, complete in one file: pictures, style and the program that
/// draws the charts are inside. Every text is escaped.
class HtmlPage {
 public:
  HtmlPage(std::string_view title, std::string_view subtitle);

  void section(std::string_view heading);
  void heading(std::string_view text);  ///< within a section
  void paragraph(std::string_view text);
  /// What a reader in a hurry should know.
  void verdict(std::string_view text);
  /// Figures that matter most, each with its name.
  void key_figures(const std::vector<std::array<std::string, 2>>& names_and_values);
  /// The first column is text and the others are numbers, set to the right.
  void table(const Table& table);
  /// Pairs of name and value.
  void facts(const std::vector<std::array<std::string, 2>>& names_and_values);
  void list(const std::vector<std::string>& items);
  /// What a shell takes.
  void command(std::string_view line);
  /// Side by side as far as there is room.
  void figures(const std::vector<Figure>& figures);
  void viewer(const Viewer& viewer);
  void cards(const std::vector<Card>& cards);
  void charts(const std::vector<Chart>& charts);
  void bar(const std::vector<BarPart>& parts);
  /// Data for programs that read the page, as <script type="application/json" id=...>.
  void data(std::string_view id, const nlohmann::ordered_json& json);

  /// The file's content.
  std::string text() const;

 private:
  std::string title_;
  std::string body_;
  int chart_count_ = 0, viewer_count_ = 0;
  bool has_cards_ = false;
};

}  // namespace vernier::apps
