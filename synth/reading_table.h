// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Readings of pixels that all expect the same light, such as the dark part of a waveform.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "synth/detector.h"

namespace scan::synth {

// Draws what read_pixel() would, from its distribution tabulated once: the sum over Poisson's
// counts of the normal distribution between rounding edges, right to 2^-48. Half a word of the
// stream per reading instead of dozens.
class ReadingTable {
 public:
  ReadingTable(const Sensor& sensor, const DetectorEffects& effects, double expected_e);

  std::uint16_t draw(RandomStream& random) const;
  // The same by words of a stream, half of one per reading; `more` gives what else is needed.
  void draw(std::span<const std::uint32_t> words, RandomStream& more,
            std::span<std::uint16_t> readings) const;
  std::size_t words_for(std::size_t readings) const {
    return limits_.size() > 1 ? (readings + 1) / 2 : 0;
  }
  // The reading that a number of 48 bits stands for.
  std::uint16_t reading_at(std::uint64_t u) const;

 private:
  void tabulate(const std::vector<double>& cumulative);
  std::uint16_t reading_of(std::uint32_t half_word, RandomStream& random) const {
    const std::uint16_t quick = quick_[half_word >> (16 - quick_bits)];
    if (quick != unsure_) [[likely]]
      return quick;
    return reading_at(std::uint64_t{half_word} << 32 | random.bits32());
  }

  Sensor sensor_;
  DetectorEffects effects_;
  double expected_e_;
  int first_dn_ = 0;
  std::vector<std::uint64_t> limits_;  // outcome d has u < limits_[d]; empty: read_pixel() draws
  std::uint16_t unsure_ = 0;           // none of the readings
  static constexpr unsigned quick_bits = 14;
  std::vector<std::uint16_t> quick_;  // the reading by the highest bits, if they tell it
};

}  // namespace scan::synth
