// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera's rays through its lens and what they meet.
#pragma once

#include <array>
#include <optional>

#include "synth/scanners/first_surface.h"
#include "synth/scanners/phase_camera.h"
#include "synth/scanners/pinhole_rays.h"
#include "synth/scanners/pixel_grid.h"

namespace scan::synth {

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

}  // namespace scan::synth
