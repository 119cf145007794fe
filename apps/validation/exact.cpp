// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/exact.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <limits>

namespace vernier::validation {
namespace {

using Rational = boost::multiprecision::cpp_rational;

template <typename N>
struct Vec {
  N x, y, z;
};

template <typename N>
Vec<N> difference(const Vec3f& a, const Vec3f& b) {
  return {N(a.x) - N(b.x), N(a.y) - N(b.y), N(a.z) - N(b.z)};
}

template <typename N>
N triple(const Vec<N>& a, const Vec<N>& b, const Vec<N>& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

/// The same with all terms positive: what rounding errors are relative to.
double triple_magnitude(const Vec<double>& a, const Vec<double>& b, const Vec<double>& c) {
  const auto abs = [](const Vec<double>& v) {
    return Vec<double>{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
  };
  const Vec<double> p = abs(a), q = abs(b), r = abs(c);
  return p.x * (q.y * r.z + q.z * r.y) + p.y * (q.z * r.x + q.x * r.z) + p.z * (q.x * r.y + q.y * r.x);
}

/// Cramer's rule for o + t d = v0 + u e1 + v e2.
template <typename N>
struct Cramer {
  Vec<N> d, s, e1, e2;
  N det, t, u, v;  ///< t, u and v still times det

  Cramer(const Ray& ray, const Corners& c)
      : d(difference<N>(ray.direction, {0, 0, 0})),
        s(difference<N>(ray.origin, c[0])),
        e1(difference<N>(c[1], c[0])),
        e2(difference<N>(c[2], c[0])),
        det(triple(e1, d, e2)),
        t(triple(e2, s, e1)),
        u(triple(s, d, e2)),
        v(triple(d, s, e1)) {}
};

template <typename N>
int sign(const N& x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

ExactHit::Kind classify(int det, int u, int v, int w) {
  if (det == 0) return ExactHit::Kind::coplanar;
  if (u * det < 0 || v * det < 0 || w * det < 0) return ExactHit::Kind::miss;
  return u && v && w ? ExactHit::Kind::hit : ExactHit::Kind::boundary;
}

}  // namespace

ExactHit intersect_exactly(const Ray& ray, const Corners& corners) {
  const Cramer<double> c(ray, corners);
  const double det_terms = triple_magnitude(c.e1, c.d, c.e2), t_terms = triple_magnitude(c.e2, c.s, c.e1);
  const double u_terms = triple_magnitude(c.s, c.d, c.e2), v_terms = triple_magnitude(c.d, c.s, c.e1);
  const double w = c.det - c.u - c.v, w_terms = det_terms + u_terms + v_terms;

  ExactHit hit;
  // Ten roundings bound each product of three differences; where a sign or a few digits are in doubt, be
  // exact.
  constexpr double error = 16 * std::numeric_limits<double>::epsilon();
  const auto sure = [&](double x, double terms) { return std::abs(x) > error * terms; };
  const bool well_conditioned = std::abs(c.det) > 1e-5 * det_terms && std::isfinite(w_terms);
  if (well_conditioned && sure(c.u, u_terms) && sure(c.v, v_terms) && sure(w, w_terms)) {
    hit.kind = classify(sign(c.det), sign(c.u), sign(c.v), sign(w));
    hit.t = c.t / c.det;
    hit.u = c.u / c.det;
    hit.v = c.v / c.det;
  } else {
    const Cramer<Rational> r(ray, corners);
    hit.kind = classify(sign(r.det), sign(r.u), sign(r.v), sign(Rational(r.det - r.u - r.v)));
    if (hit.kind == ExactHit::Kind::coplanar) return hit;
    hit.t = Rational(r.t / r.det).convert_to<double>();
    hit.u = Rational(r.u / r.det).convert_to<double>();
    hit.v = Rational(r.v / r.det).convert_to<double>();
  }
  constexpr double eps = std::numeric_limits<float>::epsilon();
  const double det = std::abs(c.det);
  hit.t_bound = 8 * eps * (t_terms + std::abs(hit.t) * det_terms) / det;
  hit.u_bound = 8 * eps * (u_terms + std::abs(hit.u) * det_terms) / det;
  hit.v_bound = 8 * eps * (v_terms + std::abs(hit.v) * det_terms) / det;
  return hit;
}

double distance_to_boundary(const Ray& ray, const Corners& corners) {
  const Vec3d o(ray.origin), d = Vec3d(ray.direction) / length(Vec3d(ray.direction));
  const auto across = [&](const Vec3d& p) { return p - o - d * dot(p - o, d); };  // from the line to p
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    // Seen along the line: distance of the point zero from the segment a b.
    const Vec3d a = across(Vec3d(corners[i])), b = across(Vec3d(corners[(i + 1) % 3])), ab = b - a;
    const double along =
        length_squared(ab) > 0 ? std::clamp(-dot(a, ab) / length_squared(ab), 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, length(a + ab * along));
  }
  return nearest;
}

double coordinate_ulp(const Ray& ray, const Corners& corners) {
  float largest = max_component(abs(ray.origin));
  for (const Vec3f& corner : corners) largest = std::max(largest, max_component(abs(corner)));
  return double(std::nextafter(largest, std::numeric_limits<float>::infinity())) - largest;
}

bool is_near_boundary(const Ray& ray, const Corners& corners) {
  return distance_to_boundary(ray, corners) <= 4 * coordinate_ulp(ray, corners);
}

}  // namespace vernier::validation
