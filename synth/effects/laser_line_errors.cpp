// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/laser_line_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/scanners/laser_line_samples.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// At a step of reflectance of 50, the ratio of what is white to what is black, the centroid of a
// beam of radius w shifts by w h(x / w), x the step's place: at most 0.743 w (Curless and Levoy
// 1995). A change of w changes it by h - u h' at most, 1.919 at u = 1.18.
constexpr double worst_step_shift = 0.743, worst_step_change = 1.919;

// Place of a sampled Gaussian peak of height A and width s, at best. Shot noise: s / sqrt(N), N =
// sqrt(2 pi) s A (the Cramer-Rao bound). White noise of one electron per pixel: 1 / sqrt(sum A'^2),
// with sum A'^2 = sqrt(pi) A^2 / (2 s).
double shot_px(double s, double height_e) {
  return std::sqrt(s / (std::sqrt(2 * pi) * height_e));
}
double white_px(double s, double height_e) {
  return std::sqrt(2 * s / std::sqrt(pi)) / height_e;
}
// A decoder weighs by the noise that it expects: between the centroid, best for shot noise, and
// least squares, best for white noise. Each does worse on the other's noise. Least squares on shot
// noise: sum A'^2 I / (sum A'^2)^2 = 4 sqrt(2 pi / 3) / (3 pi) s / A, 1.54 times the bound's
// square; on speckle: 2.83 times the centroid's square; the centroid within 3 s on white noise: 9 /
// pi s / A^2, 2.54 times the bound's square.
constexpr double least_squares_on_shot = 1.241, least_squares_on_speckle = 1.682;
constexpr double centroid_on_white = 1.594;

// Every reading off by one electron the worst way: sum |A'| = 2 A over sum A'^2.
double worst_px(double s, double height_e) {
  return 4 * s / (std::sqrt(pi) * height_e);
}

// A stripe of another width errs otherwise at an edge, and is the same elsewhere.
double width_change_px(double s, double other_s) {
  return std::min(worst_step_change * 2 * std::abs(s - other_s),
                  worst_step_shift * 2 * (s + other_s));
}

double spread_px(const LaserLine& device, const StripePoint& p) {
  return width_change_px(p.radius_m / 2 * p.px_per_m, device.beam_radius_m / 2 * p.px_per_m);
}

// A disk of radius R has the variance R^2 / 4 along the row.
double defocus_px(const LaserLine& device, const StripePoint& p, double s) {
  const double radius_px = blur_radius_px(device, p.depth_m);
  return width_change_px(s, std::hypot(s, radius_px / 2));
}

// Plane and ray move against each other by the sag at the fan's ends.
double bow_px(const LaserLine& device, const StripePoint& p) {
  const double focus_m = device.baseline_m / std::sin(device.triangulation_rad);
  return std::abs(device.plane_bow_m) * p.from_laser_m / focus_m * p.px_per_m;
}

double miscalibration_px(const LaserLine& device, const StripePoint& p) {
  return (std::abs(device.plane_shift_m) + std::abs(device.plane_turn_rad) * p.from_laser_m) *
         p.px_per_m;
}

// v t: the range changes by no more than the head or the turning surface moves, half of it before
// the exposure's middle; at an edge the stripe's end may stand for all of it.
double motion_m(const LaserLine& device, const StripePoint& p) {
  if (device.turn_rad == 0) return device.exposure_share * std::abs(device.step_m);
  const double lever_m = p.range_m + device.turn_centre_m.norm();
  return device.exposure_share * std::abs(device.turn_rad) * lever_m;
}

// Charge that runs over keeps its sum and centre (laser_line_blooming.h); going down the drain it
// leaves a stripe that is cut flat where it is u = sqrt(2 ln(height / full well)) sigma from its
// centre. A whole one keeps its centre; of one that an edge cuts anywhere the flat part's centre
// and the light's are at most 0.61 (u / 2) apart up to a hundredfold, by scanning all cuts.
double blooming_px(const LaserLine& device, const StripePoint& p, double s) {
  if (device.blooming_share == 0 || p.height_e <= device.sensor.full_well_e) return 0;
  return s * std::sqrt(2 * std::log(p.height_e / device.sensor.full_well_e)) / 2;
}

// Light that is even in the window W pulls to neither side. What differs by `share` of the stripe's
// height pulls most if it fills one half evenly and the other not: its moment is share W^2 / 2,
// over the stripe's sqrt(2 pi) s. Never more than W.
double pull_px(double share, double s) {
  const double window = window_px(s);
  return std::min(share * window * window / 2 / (std::sqrt(2 * pi) * s), window);
}

// A decoder takes a row's strongest peak: if light outside the window is brighter than half the
// stripe (the other half for what a few paths leave uncertain), that may be anywhere in the row.
double interreflection_m(const StripePoint& p, double s) {
  if (p.elsewhere_e > p.height_e / 2) return p.rest_of_view_m;
  return std::min(p.m_per_px * pull_px(p.uneven_e / p.height_e, s), p.rest_of_view_m);
}

// Ghosts by mirrors and glass may be anywhere in the row.
double ghost_m(const StripePoint& p) {
  return p.met_smooth ? p.rest_of_view_m : 0;
}

