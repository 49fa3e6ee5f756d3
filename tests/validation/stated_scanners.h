// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One small device of each kind before a plane and before a ball, in weak and in strong light: what
// is asked whether its stated uncertainty is honest.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "libscan/acquire/acquire.h"
#include "libscan/verify/surface_error.h"
#include "synth/ray_caster.h"
#include "synth/scanner.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

struct StatedScanner {
  std::string device;
  std::string target;
  double light = 1;  // of the electrons that the device collects as a rule
  Scanner scanner;
  Scene scene;
  AcquireOptions acquire = {};
};

inline PhaseCamera stated_phase_camera(double light) {
  PhaseCamera s;
  s.camera = {
      .width_px = 80, .height_px = 60, .fx_px = 100, .fy_px = 100, .cx_px = 39.5, .cy_px = 29.5};
  s.frequencies_hz = {16e6, 80e6, 120e6};
  s.electrons_at_1m *= light;
  s.ambient_electrons = 2000;
  s.sensor = {.gain_e_per_dn = 2, .offset_dn = 50, .read_noise_e = 15, .bits = 16};
  return s;
}

inline PulsedLidar stated_lidar(double light) {
  PulsedLidar s;
  s.pattern = RasterPattern{.rows = 60, .columns = 80, .height_rad = 0.5, .width_rad = 0.7};
  s.electrons_at_10m *= light;
  s.sensor = {.gain_e_per_dn = 1, .offset_dn = 50, .read_noise_e = 5, .bits = 16};
  s.max_range_m = 30;
  return s;
}

// A stripe some six pixels wide: its pixels sample it without an error that matters.
inline LaserLine stated_laser_line(double light) {
  LaserLine s;
  s.camera = {
      .width_px = 160, .height_px = 60, .fx_px = 400, .fy_px = 400, .cx_px = 79.5, .cy_px = 29.5};
  s.beam_radius_m = 8e-4;
  s.steps = 31;
  s.step_m = 2e-3;
  s.peak_electrons *= light;
  s.sensor = {.gain_e_per_dn = 2, .offset_dn = 50, .read_noise_e = 10, .bits = 14};
  return s;
}

inline StereoPair stated_stereo_pair(double light) {
  StereoPair s;
  s.calibration = {.width_px = 160,
                   .height_px = 120,
                   .focal_px = 200,
                   .cx_px = 79.5,
                   .cy_px = 59.5,
                   .doffs_px = 4,
                   .baseline_m = 0.06,
                   .disparities_px = 48};
  s.ambient_electrons *= light;
  s.sensor = {.gain_e_per_dn = 12, .read_noise_e = 20, .bits = 8};
  return s;
}

inline Material printed() {
  return {.name = "printed", .bsdf = Lambert{0.9}, .texture = NoiseTexture{0.018, 2, 0.9}};
}

inline std::vector<StatedScanner> stated_scanners() {
  const Material grey = plain(0.5);
  const auto plane = [](double z_m, const Material& material) {
    return Scene{.objects = {plane_at(z_m, 0.3)}, .materials = {material}};
  };
  const auto ball = [](double z_m, double radius_m, const Material& material) {
    return Scene{.objects = {sphere_at({0, 0, z_m}, radius_m)}, .materials = {material}};
  };
  std::vector<StatedScanner> all;
  for (const double light : {0.2, 1.0, 5.0}) {
    const auto add = [&](const char* device, const Scanner& scanner, const Scene& before_plane,
                         const Scene& before_ball) {
      all.push_back({device, "plane", light, scanner, before_plane});
      all.push_back({device, "ball", light, scanner, before_ball});
    };
    add("laser line", stated_laser_line(light), plane(0.18, grey), ball(0.21, 0.03, grey));
    if (light < 2) {  // 8 bits hold no more
      // 8 px: as far as windows reach, see StereoOptions
      const Scanner pair = stated_stereo_pair(light);
      all.push_back({"stereo", "plane", light, pair, plane(0.6, printed())});
      all.push_back({"stereo",
                     "ball",
                     light,
                     pair,
                     ball(0.75, 0.2, printed()),
                     {.stereo = {.edge_margin_px = 8}}});
      all.push_back({"stereo", "+rim", light, pair, ball(0.75, 0.2, printed())});
    }
    add("pulsed", stated_lidar(light), plane(12, grey), ball(12, 2, grey));
    add("phase", stated_phase_camera(light), plane(1.5, grey), ball(1.5, 0.4, grey));
  }
  return all;
}

// Planes near (0.18 m, 0.6 m, 0.75 m) and far, turned by so many degrees, before the time-of-flight
// scanners; those that triangulate are bound to their depth and see planes turned by 60 deg, the
// laser's light from the steep side.
inline std::vector<StatedScanner> stated_poses() {
  constexpr double degree = std::numbers::pi / 180;
  const auto plane = [](double z_m, double tilt_deg, const Material& material) {
    return Scene{.objects = {plane_at(z_m, tilt_deg * degree)}, .materials = {material}};
  };
  const Material grey = plain(0.5);
  std::vector<StatedScanner> all;
  for (const double light : {0.2, 1.0, 5.0}) {
    const auto add = [&](const char* device, const Scanner& scanner, double z_m, double tilt_deg) {
      const auto whole = [](double value) { return std::to_string(std::lround(value)); };
      const std::string target = (z_m < 1 ? "near " : whole(z_m) + " m ") + whole(tilt_deg);
      all.push_back({device, target, light, scanner, plane(z_m, tilt_deg, grey)});
    };
    add("laser line", stated_laser_line(light), 0.18, -60);
    for (const double z_m : {5.0, 25.0})
      for (const double tilt_deg : {0.0, 60.0, 75.0})
        add("pulsed", stated_lidar(light), z_m, tilt_deg);
    for (const double z_m : {0.75, 4.0})
      for (const double tilt_deg : {0.0, 60.0, 75.0})
        if (z_m < 2 || light >= 1)  // in a fifth of the light 4 m are too dim
          add("phase", stated_phase_camera(light), z_m, tilt_deg);
    if (light > 2) continue;
    all.push_back(
        {"stereo", "near 60", light, stated_stereo_pair(light), plane(0.6, 60, printed())});
  }
  return all;
}

// The figures of one noisy scan against its truth.
inline std::vector<Measurement> stated_figures(const StatedScanner& of, std::uint64_t seed) {
  const RayCaster caster(of.scene);
  const auto frames =
      render(of.scanner, caster, Pose::Identity(), {.seed = seed, .scan = 1}, sensor_effects)
          .frames;
  const Scan scan = acquire(frames, of.acquire);
  const ScanTruth truth{.name = of.device,
                        .world_from_scanner = Pose::Identity(),
                        .rays = true_rays(of.scanner, caster, Pose::Identity())};
  return range_error(scan.cloud, scan.ray, truth);
}

}  // namespace scan::synth
