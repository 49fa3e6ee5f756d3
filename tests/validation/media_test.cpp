// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light that wanders through media by the library's own flights, phase functions and boundaries,
// against what is known exactly of it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "synth/bsdf/bsdf.h"
#include "synth/medium/diffusion.h"
#include "synth/medium/medium.h"
#include "synth/sampling/warp.h"
#include "tests/synth/density_grids.h"
#include "tests/synth/stream_mean.h"

namespace scan::synth {
namespace {

struct Wanderer {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double weight = 1;
  double path_m = 0;
};

// Until it leaves the box: `to_exit(x, direction)` is the distance to its boundary. A faint one
// lives on by chance.
template <class Exit>
void wander(const Medium& medium, Wanderer& w, SampleSequence& random, Exit&& to_exit) {
  while (w.weight > 0) {
    const double end_m = to_exit(w.x, w.direction);
    const Flight flight = sample_flight(medium, w.x, w.direction, end_m, random);
    const double flown_m = flight.scattered_m.value_or(end_m);
    w.weight *= flight.weight;
    w.path_m += flown_m;
    w.x += flown_m * w.direction;
    if (!flight.scattered_m) return;
    w.direction = sample_phase(medium.phase, w.direction, random.next_2d());
    if (w.weight < 0.02) w.weight *= random.next() < 0.1 ? 10 : 0;
  }
}

double to_surface(const Eigen::Vector3d& x, const Eigen::Vector3d& direction) {
  return direction.z() < 0 ? -x.z() / direction.z() : std::numeric_limits<double>::infinity();
}

// A half-space below z = 0 (z down) in even light; what it sends back from inside.
Wanderer returned(const Medium& medium, double index, SampleSequence& random) {
  const Bsdf boundary = Dielectric{index};
  const Eigen::Vector3d up = to_cosine_hemisphere(random.next_2d());
  Wanderer w;
  auto entered = sample(boundary, up, random.next_3d());
  if (!entered || !entered->is_transmitted) return {.weight = 0};
  w.weight = entered->weight;
  w.direction = {entered->in.x(), entered->in.y(), -entered->in.z()};
  while (true) {
    wander(medium, w, random, to_surface);
    if (w.weight == 0) return w;
    const Eigen::Vector3d back(-w.direction.x(), -w.direction.y(), w.direction.z());
    const auto met = sample(boundary, back, random.next_3d());
    if (!met) return {.weight = 0};
    w.weight *= met->weight;
    if (met->is_transmitted) return w;
    w.x.z() = 0;
    w.direction = {met->in.x(), met->in.y(), -met->in.z()};
  }
}

// Chandrasekhar's half-space under a Fresnel boundary, its albedo and its mean path.
TEST(TranslucentBody, ReturnsLightByChandrasekhar) {
  for (const double index : {1.0, 1.4}) {
    const Medium medium{.absorption_per_m = 8, .scattering_per_m = 92};
    const StreamMean albedo = stream_mean(
        4096, [&](SampleSequence& random) { return returned(medium, index, random).weight; });
    EXPECT_NEAR(diffuse_albedo(medium, index), albedo.mean, 4.5 * albedo.error) << index;
    EXPECT_LT(albedo.error, 0.005 * albedo.mean);
    const double expected_m = penetration_path_m(medium, index);
    const StreamMean excess = stream_mean(4096, [&](SampleSequence& random) {
      const Wanderer w = returned(medium, index, random);
      return w.weight * (index * w.path_m - expected_m);  // its mean is 0: no ratio of means
    });
    EXPECT_NEAR(excess.mean, 0, 4.5 * excess.error) << index;
    EXPECT_LT(excess.error, 0.01 * expected_m * albedo.mean);
  }
}

// A slab that absorbs nothing, tau = 6, of a grid at density 1/2: (4/3) / (tau + 2 * 0.7104461)
// comes through (Hopf's constant), up to terms of exp(-6).
TEST(DensityGridMedium, TransmitsByHopfsConstant) {
  DensityGrid grid{{Eigen::Vector3d(-1000, -1000, 0), Eigen::Vector3d(1000, 1000, 3)},
                   Eigen::Vector3i(1, 1, 20),
                   std::vector<float>(20, 0.5f),
                   {}};
  set_majorants(grid);
  const Medium medium{.scattering_per_m = 4, .density = grid};
  const auto to_face = [](const Eigen::Vector3d& x, const Eigen::Vector3d& d) {
    return d.z() < 0 ? -x.z() / d.z() : (3 - x.z()) / d.z();
  };
  const StreamMean through = stream_mean(4096, [&](SampleSequence& random) {
    Wanderer w;
    w.direction = to_cosine_hemisphere(random.next_2d());
    wander(medium, w, random, to_face);
    return w.x.z() > 1.5 ? w.weight : 0;
  });
  EXPECT_NEAR(4.0 / 3 / (6 + 2 * 0.7104461), through.mean, 4.5 * through.error);
  EXPECT_LT(through.error, 0.006 * through.mean);
}

// However unevenly it scatters, a body that absorbs nothing keeps even light for the mean chord of
// its shape, 4 volume / surface (Blanco and Fournier 2003); here a box of cloud with holes.
TEST(DensityGridMedium, KeepsLightForTheMeanChord) {
  DensityGrid grid = cloud_with_holes();
  set_majorants(grid);
  const Eigen::Vector3d size = grid.box_m.sizes(), low = grid.box_m.min();
  const Eigen::Vector3d areas(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
  const auto to_face = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& d) {
    double end_m = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      if (d[axis] != 0) {
        const double face = low[axis] + (d[axis] > 0 ? size[axis] : 0);
        end_m = std::min(end_m, std::max(0.0, (face - x[axis]) / d[axis]));
      }
    return end_m;
  };
  for (const PhaseFunction& phase :
       {PhaseFunction(HenyeyGreenstein{0.6}), PhaseFunction(Rayleigh{}),
        PhaseFunction(HenyeyGreenstein{-0.8})}) {
    const Medium medium{.scattering_per_m = 6, .phase = phase, .density = grid};
    const StreamMean path_m = stream_mean(4096, [&](SampleSequence& random) {
      const double pick = random.next() * areas.sum();
      const int axis = pick < areas.x() ? 0 : pick < areas.x() + areas.y() ? 1 : 2;
      const bool far_side = random.next() < 0.5;
      const Eigen::Vector2d place = random.next_2d();
      const Eigen::Vector3d inward = to_cosine_hemisphere(random.next_2d());
      Wanderer w;
      w.x[axis] = low[axis] + (far_side ? size[axis] : 0);
      w.direction[axis] = far_side ? -inward.z() : inward.z();
      for (int k = 0; k < 2; ++k) {
        const int side = (axis + 1 + k) % 3;
        w.x[side] = low[side] + place[k] * size[side];
        w.direction[side] = inward[k];
      }
      wander(medium, w, random, to_face);
      return w.path_m;
    });
    EXPECT_NEAR(path_m.mean, 4 * size.prod() / (2 * areas.sum()), 4.5 * path_m.error);
    EXPECT_LT(path_m.error, 0.005 * path_m.mean);
  }
}

}  // namespace
}  // namespace scan::synth
