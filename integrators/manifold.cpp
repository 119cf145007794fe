// SPDX-License-Identifier: Apache-2.0
#include "integrators/manifold.h"

#include <cmath>

#include "core/sampling/sampler.h"

namespace vernier {
namespace {

/// Where a chain must end: the lamp's place, or the unit direction to it.
struct Target {
  Vec3d place;
  bool is_at_infinity;

  /// Unit vector, and how far.
  std::pair<Vec3d, double> from(const Vec3d& point) const {
    if (is_at_infinity) return {place, std::numeric_limits<double>::infinity()};
    const double distance = length(place - point);
    return {(place - point) * (1 / distance), distance};
  }
};

/// By what angles a pencil misses its target, in a frame about its direction, and how these change as the
/// chain's first direction is turned.
struct Miss {
  Vec2d by;
  std::array<Vec2d, 2> slopes;

  double size() const { return std::hypot(by.x, by.y); }
  double determinant() const { return slopes[0].x * slopes[1].y - slopes[1].x * slopes[0].y; }
  /// By what angles to turn the first direction, to first order.
  Vec2d step() const {
    const double d = determinant();
    return {(by.x * slopes[1].y - slopes[1].x * by.y) / d, (slopes[0].x * by.y - by.x * slopes[0].y) / d};
  }
};

Miss miss_of(const Pencil& pencil, const Target& target) {
  const auto [to, distance] = target.from(pencil.origin);
  const Tangents frame(pencil.direction);
  const Vec2d across(dot(to, frame.x), dot(to, frame.y));
  const double sine = std::hypot(across.x, across.y);
  const double angle = std::atan2(sine, dot(to, pencil.direction));
  Miss miss;
  miss.by = sine > 0 ? across * (angle / sine) : Vec2d(angle, 0);
  for (size_t j = 0; j < 2; ++j) {
    const Vec3d turn = pencil.d_direction[j] + pencil.d_origin[j] / distance;
    miss.slopes[j] = {dot(turn, frame.x), dot(turn, frame.y)};
  }
  return miss;
}

/// A unit direction turned by these angles about its tangents.
Vec3d turned(const Vec3d& direction, const Vec2d& by) {
  const double angle = std::hypot(by.x, by.y);
  if (!(angle > 0)) return direction;
  const Tangents tangents(direction);
  const Vec3d across = (tangents.x * by.x + tangents.y * by.y) * (1 / angle);
  return normalize(direction * std::cos(angle) + across * std::sin(angle));
}

/// As many numbers as a search takes, which no one knows beforehand.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : state_(seed) {}
  double next() { return mix_bits(state_ += 0x9e3779b97f4a7c15ull) * 0x1p-32; }
  Vec2d next2() {
    const double x = next();
    return {x, next()};
  }

 private:
  uint64_t state_;
};

/// Of first directions: toward the lamp or about, where most light that is bent comes from; to where the lamp
/// shines on surfaces that bend its light; the rest as the receiver scatters.
constexpr double toward_lamp = 0.4, toward_bent = 0.4;
/// Angles about the lamp are spread evenly over their logarithm from here up.
constexpr double least_angle = 1e-3;
/// A chain that ends by so small an angle beside its lamp is as good as one that meets it, in double.
constexpr double close_enough = 1e-10;
/// Newton's steps converge within a few or not at all.
constexpr int most_steps = 24, most_halvings = 6;
constexpr double longest_step = 0.5, most_growth = 3;
/// First directions of the same chain differ by rounding alone.
constexpr double same_direction = 1e-6;
/// Turns a ray by some of its last digits, by which coverage is drawn anew.
constexpr double nudge = 4e-7;
/// Chains that are found more seldom than by one of so many trials are told as missing.
constexpr uint32_t most_trials = 1 << 14;
/// Least share of the chains found that are looked for again, however little they carry.
constexpr float least_share = 1 / 64.f;

}  // namespace

/// Chains from one receiver to one lamp.
class SpecularChains::Search {
 public:
  Search(const SpecularChains& chains, const Receiver& receiver, size_t lamp, const Rgb& carried,
         RayCounts& rays)
      : chains_(chains), receiver_(receiver), lamp_(lamp), carried_(carried), rays_(rays) {
    const PunctualLight::Place place = chains.lamps_[lamp]->place_at(receiver.at.time);
    const bool is_at_infinity = chains.lamps_[lamp]->is_at_infinity();
    target_ = {Vec3d(is_at_infinity ? -place.direction : place.position), is_at_infinity};
  }

  /// A chain that meets the lamp, if nothing stands between.
  struct Found {
    Vec3d direction;  ///< that it begins with
    ChainEvents events;
    double determinant;  ///< Miss::determinant()

