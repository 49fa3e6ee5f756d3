// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_bias.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan::decoding {
namespace {

// The farther the places, the less their own noise counts in the shift: at four widths a fifth of
// the centre's. Nearer ones would only measure noise.
constexpr double least_widths = 4;

// A stripe cut c widths from its centre passes the shape check from c = 0.8 on, where its fit
// stands 0.5 widths off; root mean square over all c up to four widths.
constexpr double cut_share = 0.15;

// A normal distribution cut c widths from its centre has the width 0.79 at c = 1, 0.60 at 0 and
// 0.45 if but the tail from one width on is left; its mean is off by 0.29, 0.80 and 1.53.
constexpr double whole_share = 0.8;

// The place of another step's ray as the camera of this step sees it.
std::optional<LitPlace> place_of(const StripeImages& frames, std::size_t step, const LitRay& ray) {
  const LaserLineCalibration& calibration = frames.calibration;
  const Eigen::Vector3d x = frames.scanner_from_camera[step].inverse() * ray.point;
  const auto pixel = project(calibration.camera, x);
  if (!pixel) return std::nullopt;
  return LitPlace{calibration.plane_normal.dot(x) - calibration.plane_offset_m, pixel->x(),
                  ray.height_e, ray.width_px};
}

// Steps of one row are looked at in one direction until a place is far enough away. None if the
// body ends before.
class Walk {
 public:
  Walk(const StripeImages& frames, std::span<const LitRay> rays, std::size_t ray)
      : frames_(frames),
        rays_(rays),
        rows_(static_cast<std::size_t>(frames.calibration.camera.height_px)),
        step_(ray / rows_),
        row_(ray % rows_) {}

  // From `at` on (steps away, signed); moves it to the step found. At the end of the sweep it is
  // moved beyond.
  std::optional<LitPlace> next(long& at, long direction, double least_px) const {
    const LitRay& here = rays_[step_ * rows_ + row_];
    for (; is_step(at); at += direction) {
      const LitRay& there = rays_[index(at)];
      if (!(there.width_px > 0)) return std::nullopt;
      const auto place = place_of(frames_, step_, there);
      if (!place) return std::nullopt;
      if (std::abs(place->column_px - here.column_px) >= least_px) return place;
    }
    return std::nullopt;
  }
  // How far a step moves the body's place in the image.
  double moves_px(long at) const {
    const LitRay& here = rays_[step_ * rows_ + row_];
    if (!is_step(at)) return 0;
    const auto place =
        place_of(frames_, static_cast<std::size_t>(static_cast<long>(step_) + at), here);
    return place ? std::abs(place->column_px - here.column_px) : 0;
  }
  bool is_step(long at) const {
    const long step = static_cast<long>(step_) + at;
    return step >= 0 && step < static_cast<long>(frames_.images.size());
  }

 private:
  std::size_t index(long at) const {
    return static_cast<std::size_t>(static_cast<long>(step_) + at) * rows_ + row_;
  }

  const StripeImages& frames_;
  std::span<const LitRay> rays_;
  std::size_t rows_, step_, row_;
};

}  // namespace

double stripe_shift_px(const LitPlace& here, const LitPlace& one, const LitPlace& other,
                       double width_px) {
  const double p1 = one.offset_m - here.offset_m, p2 = other.offset_m - here.offset_m;
  if (p1 == 0 || p2 == 0 || p1 == p2) return 0;
  const double slope1 = (one.column_px - here.column_px) / p1,
               slope2 = (other.column_px - here.column_px) / p2;
  const double b = (slope1 - slope2) / (p1 - p2), a = slope1 - b * p1;
  const double rise1 = std::log(one.height_e / here.height_e) / p1,
               rise2 = std::log(other.height_e / here.height_e) / p2;
  const double g = rise1 - (rise1 - rise2) / (p1 - p2) * p1;
  if (a == 0) return 0;
  return width_px * width_px * (g / a + 3 * b / (a * a));
}

std::optional<StripeShift> stripe_shift(const StripeImages& frames, std::span<const LitRay> rays,
                                        std::size_t ray) {
  const LitRay& here = rays[ray];
  const Walk walk(frames, rays, ray);
  const double least_px = least_widths * here.width_px;
  const StripeShift perhaps_cut{.unknown_px = cut_share * here.width_px};
  long ahead = 1, behind = -1;
  std::optional<LitPlace> one = walk.next(ahead, 1, least_px);
  std::optional<LitPlace> other = walk.next(behind, -1, least_px);
  // At either end of the sweep both places lie on the same side, the second twice as far.
  if (one && !other && !walk.is_step(behind)) other = walk.next(ahead, 1, 2 * least_px);
  if (other && !one && !walk.is_step(ahead)) one = walk.next(behind, -1, 2 * least_px);
  const bool is_swept = (walk.is_step(ahead) || walk.is_step(behind)) &&
                        std::max(walk.moves_px(1), walk.moves_px(-1)) > here.width_px;
  if (!one && !other) return is_swept ? std::nullopt : std::optional(perhaps_cut);
  if (!one || !other) {
    const double whole_px = one ? one->width_px : other->width_px;
    if (here.width_px < whole_share * whole_px) return std::nullopt;
    return perhaps_cut;
  }
  if (here.width_px < whole_share * std::min(one->width_px, other->width_px)) return std::nullopt;
  const double shift_px =
      stripe_shift_px({0, here.column_px, here.height_e}, *one, *other, here.width_px);
  if (!std::isfinite(shift_px)) return perhaps_cut;
  return StripeShift{shift_px, 0, true};
}

namespace {

// The sum over rows at the same distance to either side.
struct Around {
  double sum_px = 0;
  int count = 0;
};

Around around(std::span<const LitRay> rays, std::span<const std::optional<StripeShift>> own,
              std::size_t rows, std::size_t ray) {
  const auto goes_on = [&](std::size_t from, std::size_t to) {
    return own[to] && own[to]->is_known &&
           std::abs(rays[to].column_px - rays[from].column_px) < rays[ray].width_px;
  };
  const std::size_t row = ray % rows;
  const auto reach = static_cast<std::size_t>(least_widths * rays[ray].width_px);
  const std::size_t most = std::min({reach, row, rows - 1 - row});
  Around sum;
  for (std::size_t k = 1; k <= most; ++k) {
    if (!goes_on(ray - k + 1, ray - k) || !goes_on(ray + k - 1, ray + k)) break;
    sum.sum_px += own[ray - k]->shift_px + own[ray + k]->shift_px;
    sum.count += 2;
  }
  return sum;
}

}  // namespace

std::vector<std::optional<StripeShift>> stripe_shifts(const StripeImages& frames,
                                                      std::span<const LitRay> rays) {
  std::vector<std::optional<StripeShift>> own(rays.size());
  parallel_for(rays.size(), [&](std::size_t ray) {
    if (rays[ray].width_px > 0) own[ray] = stripe_shift(frames, rays, ray);
  });
  std::vector<std::optional<StripeShift>> shifts = own;
  const auto rows = static_cast<std::size_t>(frames.calibration.camera.height_px);
  parallel_for(rays.size(), [&](std::size_t ray) {
    if (!own[ray] || !own[ray]->is_known) return;
    const auto [sum_px, count] = around(rays, own, rows, ray);
    const double mean_px = count > 0 ? sum_px / count : 0;
    shifts[ray] =
        StripeShift{mean_px, std::abs(count > 0 ? mean_px : own[ray]->shift_px), count > 0};
  });
  return shifts;
}

}  // namespace scan::decoding
