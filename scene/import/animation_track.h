// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "scene/import/document.h"

namespace vernier {

/// How values between two keys are found where the sampler says LINEAR: quaternions on the sphere, truth
/// values not at all.
enum class Blend { linear, spherical, step };

/// When the latest key of a sampler is, in seconds. Throws Error(input).
double latest_key(const Document& document, const tinygltf::AnimationSampler& sampler);

/// One animated value over time (glTF 2.0, appendix C).
class Track {
 public:
  /// `place` is the JSON pointer of the sampler. Throws Error(input).
  Track(const Document& document, const tinygltf::AnimationSampler& sampler, std::string place);

  double first_time() const { return double(times_.front()); }
  double last_time() const { return double(times_.back()); }

  /// Whether keys share a time, which glTF forbids: the value then jumps from the first to the last of them.
  bool has_equal_times() const { return std::adjacent_find(times_.begin(), times_.end()) != times_.end(); }

  /// The value at a time; before the first key and after the last those hold. Throws Error(input) unless it
  /// is finite.
  std::vector<double> at(double time, Blend blend) const;

  /// Throws Error(input) unless a key has `width` values.
  void expect_width(size_t width) const;

 private:
  /// The value of key i; in cubic tracks part 0 is the in-tangent, 2 the out-tangent.
  std::vector<double> key(size_t i, size_t part = 1) const;
  std::vector<double> interpolate(double time, Blend blend) const;
  std::vector<double> hermite(size_t i, double t, double duration) const;

  const Document& document_;
  std::string place_;
  std::vector<float> times_, values_;
  bool cubic_, step_;
  size_t width_ = 0;
};

}  // namespace vernier
