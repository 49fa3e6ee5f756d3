// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera's taps by light transport: what direct light leaves out.
#pragma once

#include "synth/scanners/phase_exposure.h"
#include "synth/transport/estimate.h"
#include "synth/transport/light_transport.h"

namespace scan::synth {

// What of the scene calls for more than direct light of the device and light from all sides.
enum class PathNeed {
  none,
  interreflection,  // which may be too weak to matter
  all               // mirrors, glass, translucent bodies, fog or lights are there
};
PathNeed path_need(const PhaseCamera& scanner, const Scene& scene, const EffectSet& effects);

// The device's light: a point that shines alike into all directions; world frame.
class Flash {
 public:
  Flash(const PhaseCamera& scanner, const Pose& world_from_scanner)
      : electrons_at_1m_(scanner.electrons_at_1m),
        position_(world_from_scanner * Eigen::Vector3d(scanner.emitter_offset_m, 0, 0)) {}

  Eigen::Vector3d position() const { return position_; }
  double irradiance(const Eigen::Vector3d& /*direction*/, double length_m) const {
    return electrons_at_1m_ / (length_m * length_m);
  }
  EmittedRay sample(const Eigen::Vector2d& u) const;
  double flux() const;

 private:
  double electrons_at_1m_;
  Eigen::Vector3d position_;
};

// The paths of one exposure.
struct PathView {
  const PhaseCamera& scanner;
  const LightTransport& transport;
  Pose world_from_scanner;
  Exposure exposure;
  RenderAddress address;
};

Ray in_world(const Pose& world_from_scanner, const ScannerRay& ray);

// A view drawn from the pixel and the lens; none where the camera model has no ray. Numbers are
// drawn whether they are needed or not, so that an effect does not change the numbers of the
// others.
std::optional<LensRay> draw_view(const PhaseCamera& scanner, const PixelPlace& pixel,
                                 SampleSequence& random);

// Mean electrons of the exposure's taps of one pixel: those of all frequencies, four each, or the
// one. `ray` addresses their chance; `offset_m` is added to all distances. The goal is for the
// phasors' turns, which ranges follow; with four taps from the same paths their common brightness
// may miss it by a factor of 2.5.
void estimate_taps(const PathView& view, std::span<const Tone> tones, const PixelPlace& pixel,
                   std::uint64_t ray, double offset_m, const SamplingGoal& goal,
                   EstimateMemory& memory, Estimate& result);

// Light at a pixel's centre, electrons. Direct light is the device's, straight from it to the first
// surface and back; indirect light is the rest of it, by a few paths (one where there is none).
struct IndirectLight {
  double direct_e = 0;
  double indirect_e = 0;
  double indirect_error_e = 0;  // 1 sigma
  double extra_m = 0;           // mean one-way difference in length of indirect light from direct
  double other_e = 0;           // of the scene's lights
};
IndirectLight indirect_light(const PathView& view, const PixelPlace& pixel, std::uint64_t ray,
                             int paths);

// For each pixel, row by row, whether indirect light may change its taps by more than render() lets
// sub-rays change them, judged by a pilot in the middle of each tile of 8 x 8 pixels and those of
// the tiles around it.
std::vector<char> surroundings_matter(const PathView& view, std::span<const Tone> tones);

}  // namespace scan::synth
