// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the effect planner costs and saves on scenes that need no effect but the detector's noise:
// seconds of `auto` (the plan and the scan that it leads to) over those of `none`, with noise in
// both (a scan with the detector's noise alone) and in neither (the plan and the scan without its
// noise, over a scan with no effect at all), and of a scan with all effects over `auto`. What else
// the plan switches on is printed. Medians of the ratios over rounds in which all take turns, so
// that a busy machine slows all alike; all effects in the first rounds only.
#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "libscan/core/cost.h"
#include "synth/effects/plan.h"

namespace scan::synth {
namespace {

constexpr int rounds = 15, rounds_of_all = 3;
constexpr double size = 0.5;  // of images of 640 x 480 pixels

struct Case {
  std::string name;
  Scanner scanner;
  Scene scene;
};

Object wall(double z_m, double tilt_rad) {
  Object object;
  object.name = "wall";
  object.geometry = Shape(PlaneShape{});
  Eigen::Matrix3d to_camera = (Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()))
                                  .toRotationMatrix();
  object.world_from_object = make_pose(to_camera, {0, 0, z_m});
  return object;
}

Scene walled(double z_m, double tilt_rad, const Texture& texture = {}) {
  return {.objects = {wall(z_m, tilt_rad)},
          .materials = {{.name = "matt", .bsdf = Lambert{0.5}, .texture = texture}}};
}

Case plane_laser() {
  const int width = static_cast<int>(640 * size), height = static_cast<int>(480 * size);
  const double focal = 1440 * size;
  return {"plane-laser",
          LaserLine{.camera = {width, height, focal, focal, width / 2.0, height / 2.0},
                    .baseline_m = 0.16,
                    .triangulation_rad = 0.436,
                    .fan_rad = 0.52,
                    .beam_radius_m = 0.7e-3,
                    .peak_electrons = 8000,
                    .steps = static_cast<int>(200 * size),
                    .step_m = 5e-4 / size,
                    .sensor = {.gain_e_per_dn = 4,
                               .offset_dn = 16,
                               .read_noise_e = 8,
                               .full_well_e = 15000,
                               .bits = 12},
                    .min_range_m = 0.2,
                    .max_range_m = 0.5},
          walled(0.34, 0.2)};
}

Case ball_phase() {
  const int width = static_cast<int>(640 * size), height = static_cast<int>(480 * size);
  const double focal = 680 * size;
  Scene scene = walled(1.3, 0);
  scene.objects[0].geometry = Shape(SphereShape{0.35});
  return {"ball-phase",
          PhaseCamera{
              .camera = {width, height, focal, focal, width / 2.0, height / 2.0},
              .frequencies_hz = {60e6, 100e6},
              .electrons_at_1m = 60000,
              .contrast = 0.6,
              .ambient_electrons = 2000,
              .sensor = {.gain_e_per_dn = 2, .read_noise_e = 20, .full_well_e = 200000, .bits = 16},
              .max_range_m = 7},
          scene};
}

Case wall_lidar() {
  return {"wall-lidar",
          PulsedLidar{.pattern = RasterPattern{static_cast<int>(480 * size),
                                               static_cast<int>(640 * size), 0.42, 0.52},
                      .pulse_sigma_s = 1.5e-9,
                      .sample_interval_s = 1e-9,
                      .electrons_at_10m = 20000,
                      .ambient_electrons = 5,
                      .sensor = {.gain_e_per_dn = 4,
                                 .offset_dn = 20,
                                 .read_noise_e = 10,
                                 .full_well_e = 60000,
                                 .bits = 14},
                      .min_range_m = 2,
                      .max_range_m = 40},
          walled(12, 0.17)};
}

Case print_stereo() {
  const int width = static_cast<int>(640 * size), height = static_cast<int>(480 * size);
  StereoPair pair{
      .ambient_electrons = 8000,
      .sensor = {.gain_e_per_dn = 40, .read_noise_e = 10, .full_well_e = 10200, .bits = 8}};
  pair.calibration = {.width_px = width,
                      .height_px = height,
                      .focal_px = 1000 * size,
                      .cx_px = width / 2.0,
                      .cy_px = height / 2.0,
                      .baseline_m = 0.06,
                      .min_disparity_px = static_cast<int>(32 * size),
                      .disparities_px = 192};
  return {"print-stereo", pair, walled(0.7, 0.17, NoiseTexture{0.012, 3, 0.9})};
}

double scan_s(const Case& c, const EffectSet& effects) {
  const Stopwatch watch;
  const RayCaster caster(simplified(c.scene, effects));
  render(c.scanner, caster, Pose::Identity(), {}, effects);
  return watch.seconds();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_ratio(std::vector<double> over, const std::vector<double>& under) {
  for (std::size_t i = 0; i < over.size(); ++i) over[i] /= under[i];
  return median(over);
}

const EffectSet noise = {Effect::shot_noise, Effect::read_noise, Effect::quantisation};

EffectSet without_noise(EffectSet effects) {
  for (const Effect effect : all_effects())
    if (noise.has(effect)) effects.set(effect, false);
  return effects;
}

void run(const Case& c) {
  const std::vector<Pose> views = {Pose::Identity()};
  std::vector<double> none_s, noise_s, plan_s, auto_s, quiet_s, all_s;
  EffectSet chosen;
  for (int i = 0; i < rounds; ++i) {
    none_s.push_back(scan_s(c, {}));
    noise_s.push_back(scan_s(c, noise));
    const Stopwatch watch;
    chosen = effects_of(plan_effects(c.scanner, c.scene, views, {}));
    plan_s.push_back(watch.seconds());
    auto_s.push_back(plan_s.back() + scan_s(c, chosen));
    quiet_s.push_back(plan_s.back() + scan_s(c, without_noise(chosen)));
    if (i < rounds_of_all) all_s.push_back(scan_s(c, EffectSet::all()));
  }
  std::printf(
      "%-13s none %.2f ms, with noise %.2f ms, plan %.2f ms, auto %.2f ms, all %.0f ms\n"
      "    auto / none: %.2f with noise in both, %.2f in neither; all / auto %.1f\n",
      c.name.c_str(), 1e3 * median(none_s), 1e3 * median(noise_s), 1e3 * median(plan_s),
      1e3 * median(auto_s), 1e3 * median(all_s), median_ratio(auto_s, noise_s),
      median_ratio(quiet_s, none_s), median(all_s) / median(auto_s));
  for (const Effect effect : all_effects())
    if (without_noise(chosen).has(effect))
      std::printf("    besides on: %s\n", std::string(name(effect)).c_str());
  std::fflush(stdout);
}

}  // namespace
}  // namespace scan::synth

int main() {
  using namespace scan::synth;
  for (const Case& c : {plane_laser(), ball_phase(), wall_lidar(), print_stereo()}) run(c);
}
