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
#include "synth/scanners/pinhole_rays.h"
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

// Re(amplitude exp(i n k pi/2)) of harmonic n at tap k, without the rounding of the angle: it is 0,
// 90, 180 or 270 degrees.
inline double modulation(const std::complex<double>& amplitude, int harmonic, int tap) {
  const double values[] = {amplitude.real(), -amplitude.imag(), -amplitude.real(),
                           amplitude.imag()};
  return values[harmonic * tap % 4];
}

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

// Whether the lens is a pinhole without distortion, whose rays are simple.
bool is_pinhole(const PhaseCamera& scanner);

// Views that are traced together: neighbours in space.
class ViewBatch {
 public:
  static constexpr std::size_t most = PinholeRays::most;

  void clear() { size_ = 0; }
  bool full() const { return size_ == most; }
  // `owner` is the caller's number for what the view belongs to.
  void add(const Pose& world_from_scanner, const LensRay& view, std::size_t owner) {
    views_[size_] = view;
    owners_[size_] = owner;
    rays_[size_].origin = world_from_scanner * view.ray.origin;
    rays_[size_].direction = world_from_scanner.linear() * view.ray.direction;
    ++size_;
  }
  // The same through that place on the sensor of a pinhole; `aim` is to be called before `trace`,
  // if all views were added so.
  void add(const Eigen::Vector2d& place, std::size_t owner) {
    pinhole_.column_px[size_] = place.x();
    pinhole_.row_px[size_] = place.y();
    owners_[size_] = owner;
    ++size_;
  }
  void aim(const PhaseCamera& scanner, const Pose& world_from_scanner);
  // Finds what each view meets, its normal turned to the lens, and whether the device's light
  // reaches it.
  void trace(const PhaseCamera& scanner, const RayCaster& caster, const Pose& world_from_scanner);

  std::size_t size() const { return size_; }
  const LensRay& view(std::size_t i) const { return views_[i]; }
  const Eigen::Vector3d& direction_in_world(std::size_t i) const { return rays_[i].direction; }
  std::size_t owner(std::size_t i) const { return owners_[i]; }
  const std::optional<Hit>& hit(std::size_t i) const { return hits_[i]; }
  bool dark(std::size_t i) const { return dark_[i]; }

 private:
  std::size_t size_ = 0;
  PinholeRays pinhole_;
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
  // Of all views, to the sums of their owners: sum_of(owner) is a LightSum.
  template <class SumOf>
  void add(const ViewBatch& batch, SumOf&& sum_of) const {
    BatchLight light;
    find(batch, 0, batch.size(), light);
    for (std::size_t i = 0; i < batch.size(); ++i)
      sum_of(batch.owner(i)).constant_e += light.constant_e[i];
    for (std::size_t t = 0; t < tones.size(); ++t) {
      turn(tones[t], batch.size(), light);
      for (std::size_t i = 0; i < batch.size(); ++i)
        sum_of(batch.owner(i)).amplitude_e[t] +=
            std::complex(light.real_e[i], light.imaginary_e[i]);
    }
  }

 private:
  using Column = std::array<double, ViewBatch::most>;
  struct BatchLight {
    Column constant_e;  // with ambient light
    Column own_e;       // the device's alone
    Column path_m;
    Column real_e, imaginary_e;  // of one tone
  };
  // Of views [begin, end): all but the phasors, which `turn` finds.
  void find(const ViewBatch& batch, std::size_t begin, std::size_t end, BatchLight& light) const;
  void turn(const Tone& tone, std::size_t count, BatchLight& light) const;
};

}  // namespace scan::synth
