// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A lidar's light over other ways than straight there and back: over mirrors, through glass, from
// wall to wall, scattered often in fog or wax; and the light of other lamps.
#pragma once

#include <span>

#include "synth/effects/effect.h"
#include "synth/scanners/pulsed_lidar_walk.h"
#include "synth/transport/estimate.h"
#include "synth/transport/light_transport.h"

namespace scan::synth {

// One beam as light transport sees it. What counts of a footprint, the Gaussian of radius D, is the
// product of where the beam shines and where the receiver looks: two equal Gaussians, sqrt(2) D
// wide (1/e^2), here in the tangents of angles from the axis, with slope = D / R. An Emitter at the
// scanner's origin; the mean over views of a white surface's electrons is the range equation.
struct BeamLight {
  Eigen::Vector3d origin;  // world
  Eigen::Vector3d axis;    // unit
  double slope = 0;
  double electrons_at_1m = 0;

  Eigen::Vector3d view(const Eigen::Vector2d& u) const;  // a direction that the receiver looks in

  Eigen::Vector3d position() const { return origin; }
  double irradiance(const Eigen::Vector3d& direction, double length_m) const;
  EmittedRay sample(const Eigen::Vector2d& u) const;
  double flux() const;
  Brightest brightest(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const;
  bool reaches(const Eigen::Vector3d& centre, double radius_m) const;
};

// The beam along `direction` (unit, scanner frame), as wide as where its centre first ends; 10 urad
// if it has no extent.
BeamLight beam_light(const PulsedLidar& scanner, const RayCaster& caster,
                     const Pose& world_from_scanner, const Eigen::Vector3d& direction);
// Of a view: the longest way there and back, in metres, that light can be sent straight back from.
// The closed forms know what arrives so.
double straight_way_m(const RayCaster& caster, const Ray& view);

class LidarPaths {
 public:
  // Scratch of one thread.
  struct Memory {
    EstimateMemory sums;
    Estimate estimate;
  };
  // What the paths cost and how far their means are off.
  struct Quality {
    double paths = 0;
    double readings = 0;  // with light of the paths
    double square = 0;    // of standard error over noise, summed over those
    double largest = 0;
    Quality& operator+=(const Quality& other);
  };

  LidarPaths(const PulsedLidar& scanner, const RayCaster& caster, const EffectSet& effects,
             const SampleAxis& axis);

  // What one beam is traced by.
  struct Beam {
    const Pose& world_from_scanner;
    const Eigen::Vector3d& direction;
    const RenderAddress& address;
    std::size_t ray;
  };

  // Adds to the samples what arrives other than straight, once scattered; that is known in closed
  // form (see straight_is_known). As many paths as the readings' own noise makes worth while.
  Quality add(const Beam& beam, std::span<const DelayedPulse> walk, std::span<double> samples,
              Memory& memory) const;

  // The same light before any delay, as sharp arrivals at the samples' middles; without what is
  // less than a hundredth of an electron.
  void find(const Beam& beam, std::vector<Echo>& arrivals, Memory& memory) const;

  // False in fog of uneven density, where the straight way is traced as well.
  bool straight_is_known() const { return straight_is_known_; }

  // Whether effects and scene leave anything to trace.
  static bool needed(const PulsedLidar& scanner, const Scene& scene, const EffectSet& effects);

 private:
  // Into memory.estimate; each arrival as a Gaussian of that sigma.
  void trace(const Beam& beam, double sigma_s, std::span<const DelayedPulse> walk,
             Memory& memory) const;
  double noise_e(double mean_e) const;

  const PulsedLidar& scanner_;
  SampleAxis axis_;
  LightTransport transport_;
  bool straight_is_known_;
  double floor_e2_;  // variance of a reading without any light of the pulse
};

}  // namespace scan::synth
