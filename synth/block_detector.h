// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many readings at once.
#pragma once

#include <span>

#include "synth/block_reading.h"
#include "synth/detector.h"

namespace scan::synth {

// Reads as read_pixel() does, in closed form: one normal number stands for shot and read noise
// together, by the expansion of their sum's quantile (block_reading.h). No probability of a reading
// or less is off by more than 1e-6. Where that does not hold (few electrons without much read
// noise, light near the full well) the caller is asked, who has
// read_pixel().
class BlockDetector {
 public:
  BlockDetector(const Sensor& sensor, const DetectorEffects& effects);

  bool needs_normals() const { return law_.kind != ReadingLaw::Kind::exact; }

  // `normals` may be empty if there is no need for them. read_one(i) reads where the closed form
  // does not hold.
  template <class ReadOne>
  void read(std::span<const double> expected_e, std::span<const float> normals,
            std::span<std::uint16_t> readings, ReadOne&& read_one) const {
    if (read_block(law_, expected_e, normals, readings)) return;
    for (std::size_t i = 0; i < readings.size(); ++i)
      if (!holds(law_, expected_e[i])) readings[i] = read_one(i);
  }

 private:
  ReadingLaw law_;
};

}  // namespace scan::synth