    /// Between two chains that differ by less lies one where light is focused on the receiver, and across it
    /// the determinant changes its sign.
    bool operator==(const Found& other) const {
      return events == other.events && determinant * other.determinant > 0 &&
             length(direction - other.direction) < same_direction;
    }
  };
  std::optional<Found> attempt(Numbers& numbers) const {
    const auto direction = first_direction(numbers);
    if (!direction || is_black(receiver_.surface.eval(Vec3f(*direction)).f_cos)) return std::nullopt;
    const auto events = random_events(*direction, numbers);
    return events ? converge(*direction, *events) : std::nullopt;
  }

  /// What arrives by a chain toward the viewer, black if something stands between, and `arrival` but for its
  /// light.
  Rgb carried_by(const Found& found, Arrival& arrival) const;

 private:
  std::optional<Vec3d> first_direction(Numbers& numbers) const;
  std::optional<ChainEvents> random_events(const Vec3d& direction, Numbers& numbers) const;
  std::optional<SpecularChain> follow(const Vec3d& direction, const ChainEvents& events) const;
  std::optional<Found> converge(Vec3d direction, const ChainEvents& events) const;
  /// Whether a chain may end at the lamp as far as what lies around its end tells.
  bool may_end(const SpecularChain& chain) const {
    return !chain.is_straight() &&
           (chain.media().empty() || !chains_.lamps_are_in_air_ || !bends(chain.media()));
  }
  bool bends(const MediumStack& media) const {
    return chains_.scene_.volumes().medium(media).ior != Rgb(1, 1, 1);
  }

  const SpecularChains& chains_;
  const Receiver& receiver_;
  const size_t lamp_;
  const Rgb carried_;
  RayCounts& rays_;
  Target target_;
};

std::optional<Vec3d> SpecularChains::Search::first_direction(Numbers& numbers) const {
  const double way = numbers.next();
  const Vec2d u = numbers.next2();
  const Vec3d origin(receiver_.at.position);
  if (way < toward_lamp) {
    const double angle = least_angle * std::pow(std::numbers::pi / least_angle, u.x);
    const double azimuth = 2 * std::numbers::pi * u.y;
    return turned(target_.from(origin).first, Vec2d(std::cos(azimuth), std::sin(azimuth)) * angle);
  }
  if (way < toward_lamp + toward_bent) {
    const auto shining = chains_.emission_->shine(lamp_, u, {0, 0}, receiver_.at.time);
    if (!shining) return std::nullopt;
    ++rays_.bounce;
    const auto lit = chains_.scene_.intersect(shining->ray);
    if (!lit) return std::nullopt;
    const Vec3d to = Vec3d(lit->position) - origin;
    if (!(length_squared(to) > 0)) return std::nullopt;
    return normalize(to);
  }
  const auto scattered = receiver_.surface.sample(float(numbers.next()), Vec2f(u));
  if (!scattered) return std::nullopt;
  return normalize(Vec3d(scattered->wi));
}

/// What happens to a chain that goes on by chance, as its surfaces share out the light.
std::optional<ChainEvents> SpecularChains::Search::random_events(const Vec3d& direction,
                                                                 Numbers& numbers) const {
  SpecularChain chain(chains_.scene_, receiver_.at, direction, carried_);
  ChainEvents events;
  ++rays_.bounce;
  bool goes_on = chain.meet();
  while (goes_on) {
    const float reflected = max_component(chain.lobes().reflected),
                transmitted = max_component(chain.lobes().transmitted) * square(chain.lobes().eta);
    const bool is_transmitted = float(numbers.next()) * (reflected + transmitted) >= reflected;
    if (events.is_full() || !chain.turn(is_transmitted)) return std::nullopt;
    events.add(is_transmitted);
    ++rays_.bounce;
    goes_on = chain.meet();
    if (may_end(chain) && (!goes_on || numbers.next() < 0.5)) return events;
  }
  return std::nullopt;
}

std::optional<SpecularChain> SpecularChains::Search::follow(const Vec3d& direction,
                                                            const ChainEvents& events) const {
  SpecularChain chain(chains_.scene_, receiver_.at, direction, carried_);
  for (int i = 0; i < events.size(); ++i) {
    ++rays_.bounce;
    if (!chain.meet() || !chain.turn(events.is_transmitted(i))) return std::nullopt;
  }
  if (chain.is_straight()) return std::nullopt;
  return chain;
}