// Without a footprint a pixel shows its central ray alone. One that mixes two places of the stripe,
// D apart, shows the brighter one instead of the other: D at most. An edge within it is off by half
// a pixel. And a stripe that is sampled at points has its centre off by up to 4 pi s^2 exp(-2 pi^2
// s^2), the first term of Poisson's sum for the moment.
double footprint_px(const StripePoint& p) {
  const double sharp = p.radius_m / 2 * p.px_per_m;
  const double apart_px = std::min(p.step_m / p.m_per_px, window_px(stripe_sigma_px(p)));
  const double sampled_px = 4 * pi * sharp * sharp * std::exp(-2 * pi * pi * sharp * sharp);
  return std::max(apart_px, p.near_edge ? 0.5 : 0.0) + std::min(sampled_px, 0.5);
}

// Light that leaves a body elsewhere shifts the stripe's centre by its mean way along the surface;
// and widens the stripe, which then errs otherwise at an edge. Both are seen at the size of the
// view there at most.
double subsurface_m(const LaserLine& device, const StripePoint& p, double s) {
  const double px_per_m = std::max(device.camera.fx_px, device.camera.fy_px) / p.depth_m;
  const double wider_px = std::hypot(s, p.spread_m / std::numbers::sqrt2 * px_per_m);
  const double at_edge_px = p.near_edge ? width_change_px(s, wider_px) : 0;
  return std::min(p.m_per_px * (p.wander_m * px_per_m + at_edge_px), p.rest_of_view_m);
}

// Fog takes light on both ways, which raises the noise, and shines where the sheet crosses the view
// in front of the surface: evenly on one side of the stripe, and half as much again for light that
// is scattered more often. If that is as bright as the stripe, anything may be found.
double medium_m(const StripePoint& p, double s) {
  if (p.veil_e > p.height_e / 2) return p.rest_of_view_m;
  const double lost = std::expm1(p.lost_in_fog / 2);
  return p.m_per_px * (3 * lost * shot_px(s, p.height_e) + 1.5 * pull_px(p.veil_e / p.height_e, s));
}

// Noise, and at an edge what is lit on one side only.
double other_light_px(const StripePoint& p, double s) {
  const double noise_px = 3 * centroid_on_white * std::sqrt(p.other_e) * white_px(s, p.height_e);
  return noise_px + (p.near_edge ? pull_px(p.other_e / p.height_e, s) : 0);
}

}  // namespace

double window_px(double s) {
  return std::max(3 * s, 2.0);
}

double stripe_sigma_px(const StripePoint& p) {
  const double s = p.radius_m / 2 * p.px_per_m;
  return std::sqrt(s * s + 1.0 / 12);
}

// Rounding is uniform, of variance step^2 / 12.
double noise_m(const LaserLine& device, const StripePoint& p) {
  const double s = stripe_sigma_px(p);
  const double white_e =
      std::hypot(device.sensor.read_noise_e, device.sensor.gain_e_per_dn / std::sqrt(12.0));
  return p.m_per_px * std::hypot(shot_px(s, p.height_e), white_e * white_px(s, p.height_e));
}

// Maximum likelihood under shot noise takes the centroid. With X, X' of the stripe's distribution
// the centroid's variance is C^2 E[X X' mu(X - X')] times the rows' share of coherence, mu(x) =
// exp(-x^2 / a^2), a = 2 grain / pi. In U = (X + X') / sqrt 2, V = (X - X') / sqrt 2, which are
// independent, X X' = (U^2 - V^2) / 2, and with k = 1 + 4 s^2 / a^2 it is s^2 / 2 (k^-1/2 -
// k^-3/2).
double speckle_sigma_px(const Speckle& speckle, double s) {
  const double a = 2 * speckle.grain_px.x() / pi;
  const double k = 1 + 4 * s * s / (a * a);
  const double variance = s * s / 2 * (k - 1) / (k * std::sqrt(k));
  return speckle.contrast * std::sqrt(variance * pixel_share(speckle.grain_px.y()));
}

double speckle_px(const LaserLine& device, double s) {
  if (device.speckle_contrast == 0) return 0;
  return 3 * least_squares_on_speckle * speckle_sigma_px(speckle_of(device), s);
}

double left_out_m(const LaserLine& device, const StripePoint& p, Effect effect) {
  const double s = stripe_sigma_px(p), height_e = p.height_e;
  switch (effect) {
    case Effect::shot_noise:
      return p.m_per_px * 3 * least_squares_on_shot * shot_px(s, height_e);
    case Effect::read_noise:
      return p.m_per_px * 3 * centroid_on_white * device.sensor.read_noise_e *
             white_px(s, height_e);
    case Effect::quantisation:
      return p.m_per_px * device.sensor.gain_e_per_dn / 2 * worst_px(s, height_e);
    case Effect::blooming:
      return p.m_per_px * blooming_px(device, p, s);
    case Effect::interreflection:
      return interreflection_m(p, s);
    case Effect::mirror_reflection:
    case Effect::refraction:
      return ghost_m(p);
    case Effect::subsurface:
      return subsurface_m(device, p, s);
    case Effect::medium:
      return medium_m(p, s);
    case Effect::scene_lights:
      return p.m_per_px * other_light_px(p, s);
    case Effect::footprint:
      return device.sub_rays > 1 ? p.m_per_px * footprint_px(p) : 0;
    case Effect::beam_spread:
      return p.m_per_px * spread_px(device, p);
    case Effect::plane_bow:
      return p.m_per_px * bow_px(device, p);
    case Effect::speckle:
      return p.m_per_px * speckle_px(device, s);
    case Effect::defocus:
      return p.m_per_px * defocus_px(device, p, s);
    case Effect::miscalibration:
      return p.m_per_px * miscalibration_px(device, p);
    case Effect::motion:
      return motion_m(device, p);
    default:
      return 0;
  }
}

}  // namespace scan::synth
