// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/core/units.h"
#include "synth/scanners/phasors.h"
#include "synth/scanners/surface_frame.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// Shares of light that a white surface facing its source would reflect to the lens.
struct Response {
  double own = 0;      // of the device's light: pi f cos
  double ambient = 0;  // of light from all sides
};

// Of a matt surface of one brightness.
std::optional<double> plain_albedo(const Scene& scene, const Hit& hit) {
  const Material& material = scene.materials[scene.objects[hit.object].material];
  const auto* matt = std::get_if<Lambert>(&material.bsdf);
  if (!matt || !std::holds_alternative<PlainTexture>(material.texture)) return std::nullopt;
  return matt->albedo;
}

// Of the surface that a view meets at `point` (scanner frame).
Response response(const Scene& scene, const Hit& hit, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& normal, const Eigen::Vector3d& in,
                  const Eigen::Vector3d& out) {
  if (const auto albedo = plain_albedo(scene, hit))
    return {*albedo * std::max(0.0, normal.dot(in)), *albedo};
  const SurfaceFrame frame({.point = point, .normal = normal, .hit = hit}, scene);
  return {frame.response(out, in), frame.albedo(out)};
}

}  // namespace

std::vector<Tone> tones_of(const PhaseCamera& s) {
  std::vector<Tone> tones;
  const int frequencies = static_cast<int>(s.frequencies_hz.size());
  for (int n = 1; n <= static_cast<int>(s.harmonics.size()) + 1; ++n)
    for (int f = 0; f < frequencies; ++f)
      tones.push_back({.rad_per_m = 2 * pi * n * s.frequencies_hz[f] / speed_of_light_m_s,
                       .contrast = s.contrast * (n == 1 ? 1 : s.harmonics[n - 2]),
                       .frequency = f,
                       .harmonic = n});
  return tones;
}

void DirectLight::find(const ViewBatch& batch, std::size_t begin, std::size_t end,
                       BatchLight& light) const {
  const bool straight_back = scanner.emitter_offset_m == 0 && scanner.aperture_m == 0;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t at = i - begin;
    light.constant_e[at] = light.own_e[at] = light.path_m[at] = 0;
    if (!batch.hit(i)) continue;
    const LensRay& view = batch.view(i);
    const Hit& hit = *batch.hit(i);
    if (straight_back) {
      if (const auto albedo = plain_albedo(scene, hit)) {
        const double per_m = 1 / hit.distance_m, received = weight * view.share * *albedo;
        const double cosine = -hit.normal.dot(batch.direction_in_world(i));
        light.own_e[at] =
            received * std::max(0.0, cosine) * scanner.electrons_at_1m * per_m * per_m;
        light.path_m[at] = 2 * hit.distance_m;
        light.constant_e[at] = received * scanner.ambient_electrons + light.own_e[at];
        continue;
      }
    }
    const Eigen::Vector3d point = view.ray.origin + hit.distance_m * view.ray.direction;
    const Eigen::Vector3d to_emitter = Eigen::Vector3d(scanner.emitter_offset_m, 0, 0) - point;
    const double distance_m = to_emitter.norm(), per_m = 1 / distance_m;
    const Response share = response(scene, hit, point, scanner_from_world * hit.normal,
                                    per_m * to_emitter, -view.ray.direction);
    const double received = weight * view.share;
    light.constant_e[at] = received * share.ambient * scanner.ambient_electrons;
    if (batch.dark(i)) continue;
    light.own_e[at] = received * share.own * scanner.electrons_at_1m * per_m * per_m;
    light.path_m[at] = distance_m + hit.distance_m + view.extra_m;
    light.constant_e[at] += light.own_e[at];
  }
}

void DirectLight::turn(const Tone& tone, std::size_t count, BatchLight& light) const {
  const auto first = [count](Column& column) { return std::span(column).first(count); };
  phasors(tone.rad_per_m / (2 * pi), first(light.path_m), first(light.own_e), first(light.real_e),
          first(light.imaginary_e));
  for (std::size_t i = 0; i < count; ++i) light.real_e[i] *= tone.contrast;
  for (std::size_t i = 0; i < count; ++i) light.imaginary_e[i] *= tone.contrast;
}

void DirectLight::add(const ViewBatch& batch, std::size_t i, const LightSum& sum) const {
  BatchLight light;
  find(batch, i, i + 1, light);
  sum.constant_e += light.constant_e[0];
  for (std::size_t t = 0; t < tones.size(); ++t) {
    turn(tones[t], 1, light);
    sum.amplitude_e[t] += std::complex(light.real_e[0], light.imaginary_e[0]);
  }
}

}  // namespace scan::synth
