// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The laser's sheet as light transport sees it, and what paths bring to a pixel.
#pragma once

#include "synth/sampling/sequence.h"
#include "synth/scanners/laser_line_optics.h"
#include "synth/transport/estimate.h"
#include "synth/transport/light_transport.h"

namespace scan::synth {

// An Emitter. It seems to shine from the sheet's middle: over its thickness the directions differ
// by thickness over distance, some 1e-3 rad, and the point that a ray lights is the same.
class SheetEmitter {
 public:
  explicit SheetEmitter(const LaserView& view);

  Eigen::Vector3d position() const { return position_; }
  double irradiance(const Eigen::Vector3d& direction, double length_m) const;
  // Rays whose distance from the plane is Gaussian at every range: place and slope are independent
  // Gaussians of w0 / 2 at the focus and w0 / 2 / zR (the beam's Wigner function).
  EmittedRay sample(const Eigen::Vector2d& u) const;
  double flux() const { return flux_; }
  // Where a ray through fog crosses the sheet, and how far from there it is half as bright.
  Brightest brightest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  bool reaches(const Eigen::Vector3d& centre, double radius_m) const;

 private:
  const LaserView& view_;
  Eigen::Vector3d position_;
  double flux_;
};

// Sums of what a pixel's paths bring, as a receiver of trace_path.
struct PathSums {
  double direct_way_m = 0;    // of the straight way; longer ones went over smooth surfaces
  double direct_e = 0;        // one scattering, straight
  double indirect_e = 0;      // the device's other light
  double indirect_way_e = 0;  // the same times path length
  double other_w_m2 = 0;
  double ambient_share = 0;  // of uniform light from all sides

  void device_light(double electrons, double path_m, int scatterings);
  void other_light(double w_m2) { other_w_m2 += w_m2; }
  void ambient(double share) { ambient_share += share; }
};

// Length of the straight way from the sheet's middle over what a camera ray sees to the lens; 0 if
// it sees nothing.
double straight_way_m(const LaserView& view, const CameraRay& ray);

// Whether light gets from the laser or the scene's lights to the camera other than by one
// reflection of the laser's light, with these effects.
bool needs_paths(const LaserLine& scanner, const Scene& scene, const EffectSet& effects);

// Set up once per scan, used from many threads; the caster must outlive it.
struct LaserPaths {
  LightTransport transport;
  // No glass, translucent body or medium: what the direct renderer finds is right, and paths add
  // the rest alone.
  bool direct_is_straight;
  bool everywhere;  // in all of the stripe's own window, whatever the pilot finds

  LaserPaths(const RayCaster& caster, const EffectSet& effects);
};

// One sample of what paths bring along a camera ray, but for what the direct renderer finds.
PixelLight trace_light(const LaserPaths& paths, const LaserView& view, const SheetEmitter& emitter,
                       const CameraRay& ray, SampleSequence& random);

}  // namespace scan::synth
