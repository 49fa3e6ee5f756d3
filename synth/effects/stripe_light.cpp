// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/stripe_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "synth/medium/diffusion.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr int paths_per_place = 16;
constexpr int places_in_row = 8, paths_in_row = 4;

// Receives one path.
struct PilotSums {
  double direct_way_m = 0;
  double reflected_e = 0;  // two scatterings or more
  double indirect_e = 0;   // with what one scattering sends over smooth surfaces
  double indirect_way_e = 0;
  double other_w_m2 = 0;

  void device_light(double electrons, double path_m, int scatterings) {
    if (scatterings <= 1 && path_m <= direct_way_m * (1 + 1e-9)) return;
    indirect_e += electrons;
    indirect_way_e += electrons * path_m;
    if (scatterings >= 2) reflected_e += electrons;
  }
  void other_light(double w_m2) { other_w_m2 += w_m2; }
};

struct Mean {
  double value = 0;
  double error = 0;
  double largest = 0;  // sample
};

Mean mean_of(const std::vector<PilotSums>& samples, double PilotSums::*sum) {
  const auto n = static_cast<double>(samples.size());
  Mean mean;
  double squares = 0;
  for (const PilotSums& sample : samples) {
    mean.value += sample.*sum / n;
    squares += sample.*sum * (sample.*sum) / n;
    mean.largest = std::max(mean.largest, sample.*sum);
  }
  mean.error = std::sqrt(std::max(0.0, squares - mean.value * mean.value) / (n - 1));
  return mean;
}

struct Tracer {
  const LaserView& view;
  const LightTransport& transport;
  SheetEmitter emitter;

  std::vector<PilotSums> trace(const Eigen::Vector2d& pixel, SampleSequence random,
                               int paths) const {
    const auto seen = ray_through(view.scanner.camera, pixel);
    std::vector<PilotSums> samples(paths);
    if (!seen) return samples;
    const CameraRay ray{.direction = seen->normalized()};
    const Ray backwards{.origin = view.world_from_camera.translation(),
                        .direction = view.world_from_camera.linear() * ray.direction};
    const double way_m = straight_way_m(view, ray);
    for (int i = 0; i < paths; ++i) {
      samples[i].direct_way_m = way_m;
      random.start(static_cast<std::uint32_t>(i));
      trace_path(transport, backwards, emitter, random, samples[i]);
    }
    return samples;
  }
};

// Without the brightest path: a single rare one is no ghost.
double brightest_in_row(const Tracer& tracer, double row, std::uint64_t index) {
  const double width = tracer.view.scanner.camera.width_px;
  const double shift = std::fmod(static_cast<double>(index) * 0.6180339887498949, 1);
  double brightest_e = 0;
  for (std::uint32_t k = 0; k < places_in_row; ++k) {
    const double column = (k + shift) / places_in_row * (width - 1);
    const auto samples =
        tracer.trace({column, row}, SampleSequence(1, 0, index, 3 + k), paths_in_row);
    const Mean mean = mean_of(samples, &PilotSums::reflected_e);
    brightest_e =
        std::max(brightest_e, (mean.value * paths_in_row - mean.largest) / (paths_in_row - 1));
  }
  return brightest_e;
}

}  // namespace

StripeLight stripe_light(const LaserView& view, const LightTransport& transport,
                         const Eigen::Vector2d& pixel, double window_px, std::uint64_t index) {
  const Tracer tracer{view, transport, SheetEmitter(view)};
  StripeLight light{.elsewhere_e = brightest_in_row(tracer, pixel.y(), index)};
  std::array<Mean, 3> reflected;
  for (std::uint32_t k = 0; k < reflected.size(); ++k) {
    const double offset_px = window_px * (k == 0 ? 0 : k == 1 ? -1 : 1);
    const auto samples = tracer.trace(pixel + Eigen::Vector2d(offset_px, 0),
                                      SampleSequence(1, 0, index, k), paths_per_place);
    reflected[k] = mean_of(samples, &PilotSums::reflected_e);
    if (k > 0) continue;
    const Mean indirect = mean_of(samples, &PilotSums::indirect_e);
    light.share_e = indirect.value + 3 * indirect.error;
    const double way_e = mean_of(samples, &PilotSums::indirect_way_e).value;
    if (indirect.value > 0)
      light.extra_m = std::max(0.0, (way_e / indirect.value - samples[0].direct_way_m) / 2);
    light.others_e =
        mean_of(samples, &PilotSums::other_w_m2).value * view.scanner.electrons_per_w_m2;
  }
  const auto [darkest, brightest] =
      std::minmax_element(reflected.begin(), reflected.end(),
                          [](const Mean& a, const Mean& b) { return a.value < b.value; });
  light.uneven_e =
      brightest->value - darkest->value + 3 * std::hypot(brightest->error, darkest->error);
  return light;
}

// In electrons of white, pi times the radiance. The chord of exp(-2 d^2 / w^2) is w sqrt(pi / 2)
// over the sine of the angle between view and sheet.
double veil_e(const LaserView& view, const Medium& medium, const CameraRay& ray,
              const Eigen::Vector3d& x_in_camera) {
  const LaserSheet& sheet = view.sheet;
  const SheetLight light = sheet_light(view.scanner, sheet, x_in_camera);
  const Eigen::Vector3d shone = x_in_camera - light.source;
  const double chord_m = sheet.radius_m(shone.norm()) * std::sqrt(pi / 2) /
                         std::max(std::abs(sheet.normal.dot(ray.direction)), 1e-3);
  const double cosine = -shone.normalized().dot(ray.direction);
  return pi * light.irradiance_e * medium.scattering_per_m * phase_value(medium.phase, cosine) *
         chord_m;
}

// Refracted light is scattered, on the mean, after the mean free path of transport and has then
// forgotten its direction: what it sends out is even about the point above (Jensen et al. 2001,
// sec. 2.1; Farrell, Patterson, Wilson 1992). The spread is that of the dipole.
Wander wander_in(const Material& material, double sine_of_incidence) {
  const auto* boundary = std::get_if<Dielectric>(&material.bsdf);
  if (!boundary || !material.interior || material.interior->scattering_per_m == 0) return {};
  const double index = std::max(boundary->index, 1.0);
  return {.mean_m = dipole(*material.interior, index).depth_m * sine_of_incidence / index,
          .spread_m = lateral_spread_m(*material.interior, index)};
}

}  // namespace scan::synth
