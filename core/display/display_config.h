// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vernier {

/// An OpenColorIO config, its default display, and how Vernier's pictures enter it.
class DisplayConfig {
 public:
  /// The config of that file; empty: of $OCIO, else Vernier's own. Throws Error(input).
  explicit DisplayConfig(const std::string& file);

  /// Views of the default display, the default first; at least one.
  const std::vector<std::string>& views() const { return views_; }
  bool built_in() const { return built_in_; }

  /// Turns RGB triples of linear Rec.709 into display values in place; callable from many threads.
  using Transform = std::function<void(std::span<float> rgb)>;
  /// `view` is one of views(). Throws Error(input).
  Transform transform(const std::string& view) const;

 private:
  struct Wrapped;
  std::shared_ptr<const Wrapped> wrapped_;
  std::vector<std::string> views_;
  std::string name_;
  bool built_in_ = false;
};

}  // namespace vernier
