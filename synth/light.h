// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Lights of a scene besides the device's own; W in the device's passband.
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "libscan/core/image.h"
#include "libscan/core/pose.h"

namespace scan::synth {

struct PointLight {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double intensity_w_sr = 1;
};
// A rectangle that shines to the side of its +z with constant radiance; it casts no shadow.
struct AreaLight {
  Pose world_from_light = Pose::Identity();
  double width_m = 0.1;   // along its x
  double height_m = 0.1;  // along its y
  double radiance_w_m2_sr = 1;
};
// Light from infinity: constant, or an equirectangular image (row 0 is +z, column 0 is +x turning
// to +y, radiance = scale * value). Each pixel is a cell of even radiance: row r covers the polar
// angles from r to r + 1 times pi / height, column c the azimuths from c to c + 1 times
// 2 pi / width.
struct Environment {
  double radiance_w_m2_sr = 1;
  Image<float> map;  // empty: constant
};
using Light = std::variant<PointLight, AreaLight, Environment>;

void check(const Light& light, const std::string& place);  // throws scan::Error (input)

// A light with what sampling it needs, built once per scan.
struct PreparedLight {
  explicit PreparedLight(const Light& light);

  Light light;
  // Of an environment with a map: shares of all light in the rows up to each, and of a row's light
  // in its columns up to each; empty if the map is dark.
  std::vector<double> rows_up_to;
  std::vector<double> columns_up_to;
};

// A direction from x to the light, as next-event estimation needs it. `radiance` times cosine and
// BSDF over `density`; density 0 marks a delta light, whose `radiance` is the irradiance facing it.
struct LightSample {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double distance_m = 0;  // infinite for an environment
  double radiance = 0;
  double density = 0;  // per sr
};
// `u` in [0, 1)^2. Radiance 0 where no light reaches x, such as behind an area light. Area lights
// are sampled evenly by solid angle (Urena, Fajardo, King 2013), maps in proportion to radiance.
LightSample sample_light(const PreparedLight& light, const Eigen::Vector3d& x,
                         const Eigen::Vector2d& u);
// Radiance that reaches x from the direction, and the density of sample_light for it; 0 of delta
// lights. `distance_m` to the light.
LightSample light_along(const PreparedLight& light, const Eigen::Vector3d& x,
                        const Eigen::Vector3d& direction);

}  // namespace scan::synth
