// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_paths.h"

#include <algorithm>
#include <cmath>

#include "synth/sampling/warp.h"
#include "synth/transport/estimate.h"

namespace scan::synth {
namespace {

// Adds up one pixel's light.
struct PixelLight {
  const StereoPair& s;
  double electrons = 0;

  void device_light(double e, double /*path_m*/, int /*scatterings*/) { electrons += e; }
  void other_light(double w_m2) { electrons += s.electrons_per_w_m2 * w_m2; }
  void ambient(double share) { electrons += s.ambient_electrons * share; }
};

// A ray drawn from pixel, lens and exposure. The numbers are drawn whether they are needed or not,
// so that an effect does not change the numbers of the others.
StereoRay draw_ray(const StereoPair& s, StereoSide side, int column, int row,
                   SampleSequence& random) {
  const Eigen::Vector2d in_pixel = random.next_2d();
  const Eigen::Vector2d on_lens = to_disk(random.next_2d());
  const double instant = random.next();
  const Eigen::Vector2d place =
      s.sub_rays > 1 ? Eigen::Vector2d(column + in_pixel.x() - 0.5, row + in_pixel.y() - 0.5)
                     : Eigen::Vector2d(column, row);
  return stereo_ray(s, side, place, on_lens, row, instant);
}

}  // namespace

double reading_noise_e(const StereoPair& s, double mean_e) {
  const double step_e = s.sensor.gain_e_per_dn;
  return std::sqrt(std::max(mean_e, 0.0) + s.sensor.read_noise_e * s.sensor.read_noise_e +
                   step_e * step_e / 12);
}

bool needs_paths(const Scene& scene, const EffectSet& effects) {
  const bool has_smooth = std::any_of(scene.materials.begin(), scene.materials.end(),
                                      [](const Material& m) { return has_delta(m.bsdf); });
  const bool has_bodies = std::any_of(scene.materials.begin(), scene.materials.end(),
                                      [](const Material& m) { return is_transmissive(m.bsdf); });
  return effects.has(Effect::interreflection) ||
         (effects.has(Effect::mirror_reflection) && has_smooth) ||
         (effects.has(Effect::refraction) && has_bodies) ||
         (effects.has(Effect::subsurface) && has_bodies) || scene.medium || !scene.lights.empty();
}

ProjectorLight::ProjectorLight(const StereoPair& scanner, const Pose& world_from_scanner)
    : scanner_(scanner), world_from_scanner_(world_from_scanner) {}

Eigen::Vector3d ProjectorLight::position() const {
  return world_from_scanner_ * Eigen::Vector3d(scanner_.calibration.baseline_m / 2, 0, 0);
}

double ProjectorLight::irradiance(const Eigen::Vector3d& direction, double length_m) const {
  const Eigen::Vector3d in_scanner = world_from_scanner_.linear().transpose() * direction;
  const Eigen::Vector3d origin(scanner_.calibration.baseline_m / 2, 0, 0);
  return projector_electrons(scanner_, origin + length_m * in_scanner);
}

EmittedRay ProjectorLight::sample(const Eigen::Vector2d& u) const {
  const StereoCalibration& c = scanner_.calibration;
  const double width = c.width_px / c.focal_px, height = c.height_px / c.focal_px;
  const Eigen::Vector3d toward((u.x() - 0.5) * width, (u.y() - 0.5) * height, 1);
  const Eigen::Vector3d direction = world_from_scanner_.linear() * toward.normalized();
  // solid angle of the cell du dv at tangents x, y: width height / (1 + x^2 + y^2)^(3/2)
  return {.origin = position(),
          .direction = direction,
          .flux = irradiance(direction, 1) * width * height / std::pow(toward.squaredNorm(), 1.5)};
}

double ProjectorLight::flux() const {
  const StereoCalibration& c = scanner_.calibration;
  return scanner_.projector_electrons * scanner_.focus_m * scanner_.focus_m * c.width_px *
         c.height_px / (c.focal_px * c.focal_px);
}

PixelEstimate path_electrons(const StereoPair& s, const LightTransport& transport,
                             const Pose& world_from_scanner, const RenderAddress& address,
                             StereoSide side, int column, int row) {
  const StereoCalibration& c = s.calibration;
  const std::uint64_t pixel = static_cast<std::uint64_t>(row) * c.width_px + column;
  const std::uint64_t ray = 2 * pixel + (side == StereoSide::right);
  const bool moving = is_moving(s);
  const ProjectorLight still(s, world_from_scanner);
  const auto draw = [&](int stream, int index, std::span<double> signals) {
    SampleSequence random(address.seed, address.scan, ray, static_cast<std::uint32_t>(stream));
    random.start(static_cast<std::uint32_t>(index));
    const StereoRay view = draw_ray(s, side, column, row, random);
    const Pose pose = moving ? world_from_scanner * moved(s, view.time_s) : world_from_scanner;
    const Ray in_world{.origin = pose * view.ray.origin,
                       .direction = pose.linear() * view.ray.direction};
    PixelLight light{s};
    if (moving) {
      const ProjectorLight projector(s, pose);
      trace_path(transport, in_world, projector, random, light);
    } else {
      trace_path(transport, in_world, still, random, light);
    }
    signals[0] += view.factor * light.electrons;
  };
  const auto noise = [&](double mean_e) { return reading_noise_e(s, mean_e); };
  thread_local EstimateMemory memory;
  thread_local Estimate result;
  estimate(1, {}, noise, draw, memory, result);
  return {result.mean[0], result.standard_error[0], result.samples};
}

}  // namespace scan::synth
