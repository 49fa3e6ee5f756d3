// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera's rays through its lens and the light that comes along them.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "synth/scanners/first_surface.h"
#include "synth/scanners/phase_camera.h"
#include "synth/scanners/pixel_grid.h"

namespace scan::synth {

// One cosine of the correlation: light with a path of L metres brings electrons times
// contrast exp(i rad_per_m L) to its phasor.
struct Tone {
  double rad_per_m = 0;
  double contrast = 0;
  int frequency = 0;
  int harmonic = 1;
};
// All harmonics of all frequencies, in the order of PixelPhasors.
std::vector<Tone> tones_of(const PhaseCamera& scanner);

// Re(amplitude exp(i n k pi/2)) of harmonic n at tap k.
double modulation(const std::complex<double>& amplitude, int harmonic, int tap);

// A view through a place on the sensor and one of the lens, scanner frame. By the lens's glass its
// light has the path along the ray and `extra_m`, so that all rays from a point in focus are equal.
struct LensRay {
  ScannerRay ray;
  double extra_m = 0;
  double share = 1;  // that vignetting leaves
};
// `lens` is within the unit disk. None where the camera model has no ray.
std::optional<LensRay> lens_ray(const PhaseCamera& scanner, const Eigen::Vector2d& place,
                                const Eigen::Vector2d& lens);
// Ray i of the sub_rays^2 of a pixel.
std::optional<LensRay> sub_ray(const PhaseCamera& scanner, const PixelPlace& pixel, int i);

// Views that are traced together: neighbours in space.
class ViewBatch {
 public:
  static constexpr std::size_t most = 64;

  void clear() { size_ = 0; }
  bool full() const { return size_ == most; }
  // `owner` is the caller's number for what the view belongs to.
  void add(const Pose& world_from_scanner, const LensRay& view, std::size_t owner);
  // Finds what each view meets, its normal turned to the lens, and whether the device's light
  // reaches it.
  void trace(const PhaseCamera& scanner, const RayCaster& caster, const Pose& world_from_scanner);

  std::size_t size() const { return size_; }
  const LensRay& view(std::size_t i) const { return views_[i]; }
  std::size_t owner(std::size_t i) const { return owners_[i]; }
  const std::optional<Hit>& hit(std::size_t i) const { return hits_[i]; }
  bool dark(std::size_t i) const { return dark_[i]; }

 private:
  std::size_t size_ = 0;
  std::array<LensRay, most> views_;
  std::array<Ray, most> rays_;
  std::array<std::size_t, most> owners_;
  std::array<std::optional<Hit>, most> hits_;
  std::array<bool, most> dark_;
};

// Light of one pixel, to be added up.
struct LightSum {
  double& constant_e;
  std::span<std::complex<double>> amplitude_e;  // one per tone
};

// What does not change from view to view.
struct DirectLight {
  const PhaseCamera& scanner;
  const Scene& scene;
  std::span<const Tone> tones;
  Eigen::Matrix3d scanner_from_world;
  double weight = 1;  // of a view

  // Adds the light of view i of a batch that was traced.
  void add(const ViewBatch& batch, std::size_t i, const LightSum& sum) const;
};

}  // namespace scan::synth
