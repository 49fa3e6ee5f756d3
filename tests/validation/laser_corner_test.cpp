// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light over two surfaces: strength against an independent quadrature, ghosts against geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "synth/scanners/laser_line_paths.h"
#include "tests/synth/laser_bench.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

constexpr double edge_m = 0.2;     // depth of the valley's edge, which runs along y
constexpr double slope_rad = 0.7;  // of its walls; the laser meets the left one alone
constexpr double albedo_of_walls = 0.3;

LaserLine device() {
  LaserLine s = small_laser();
  s.beam_radius_m = 4e-4;
  s.peak_electrons = 200000;
  s.sensor = {.gain_e_per_dn = 1, .bits = 16};
  return s;
}

Scene valley(const Bsdf& right) {
  Scene scene = white_scene({plane_at(edge_m, slope_rad), plane_at(edge_m, -slope_rad)});
  scene.materials = {{.name = "left", .bsdf = Lambert{albedo_of_walls}},
                     {.name = "right", .bsdf = right}};
  const RayCaster caster(scene);
  const int left = caster.closest({-0.05, 0, 0}, {0, 0, 1})->object;
  scene.objects[left].material = 0;
  scene.objects[1 - left].material = 1;
  return scene;
}

// Point of a wall (sign of x) and its normal, camera frame.
Eigen::Vector3d on_wall(double x, double y) {
  return {x, y, edge_m - std::abs(x) * std::tan(slope_rad)};
}
Eigen::Vector3d normal_of(double x) {
  return Eigen::Vector3d(x > 0 ? -std::sin(slope_rad) : std::sin(slope_rad), 0,
                         -std::cos(slope_rad));
}

// Light of the stripe on the left wall that gets to a camera ray's point on the right one:
// irradiance by all its parts, E = integral of rho / pi dPhi cos cos / d^2 with dPhi the flux of a
// part of the fan and of the beam's Gaussian. Midpoints: 400 angles and 9 places across, whose
// distances differ by 1e-3 of d.
double two_bounce_e(const LaserLine& s, const Eigen::Vector3d& p) {
  const Eigen::Vector3d laser(s.baseline_m, 0, 0);
  const Eigen::Vector3d middle(-std::sin(theta), 0, std::cos(theta));
  const Eigen::Vector3d across(std::cos(theta), 0, std::sin(theta));
  const Eigen::Vector3d n_a = normal_of(-1), n_b = normal_of(1);
  // the irradiance law at the focus: peak / cos(theta) facing, falling with 1 / r
  const double per_rad_m = s.peak_electrons / std::cos(theta) * s.baseline_m / std::sin(theta);
  double sum = 0;
  const int angles = 400, places = 9;
  for (int i = 0; i < angles; ++i)
    for (int k = 0; k < places; ++k) {
      const double phi = s.fan_rad * ((i + 0.5) / angles - 0.5);
      const double d = s.beam_radius_m * 1.6 * (2 * (k + 0.5) / places - 1);
      const double flux = per_rad_m * std::exp(-2 * d * d / (s.beam_radius_m * s.beam_radius_m)) *
                          (s.fan_rad / angles) * (2 * 1.6 * s.beam_radius_m / places);
      const Eigen::Vector3d from = laser + d * across;
      const Eigen::Vector3d ray = std::cos(phi) * middle + std::sin(phi) * Eigen::Vector3d::UnitY();
      const double t = n_a.dot(on_wall(0, 0) - from) / n_a.dot(ray);
      const Eigen::Vector3d a = from + t * ray, way = p - a;
      const double r2 = way.squaredNorm();
      sum += flux * albedo_of_walls / pi * n_a.dot(way) * -n_b.dot(way) / (r2 * r2);
    }
  return albedo_of_walls * sum;
}

