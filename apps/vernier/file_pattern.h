// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vernier::apps {

/// What stands for something else in the name of a file to be written.
enum class Placeholder { name, camera, variant, frame };

/// "{frame}", as it is typed.
std::string text_of(Placeholder placeholder);

/// What tells a picture from the others of a run.
struct PictureName {
  std::string name;  ///< of the scene's file, without folder and extension
  std::string camera, variant;
  std::optional<int> frame;
};

/// The name of a file, in which {name}, {camera}, {variant} and {frame} stand for what a picture is of, and
/// #### for the frame with as many digits. {frame} has four.
class FilePattern {
 public:
  /// Throws Error(usage) on another {word}, and on %04d, which other programs take.
  explicit FilePattern(const std::string& text);

  const std::string& text() const { return text_; }
  bool has(Placeholder placeholder) const;
  /// Whether a folder is called after what the picture is of, so that it cannot be there beforehand.
  bool names_folder() const;
  /// The name for one picture; what would be a path of its own or hidden is replaced in its parts.
  std::string fill(const PictureName& picture) const;

 private:
  struct Part {
    std::string literal;
    std::optional<Placeholder> placeholder;  ///< in place of the literal
    size_t digits = 4;
  };
  size_t add_braces(size_t begin);
  size_t add_frame(size_t begin);
  void refuse_printf(size_t begin) const;

  std::string text_;
  std::vector<Part> parts_;
};

/// The name of a scene's file without folder and extension; "stdin" for standard input.
std::string stem_of(const std::string& scene);

}  // namespace vernier::apps
