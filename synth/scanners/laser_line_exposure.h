// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The expected light of one step's image: direct from the stripe, and by paths where it is worth
// it.
#pragma once

#include <span>
#include <vector>

#include "synth/scanners/laser_line_paths.h"
#include "synth/scanners/laser_line_samples.h"
#include "synth/scanners/laser_line_speckle.h"

namespace scan::synth {

// What all steps of a scan share.
struct LaserSweep {
  const LaserLine& scanner;  // with its effects
  LaserSheet sheet;
  std::vector<CameraSample> samples;
  Speckle speckle;
  RenderAddress address;
  DetectorEffects detector;
  const LaserPaths* paths = nullptr;  // null: direct light suffices
};

// Sums of what RenderStatistics tells.
struct PathTally {
  std::uint64_t paths = 0;
  double squares = 0;  // of standard error over noise
  double largest = 0;
  std::uint64_t readings = 0;

  PathTally& operator+=(const PathTally& other);
};
RenderStatistics statistics_of(const PathTally& tally);

// One step's camera, with motion one for each sample's time. `view` must outlive it.
class LaserExposure {
 public:
  LaserExposure(const LaserSweep& sweep, const LaserView& view, int step);

  const LaserSweep& sweep() const { return sweep_; }
  int step() const { return step_; }
  // Mean over the pixel's samples by direct light.
  PixelLight direct(int column, int row) const;
  // Mean of what paths add, as well as the reading's own noise makes worth while; `direct` as
  // above.
  PixelLight by_paths(int column, int row, const PixelLight& direct, PathTally& tally) const;

  // Pixels that direct light may reach: 1, others 0.
  Image<std::uint8_t> lit() const;
  // Pixels of which paths may change a range: in the stripe's own window, `lit`, where they bring
  // more than a tenth of the noise of its top, elsewhere where a ghost would stand out of the dark.
  // Paths through each tile of 8 x 8 pixels tell, of the tile and half a tile around it: eight, and
  // more up to one through each pixel as long as they leave in doubt which it is.
  Image<std::uint8_t> brightened(const Image<std::uint8_t>& lit, const Image<double>& direct_e,
                                 PathTally& tally) const;

 private:
  PixelLight path(int column, int row, std::size_t sample, SampleSequence& random) const;
  const LaserView& view_of(std::size_t sample) const {
    return views_[views_.size() > 1 ? sample : 0];
  }
  struct TileLight {
    double most_e = 0;  // mean and two standard errors more
    std::uint64_t paths = 0;
  };
  Image<double> tops(const Image<double>& direct_e) const;
  TileLight tile_light(int left, int top, std::span<const double> limits_e) const;

  const LaserSweep& sweep_;
  const LaserView& middle_;  // of the exposure
  int step_;
  std::vector<LaserView> views_;
  std::vector<SheetEmitter> emitters_;  // one for each view
};

}  // namespace scan::synth