// Four bounces bring albedo^2 times two form factors of about 0.2 more: 0.4 %. The Gaussian is cut
// at 1.6 radii: 0.14 %. The paths' own error: 0.3 of a reading's noise each, 30 x 40 readings.
TEST(LaserCorner, LightsItsOtherWallAsTheQuadratureSays) {
  LaserLine s = device();
  s.sensor.read_noise_e = 8;  // not drawn; the paths' error may be 0.3 of it
  const RayCaster caster(valley(Lambert{albedo_of_walls}));
  const Rendering rendering =
      render(s, caster, Pose::Identity(), {}, EffectSet(noise_free).set(Effect::interreflection));
  const auto& image = std::get<StripeImages>(rendering.frames).images[0];
  double found = 0, expected = 0, largest = 0, count = 0;
  for (int row = 40; row < 80; ++row)
    for (int column = 95; column < 125; ++column) {
      const Eigen::Vector3d ray = *ray_through(s.camera, {double(column), double(row)});
      const double t = edge_m / (1 + ray.x() * std::tan(slope_rad));
      const double e = two_bounce_e(s, t * ray);
      expected += e;
      found += image(column, row);
      largest = std::max(largest, e);
      ++count;
    }
  ASSERT_GT(expected / count, 20) << "electrons";
  const double error = 0.3 * std::sqrt(largest + 65) * 4 / std::sqrt(count) * count;
  EXPECT_NEAR(found, expected, 0.0054 * expected + error);
  EXPECT_GT(rendering.statistics.paths, 1000u);
  // rare bright paths weigh in the root mean square
  EXPECT_LT(rendering.statistics.sampling_error_rms, 1);
  std::printf("corner: %.1f e per pixel, quadrature %.1f\n", found / count, expected / count);
}

// Share that an unpolarised mirror reflects (Born and Wolf, sec. 14.2).
double reflectance(const Conductor& metal, double cosine) {
  const std::complex<double> n(metal.eta, metal.k);
  const auto inside = std::sqrt(n * n - (1 - cosine * cosine));
  const auto s = (cosine - inside) / (cosine + inside);
  const auto p = (n * n * cosine - inside) / (n * n * cosine + inside);
  return (std::norm(s) + std::norm(p)) / 2;
}

// A mirror for the right wall shows the left one's stripe where the view, turned back by it, meets
// the light plane; as bright as the stripe there times the mirror's reflectance. Pixel by pixel: a
// step of rounding, and 1e-3 rad of direction over the beam's width, times the incidence's tangent
// of 5.
TEST(LaserCorner, ShowsTheStripesGhostInAMirror) {
  LaserLine s = device();
  s.beam_radius_m = 2e-3;
  s.peak_electrons = 50000;
  const Conductor metal{.eta = 1.2, .k = 7, .roughness = 0};
  const RayCaster caster(valley(metal));
  const auto image = first_image(
      s, caster, EffectSet(noise_free).set(Effect::interreflection).set(Effect::mirror_reflection));
  const LaserSheet sheet = laser_sheet(s);
  const Eigen::Vector3d n = normal_of(1), n_a = normal_of(-1);
  int ghosts = 0;
  for (int row = 30; row < 90; ++row)
    for (int column = 81; column < 160; ++column) {
      const Eigen::Vector3d ray =
          ray_through(s.camera, {double(column), double(row)})->normalized();
      const Eigen::Vector3d p = n.dot(on_wall(0, 0)) / n.dot(ray) * ray;
      const Eigen::Vector3d turned = ray - 2 * n.dot(ray) * n;
      const double t = n_a.dot(on_wall(0, 0) - p) / n_a.dot(turned);
      if (!(t > 0)) continue;
      const Eigen::Vector3d a = p + t * turned;
      if (a.x() > 0) continue;
      const Eigen::Vector3d way = a - sheet.origin;
      const double d = sheet.normal.dot(way), r = (way - d * sheet.normal).norm();
      if (std::abs(std::atan2(way.y(), way.dot(sheet.middle))) > s.fan_rad / 2) continue;
      const double irradiance = s.peak_electrons / std::cos(theta) * sheet.focus_m / r *
                                std::exp(-2 * d * d / (s.beam_radius_m * s.beam_radius_m));
      const double expected = reflectance(metal, -n.dot(ray)) * albedo_of_walls * irradiance *
                              -n_a.dot(way.normalized());
      ghosts += expected > 500;
      EXPECT_NEAR(image(column, row), expected, 0.005 * expected + 1) << column << " " << row;
    }
  EXPECT_GT(ghosts, 60);
}

