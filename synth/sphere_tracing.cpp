// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rays by stepping along a distance field: march to a bracket, then refine it to rounding.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "synth/shape_rays.h"

namespace scan::synth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// The field along the ray, of positive sign where the ray starts.
class Profile {
 public:
  struct Sample {
    double t;
    double value_m;
    double slope;  // of the value along the ray
  };

  Profile(const Shape& shape, const Ray& ray) : shape_(shape), ray_(ray) {}

  Sample operator()(double t) const {
    const DistanceField f = field(shape_, ray_.origin + t * ray_.direction);
    return {t, sign_ * f.value_m, sign_ * f.gradient.dot(ray_.direction)};
  }

  // Chooses the sign at the start; on the surface itself the side that the ray runs into.
  void orient(double t, double tolerance_m) {
    const Sample start = (*this)(t);
    const double side = std::abs(start.value_m) > tolerance_m ? start.value_m : start.slope;
    if (side < 0) sign_ = -sign_;
  }

 private:
  const Shape& shape_;
  const Ray& ray_;
  double sign_ = 1;
};

struct Bracket {
  Profile::Sample before;  // value > 0
  Profile::Sample after;   // value <= 0
};

// Between two samples above the surface that fall first and rise then: is there a dip below it? The
// lowest place is found by bisection of the slope's sign.
std::optional<Bracket> dip_between(const Profile& profile, Profile::Sample falling,
                                   Profile::Sample rising) {
  const Profile::Sample before = falling;
  while (true) {
    const double t = std::midpoint(falling.t, rising.t);
    if (t <= falling.t || t >= rising.t) return std::nullopt;
    const Profile::Sample middle = profile(t);
    if (middle.value_m <= 0) return Bracket{before, middle};
    // both sides are 1-Lipschitz: too high to reach zero in what is left
    if (middle.value_m > rising.t - falling.t) return std::nullopt;
    (middle.slope < 0 ? falling : rising) = middle;
  }
}

// Steps by the field, which never passes the surface, but at least by `stride_m`; what a stride
// could step over has a minimum inside it.
std::optional<Bracket> march(const Profile& profile, const Interval& span, double stride_m) {
  Profile::Sample here = profile(span.enter_m);
  while (here.t < span.leave_m) {
    const double step = std::max(here.value_m, stride_m);
    const Profile::Sample next = profile(std::min(here.t + step, span.leave_m));
    // a start on the surface may have rounded to the wrong side of it
    if (next.value_m <= 0 && here.value_m > 0) return Bracket{here, next};
    if (step > here.value_m && here.value_m > 0 && here.slope < 0 && next.slope > 0)
      if (const auto dip = dip_between(profile, here, next)) return dip;
    if (next.t <= here.t) break;
    here = next;
  }
  return std::nullopt;
}

// Newton's steps kept inside the bracket by bisection, until the bracket is as narrow as doubles
// go.
Profile::Sample refine(const Profile& profile, Bracket bracket) {
  while (true) {
    auto& [before, after] = bracket;
    const double width = after.t - before.t;
    const Profile::Sample& best = before.value_m < -after.value_m ? before : after;
    const double newton = best.t - best.value_m / best.slope;
    // aimed a little across the root, so that the far end of the bracket follows
    const double aim = newton + (&best == &before ? 1 : -1) * 2 * epsilon * std::abs(newton);
    const bool inside = aim > before.t && aim < after.t;
    const double t = inside ? aim : std::midpoint(before.t, after.t);
    if (!(t > before.t && t < after.t)) return best;
    const Profile::Sample middle = profile(t);
    if (middle.value_m == 0) return middle;
    (middle.value_m > 0 ? before : after) = middle;
    if (!(after.t - before.t <= width / 2)) {
      const double half = std::midpoint(before.t, after.t);
      if (!(half > before.t && half < after.t)) return before;
      const Profile::Sample halved = profile(half);
      (halved.value_m > 0 ? before : after) = halved;
    }
  }
}

}  // namespace

std::optional<ShapeHit> trace_field(const Shape& shape, const Bounds& bounds, const Ray& ray) {
  const bool finite = bounds.min().allFinite() && bounds.max().allFinite();
  const double size_m = finite ? bounds.diagonal().norm() : std::max(1.0, ray.origin.norm());
  const double rounding_m = 64 * epsilon * (ray.origin.norm() + size_m);
  Ray ahead = ray;
  ahead.min_m = std::max(ray.min_m, rounding_m);
  // an unbounded combination is looked at as far as a thousand times its distance
  if (!finite) ahead.max_m = std::min(ray.max_m, 1e3 * (size_m + ray.origin.norm()));
  const Bounds padded(bounds.min() - Eigen::Vector3d::Constant(1e-6 * size_m),
                      bounds.max() + Eigen::Vector3d::Constant(1e-6 * size_m));
  const auto span = finite ? clip(padded, ahead) : Interval{ahead.min_m, ahead.max_m};
  if (!span || !(span->enter_m < span->leave_m)) return std::nullopt;

  Profile profile(shape, ray);
  profile.orient(span->enter_m, rounding_m);
  const auto bracket = march(profile, *span, 1e-4 * size_m);
  if (!bracket) return std::nullopt;
  const double t = refine(profile, *bracket).t;
  if (!(t > ahead.min_m && t < ray.max_m)) return std::nullopt;
  const Eigen::Vector3d gradient = field(shape, ray.origin + t * ray.direction).gradient;
  return ShapeHit{t, gradient.normalized()};
}

}  // namespace scan::synth
