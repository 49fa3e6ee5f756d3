// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A stereo pair's images by light transport: what the direct renderer of stereo_pair.cpp leaves
// out.
#pragma once

#include "synth/scanners/stereo_optics.h"
#include "synth/transport/light_transport.h"

namespace scan::synth {

// True if the scene and the effects call for more than direct light of projector and surroundings.
bool needs_paths(const Scene& scene, const EffectSet& effects);

// The dot projector as light transport sees it; world frame.
class ProjectorLight {
 public:
  ProjectorLight(const StereoPair& scanner, const Pose& world_from_scanner);

  Eigen::Vector3d position() const;
  double irradiance(const Eigen::Vector3d& direction, double length_m) const;
  // Uniform over the left image's field: its flux follows the dots, so it is not to be used for
  // emission sampling.
  EmittedRay sample(const Eigen::Vector2d& u) const;
  double flux() const;

 private:
  const StereoPair& scanner_;
  Pose world_from_scanner_;
};

// 1 sigma of a reading with that mean: photons, read noise, rounding.
double reading_noise_e(const StereoPair& scanner, double mean_e);

// Mean electrons of one pixel with their standard error; `scanner` is the one of with_effects.
struct PixelEstimate {
  double electrons = 0;
  double standard_error = 0;
  int paths = 0;
};
PixelEstimate path_electrons(const StereoPair& scanner, const LightTransport& transport,
                             const Pose& world_from_scanner, const RenderAddress& address,
                             StereoSide side, int column, int row);

}  // namespace scan::synth
