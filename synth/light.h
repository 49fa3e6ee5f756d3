// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Lights of a scene besides the device's own; W in the device's passband.
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

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
  double width_m = 0.1;
  double height_m = 0.1;
  double radiance_w_m2_sr = 1;
};
// Light from infinity: constant, or an equirectangular image (row 0 is +z, column 0 is +x turning
// to +y, radiance = scale * value).
struct Environment {
  double radiance_w_m2_sr = 1;
  Image<float> map;  // empty: constant
};
using Light = std::variant<PointLight, AreaLight, Environment>;

void check(const Light& light, const std::string& place);  // throws scan::Error (input)

// A direction from x to the light, as next-event estimation needs it. `radiance` times cosine and
// BSDF over `density`; density 0 marks a delta light, whose `radiance` is the irradiance facing it.
struct LightSample {
  Eigen::Vector3d direction;
  double distance_m = 0;  // infinite for an environment
  double radiance = 0;
  double density = 0;  // per sr
};
LightSample sample_light(const Light& light, const Eigen::Vector3d& x, const Eigen::Vector2d& u);
// Radiance that reaches x from the direction, and the density of sample_light for it; 0 of delta
// lights. `distance_m` to the light.
LightSample light_along(const Light& light, const Eigen::Vector3d& x,
                        const Eigen::Vector3d& direction);

}  // namespace scan::synth
