// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a data sheet's bodies stand before the scanner one after another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libscan/verify/artefacts.h"
#include "tools/console.h"
#include "tools/recipe.h"

namespace scan {

// Where rays truly ended and how far off, 1 sigma along each, the scan states its points to be.
// Each scan has noise of its own.
struct StatedPoints {
  std::uint32_t scan = 0, columns = 1;  // of its grid
  RayGrid noise_window{1, 1};
  std::vector<std::uint32_t> rays = {};
  Points truth = {}, sigma_m = {};
};

// The points of one body at one place, as measured and as stated (none where the scan states no
// sigma); frame of the first viewpoint's scanner.
struct BodyPoints {
  Points measured;
  std::vector<StatedPoints> stated;
};

// What the scans might as well have measured if their sigmas were all of their error: points drawn
// around the true ones, with noise that rays share as the scan's noise window says.
Points drawn_points(const BodyPoints& body, std::uint64_t seed, std::uint32_t draw);

// Whether a true point of a body counts, in the body's frame.
using Counts = bool (*)(const synth::Object& body, const Eigen::Vector3d& at,
                        const Eigen::Vector3d& normal);
bool counts_anywhere(const synth::Object& body, const Eigen::Vector3d& at,
                     const Eigen::Vector3d& normal);
// Of a cylinder, not its ends.
bool counts_on_mantle(const synth::Object& body, const Eigen::Vector3d& at,
                      const Eigen::Vector3d& normal);
// Of a box, the inner 0.9 of its upper face.
bool counts_on_inner_face(const synth::Object& body, const Eigen::Vector3d& at,
                          const Eigen::Vector3d& normal);

// A recipe's scanner, effects, lights and medium, with bodies of its first material in the place of
// its objects. The recipe outlives it.
class Bench {
 public:
  Bench(const Recipe& recipe, Console& console);

  const Pose& world_from_scanner() const { return viewpoints_.front(); }
  const std::vector<Pose>& viewpoints() const { return viewpoints_; }
  std::uint64_t seed() const { return recipe_.seed; }

  // Per place, per body; from the first viewpoint, or from several and put together by their true
  // poses. Each scan has noise of its own. Throws scan::Error (computation) for a body with fewer
  // than 20 points.
  std::vector<std::vector<BodyPoints>> scanned(const std::string& test,
                                               const std::vector<synth::PlacedObjects>& places,
                                               Counts counts, std::size_t views = 1);

 private:
  void scan_place(const synth::Scene& scene, const synth::EffectSet& effects, Counts counts,
                  const Pose& world_from_view, std::vector<BodyPoints>& bodies);

  const Recipe& recipe_;
  Console& console_;
  std::vector<Pose> viewpoints_;
  std::uint32_t place_ = 0;
};

}  // namespace scan
