// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "apps/report/gallery_page.h"
#include "apps/report/page_parts.h"
#include "apps/vernier/commands.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "core/base/atomic_file.h"
#include "core/image/image_io.h"
#include "integrators/render/picture.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

namespace fs = std::filesystem;

struct GalleryFlags {
  std::vector<std::string> pictures;
  std::string output, title = "Gallery";
  int size = 640;
  DisplayOptions display;
  bool quiet = false;
};

/// Of a file of a sequence, its path with the number taken out, "out/turn.#.png": the last digits of its
/// name, three or more. Otherwise the path itself.
std::string sequence_of(const std::string& path) {
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const size_t name = path.find_last_of('/') + 1;  // 0 where there is no folder
  const auto last = std::find_if(path.rbegin(), path.rend() - std::ptrdiff_t(name), is_digit);
  const auto before = std::find_if_not(last, path.rend() - std::ptrdiff_t(name), is_digit);
  if (before - last < 3) return path;
  return std::string(path.begin(), before.base()) + "#" + std::string(last.base(), path.end());
}

/// A path as an address in a page: all but letters, digits and a few marks as %XX (RFC 3986, 2.1).
std::string address_of(const fs::path& path) {
  std::string address;
  for (const unsigned char c : path.generic_string())
    if (std::isalnum(c) || std::string_view("-._~/").find(char(c)) != std::string_view::npos)
      address += char(c);
    else
      address += fmt::format("%{:02X}", c);
  return address;
}

/// From values for display.
Image8 to_bytes(const Image& picture) {
  Image8 bytes(picture.width, picture.height, picture.channels);
  std::transform(picture.values.begin(), picture.values.end(), bytes.values.begin(),
                 [](float v) { return uint8_t(std::lround(255 * std::clamp(v, 0.f, 1.f))); });
  return bytes;
}

/// The picture as it is displayed, no longer than asked. Values for display are averaged as they are.
Image8 thumbnail(const LayeredImage& picture, const GalleryFlags& flags) {
  const Image color = color_and_alpha(picture).image;
  const Image small = shrink(color, flags.size);
  return picture.linear ? to_display(small, flags.display) : to_bytes(small);
}

/// One card a picture, or a sequence of them.
std::vector<Card> read_cards(const GalleryFlags& flags) {
  const fs::path folder = fs::absolute(flags.output).parent_path();
  std::vector<Card> cards;
  std::string sequence;
  for (const auto& path : flags.pictures) {
    const LayeredImage picture = read_layers(path);
    if (cards.empty() || sequence_of(path) != sequence) {
      sequence = sequence_of(path);
      const Metadata texts = read_image_texts(path).value_or(Metadata());
      const auto command = texts.find("vernier:command");
      cards.push_back({fs::path(sequence).stem().string(),
                       address_of(fs::absolute(path).lexically_proximate(folder)),
                       {},
                       picture_lines(texts),
                       command == texts.end() ? "" : command->second});
    }
    cards.back().pictures.push_back(thumbnail(picture, flags));
  }
  for (Card& card : cards)
    if (const size_t frames = card.pictures.size(); frames > 1)
      card.lines.insert(card.lines.begin(), fmt::format("{} frames; of the first:", frames));
  return cards;
}

ExitCode run_gallery(const GalleryFlags& flags) {
  if (print_requested_views(flags.display)) return ExitCode::done;
  if (flags.pictures.empty())
    throw Error(ErrorKind::usage, "missing PICTURE (.png, .jpg, .exr); see vernier gallery --help");
  if (flags.output.empty()) throw Error(ErrorKind::usage, "missing -o FILE.html; see vernier gallery --help");
  require_separate_files(flags.pictures, {flags.output});
  check_writable(flags.output);
  GalleryFlags chosen = flags;
  chosen.display = with_chosen_view(flags.display);
  const std::vector<Card> cards = read_cards(chosen);
  write_file(flags.output, gallery_page(flags.title, cards));
  if (!flags.quiet)
    fmt::print("{}\n", one_line(fmt::format("wrote {}: {} pictures on {} cards", flags.output,
                                            flags.pictures.size(), cards.size())));
  return ExitCode::done;
}

}  // namespace

void register_gallery(Program& program) {
  CLI::App* command =
      program.app.add_subcommand("gallery", "Make a page of pictures with their errors and commands");
  auto flags = std::make_shared<GalleryFlags>();
  command
      ->add_option(
          "PICTURE", flags->pictures,
          "pictures in their order; those whose names differ in a number of three or more digits are "
          "frames of one animation")
      ->type_name("");
  command
      ->add_option("-o,--output", flags->output,
                   "the page: one file with small pictures that link to the large")
      ->type_name("FILE.html");
  command->add_option("--title", flags->title, "heading of the page")
      ->capture_default_str()
      ->type_name("TEXT");
  command->add_option("--size", flags->size, "longest side of the small pictures, in pixels")
      ->capture_default_str()
      ->check(CLI::Range(16, 4096))
      ->type_name("N");
  add_display_flags(*command, flags->display);
  command->add_flag("-q,--quiet", flags->quiet, "say nothing but errors");
  command->footer("Example: vernier gallery out/*.png -o out/index.html --title \"Today's renders\"");
  command->callback([&program, flags] { program.run = [flags] { return run_gallery(*flags); }; });
}

}  // namespace vernier::apps