/// Newton's method on the first direction alone: all other surfaces are met as a ray meets them, so that what
/// converges is a path of light. A step that leads nowhere, or far away, is halved; to ask for nearer ones
/// would hold it up at the edges of triangles, where slopes jump.
std::optional<SpecularChains::Search::Found> SpecularChains::Search::converge(
    Vec3d direction, const ChainEvents& events) const {
  const auto chain = follow(direction, events);
  if (!chain) return std::nullopt;
  Miss miss = miss_of(chain->pencil(), target_);
  for (int step = 0; step < most_steps; ++step) {
    if (miss.size() < close_enough) return Found{direction, events, miss.determinant()};
    Vec2d turn = miss.step();
    const double size = std::hypot(turn.x, turn.y);
    if (!std::isfinite(size)) return std::nullopt;
    if (size > longest_step) turn *= longest_step / size;
    bool is_taken = false;
    for (int halving = 0; !is_taken && halving < most_halvings; ++halving, turn *= 0.5) {
      const Vec3d next = turned(direction, turn);
      const auto changed = follow(next, events);
      if (!changed) continue;
      const Miss next_miss = miss_of(changed->pencil(), target_);
      if (!(next_miss.size() < most_growth * miss.size())) continue;
      is_taken = true;
      direction = next;
      miss = next_miss;
    }
    if (!is_taken) return std::nullopt;
  }
  return std::nullopt;
}

/// The solid angle under which the receiver sees a small lamp through the chain is that which the chain's end
/// sees it under, over the determinant (the generalized geometry term: Zeltner et al. 2020, eq. 5).
Rgb SpecularChains::Search::carried_by(const Found& found, Arrival& arrival) const {
  arrival.wi = Vec3f(found.direction);
  const Rgb scattered = receiver_.surface.eval(arrival.wi).f_cos;
  if (is_black(scattered)) return {0, 0, 0};
  // Where something covers a surface in part, what gets through is told by rays that are not those that have
  // found the chain.
  const auto chain = follow(turned(found.direction, {nudge, nudge}), found.events);
  if (!chain) return {0, 0, 0};
  const auto lamp = chains_.lamps_[lamp_]->sample(chain->at(), {0, 0});
  if (!lamp) return {0, 0, 0};
  ++rays_.shadow;
  const Passage passage = transmittance(chains_.scene_, chain->at().spawn_to(*lamp));
  if (passage.is_bent) return {0, 0, 0};
  arrival.surfaces = found.events.size() + passage.surfaces;
  arrival.source = chains_.lamps_[lamp_]->source();
  return receiver_.throughput * scattered * carried_ * chain->weight() * passage.fraction * lamp->radiance *
         float(1 / std::abs(found.determinant));
}

SpecularChains::SpecularChains(const Scene& scene, std::shared_ptr<const LightEmission> emission)
    : scene_(scene), emission_(std::move(emission)) {
  for (const Light* light : scene.lights().delta_lights()) {
    const auto* lamp = dynamic_cast<const PunctualLight*>(light);
    lamps_.push_back(lamp);
    const auto bounds = lamp->bounds();
    const bool is_in_air = !bounds || (bounds->box.lower == bounds->box.upper &&
                                       !scene.volumes().may_contain(bounds->box.lower));
    lamps_are_in_air_ = lamps_are_in_air_ && is_in_air;
  }
  for (uint32_t i = 0; i < scene.geometry().instance_count(); ++i) {
    SurfacePoint point;
    point.instance = i;
    const Rgb ior = scene.material(point).interior_ior();
    disperses_ = disperses_ || ior.x != ior.y || ior.z != ior.y;
  }
}

std::optional<SpecularChains::Arrival> SpecularChains::sample(const Receiver& receiver, uint64_t seed,
                                                              RayCounts& rays) const {
  if (emission_->empty()) return std::nullopt;
  Numbers numbers(seed);
  const auto [lamp, prob] = emission_->choose(numbers.next());
  Rgb carried(1 / prob);
  if (disperses_) {
    const int channel = int(3 * numbers.next());
    carried = Rgb(0, 0, 0);
    carried[channel] = 3 / prob;
  }
  const Search search(*this, receiver, lamp, carried, rays);
  const auto found = search.attempt(numbers);
  if (!found) return std::nullopt;
  Arrival arrival;
  const Rgb radiance = search.carried_by(*found, arrival);
  if (is_black(radiance) || !is_finite(radiance)) return std::nullopt;
  const float survival =
      receiver.spread > 0 ? std::clamp(4 * max_component(radiance) / receiver.spread, least_share, 1.f) : 1;
  if (float(numbers.next()) >= survival) return std::nullopt;
  for (uint32_t trials = 1; trials <= most_trials; ++trials) {
    if (const auto again = search.attempt(numbers); !again || !(*again == *found)) continue;
    arrival.radiance = radiance * (float(trials) / survival);
    arrival.rest = Rgb(0, 0, 0);
    return arrival;
  }
  // Of a probability that so many trials do not tell, as many again are the least to expect.
  arrival.radiance = arrival.rest = radiance * (float(most_trials) / survival);
  return arrival;
}

}  // namespace vernier
