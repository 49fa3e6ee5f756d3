// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One small device of each kind before a plane and before a ball, in weak and in strong light: what
// is asked whether its stated uncertainty is honest.
#pragma once

#include <cmath>
#include <numbers>

#include "tests/validation/stated_devices.h"
#include "tests/validation/stated_figures.h"

namespace scan::synth {

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

}  // namespace scan::synth
