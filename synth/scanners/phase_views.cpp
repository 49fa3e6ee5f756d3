// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace scan::synth {
namespace {

using std::numbers::pi;

// The unit square to the unit disk, equal areas to equal areas (Shirley and Chiu 1997).
Eigen::Vector2d on_lens(const Eigen::Vector2d& unit_square) {
  const Eigen::Vector2d v = 2 * unit_square - Eigen::Vector2d::Ones();
  if (v.isZero(0)) return v;
  const bool wide = std::abs(v.x()) > std::abs(v.y());
  const double radius = wide ? v.x() : v.y();
  const double angle = wide ? pi / 4 * v.y() / v.x() : pi / 2 - pi / 4 * v.x() / v.y();
  return radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

// Which of n cells of the lens the ray through cell i of the pixel takes: each is taken once, by a
// stride near the golden section of n, shifted from pixel to pixel.
int lens_cell(const PixelPlace& pixel, int i, int n) {
  int stride = std::max(1, static_cast<int>(0.618034 * n));
  while (std::gcd(stride, n) != 1) ++stride;
  const long long shift = 7LL * pixel.column + 13LL * pixel.row;
  return static_cast<int>((static_cast<long long>(stride) * i + shift) % n);
}

}  // namespace

std::optional<LensRay> lens_ray(const PhaseCamera& s, const Eigen::Vector2d& place,
                                const Eigen::Vector2d& lens) {
  const auto toward = ray_through(s.camera, place);
  if (!toward) return std::nullopt;
  LensRay view;
  const double cosine = 1 / toward->norm(), cosine2 = cosine * cosine;
  view.share = 1 - s.vignetting * (1 - cosine2 * cosine2);
  view.ray.direction = cosine * *toward;
  if (s.aperture_m == 0) return view;
  const Eigen::Vector3d sharp = s.focus_m * *toward;
  view.ray.origin.head<2>() = s.aperture_m / 2 * lens;
  const double to_sharp_m = (sharp - view.ray.origin).norm();
  view.ray.direction = (sharp - view.ray.origin) / to_sharp_m;
  view.extra_m = sharp.norm() - to_sharp_m;
  return view;
}

bool is_pinhole(const PhaseCamera& s) {
  const Camera& c = s.camera;
  return s.aperture_m == 0 && c.k1 == 0 && c.k2 == 0 && c.k3 == 0 && c.p1 == 0 && c.p2 == 0;
}

std::optional<LensRay> sub_ray(const PhaseCamera& s, const PixelPlace& pixel, int i) {
  if (s.sub_rays == 1) return lens_ray(s, Eigen::Vector2d(pixel.column, pixel.row), {0, 0});
  Eigen::Vector2d lens = Eigen::Vector2d::Zero();
  if (s.aperture_m != 0) {
    const int cell = lens_cell(pixel, i, s.sub_rays * s.sub_rays);
    lens = on_lens(sub_pixel({0, 0}, cell, s.sub_rays) + Eigen::Vector2d(0.5, 0.5));
  }
  return lens_ray(s, sub_pixel(pixel, i, s.sub_rays), lens);
}

void ViewBatch::aim(const PhaseCamera& s, const Pose& world_from_scanner) {
  const Eigen::Matrix3d turn = world_from_scanner.linear();
  Pinhole pinhole{s.camera.fx_px, s.camera.fy_px, s.camera.cx_px, s.camera.cy_px, s.vignetting, {}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pinhole.rotation[i][j] = turn(i, j);
  synth::aim(pinhole, size_, pinhole_);
  const Eigen::Vector3d origin = world_from_scanner.translation();
  for (std::size_t i = 0; i < size_; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      views_[i].ray.direction[axis] = pinhole_.direction[axis][i];
      rays_[i].direction[axis] = pinhole_.in_world[axis][i];
    }
    views_[i].share = pinhole_.share[i];
    rays_[i].origin = origin;
  }
}

void ViewBatch::trace(const PhaseCamera& s, const RayCaster& caster,
                      const Pose& world_from_scanner) {
  const std::span hits(hits_.data(), size_);
  caster.closest(std::span(rays_.data(), size_), hits);
  for (std::size_t i = 0; i < size_; ++i)
    if (hits[i] && hits[i]->normal.dot(rays_[i].direction) > 0) hits[i]->normal = -hits[i]->normal;
  std::fill_n(dark_.begin(), size_, false);
  // A light at the lens lights all that the lens sees.
  if (s.emitter_offset_m == 0) return;
  const Eigen::Vector3d light = world_from_scanner * Eigen::Vector3d(s.emitter_offset_m, 0, 0);
  caster.occluded(hits, light, std::span(dark_.data(), size_));
}

}  // namespace scan::synth
