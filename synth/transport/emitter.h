// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A device's own light as light transport sees it.
#pragma once

#include <Eigen/Core>
#include <concepts>

namespace scan::synth {

// A ray of the emitter with its share of the emitted light: the mean over samples of a sum over
// emitted rays is the integral over the emitter's light.
struct EmittedRay {
  Eigen::Vector3d origin;     // world
  Eigen::Vector3d direction;  // unit
  double flux = 0;            // irradiance times area, in the unit of irradiance() times m^2
};

// Where along a ray fog is brightest by an emitter, and how far from there half as bright; both
// finite.
struct Brightest {
  double distance_m = 0;
  double half_width_m = 0;  // above 0
};

// World frame. The unit of irradiance is the device's own: a white Lambert surface under irradiance
// E facing it gives E electrons to the pixel, beam or tap that sees it (so radiance L gives pi L).
// position(): where the light seems to come from. irradiance(direction, length_m): on a surface
// that faces the light, at that distance along a unit direction from position(), nothing in
// between; 0 where it does not shine. sample(u): a ray drawn in proportion to the light, so flux is
// the same for every ray; flux(): that number, the total. An emitter that lights a thin sheet or
// beam should also have brightest(origin, direction), a Brightest for a ray through fog that
// crosses it; without, that is the place nearest to position(). One that lights a small part of the
// scene should have reaches(centre, radius_m): false only if it lights nothing in that ball, to
// 1e-15 of its light.
template <class T>
concept Emitter = requires(const T& emitter, const Eigen::Vector3d& direction, double length_m,
                           const Eigen::Vector2d& u) {
  { emitter.position() } -> std::convertible_to<Eigen::Vector3d>;
  { emitter.irradiance(direction, length_m) } -> std::convertible_to<double>;
  { emitter.sample(u) } -> std::convertible_to<EmittedRay>;
  { emitter.flux() } -> std::convertible_to<double>;
};

}  // namespace scan::synth