// The same sheet by next-event estimation and by rays of its own: their mean energies agree. On a
// plane at the focus the samples' places across the beam have the variance (w / 2)^2.
TEST(SheetEmitter, SendsItsRaysWhereItsIrradianceIs) {
  LaserLine s = device();
  s.wavelength_m = 650e-9;
  s.beam_quality = 30;
  const Bench bench(s, white_scene({plane_at(0.3)}));
  const SheetEmitter emitter(bench.view);
  const LaserSheet& sheet = bench.sheet;
  for (const double range_m : {0.1, sheet.focus_m, 0.35}) {
    double variance = 0, angle2 = 0;
    const int n = 1 << 14;
    SampleSequence random(1, 2, 3, 0);
    for (int i = 0; i < n; ++i) {
      random.start(static_cast<std::uint32_t>(i));
      const EmittedRay ray = emitter.sample(random.next_2d());
      const Eigen::Vector3d x = ray.origin + range_m * ray.direction;
      const double d = sheet.normal.dot(x) - sheet.offset_m;
      variance += d * d / n;
      const double angle = std::atan2(ray.direction.y(), ray.direction.dot(sheet.middle));
      angle2 += angle * angle / n;
      EXPECT_EQ(ray.flux, emitter.flux());
    }
    const double sigma_m = sheet.radius_m(range_m) / 2;
    // four standard errors of a Gaussian's variance, were the samples independent
    EXPECT_NEAR(variance / (sigma_m * sigma_m), 1, 4 * std::sqrt(2.0 / n)) << range_m;
    EXPECT_NEAR(angle2 / (s.fan_rad * s.fan_rad / 12), 1, 4 * std::sqrt(0.8 / n));
    // flux: irradiance r over angle and thickness; the trapezoid rule is exact for Gaussians
    double flux = 0;
    const double gap = sigma_m / 4;
    for (double d = -6 * sigma_m; d <= 6 * sigma_m; d += gap) {
      const Eigen::Vector3d x = sheet.origin + range_m * sheet.middle + d * sheet.normal;
      const Eigen::Vector3d way = x - sheet.origin;
      flux += emitter.irradiance(way.normalized(), way.norm()) * range_m * s.fan_rad * gap;
    }
    EXPECT_NEAR(flux / emitter.flux(), 1, 1e-6) << range_m;
  }
}

TEST(SheetEmitter, LightsSurfacesAsTheDirectRendererDoes) {
  const LaserLine s = device();
  const Bench bench(s, white_scene({sphere_at({0, 0, 0.19}, 0.03), plane_at(0.25)}));
  const SheetEmitter emitter(bench.view);
  const LightTransport transport(bench.caster, {.most_scatterings = 1});
  int lit = 0;
  for (int row = 10; row < 110; row += 5)
    for (int column = 0; column < 160; ++column) {
      const Eigen::Vector3d direction =
          ray_through(s.camera, {double(column), double(row)})->normalized();
      PathSums sums{.direct_way_m = straight_way_m(bench.view, {.direction = direction})};
      SampleSequence random(1, 0, row * 160 + column, 0);
      random.start(0);
      trace_path(transport, Ray{.origin = {0, 0, 0}, .direction = direction}, emitter, random,
                 sums);
      EXPECT_EQ(sums.indirect_e, 0);
      const double direct_e = bench.electrons(column, row);
      lit += direct_e > 100;
      // directions differ by the beam's width over its range, 1e-3 rad times tan of incidence <= 10
      EXPECT_NEAR(sums.direct_e, direct_e, 0.02 * direct_e + 1) << column << " " << row;
    }
  EXPECT_GT(lit, 40);
}

}  // namespace
}  // namespace scan::synth
