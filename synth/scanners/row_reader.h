// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The readings of an image's rows, most of whose pixels are dark.
#pragma once

#include <vector>

#include "libscan/core/random_blocks.h"
#include "synth/block_detector.h"
#include "synth/reading_table.h"
#include "synth/scanners/rendering.h"

namespace scan::synth {

// Set up once per scan, used from many threads.
class RowReader {
 public:
  RowReader(const Sensor& sensor, const DetectorEffects& effects);

  // Scratch of one thread.
  struct Memory {
    std::vector<std::size_t> lit;  // places in the row
    std::vector<BlockAddress> blocks;
    std::vector<double> expected_e;
    std::vector<float> normals;
    std::vector<std::uint32_t> words;
    std::vector<std::uint16_t> readings;
  };

  // Readings, DN, of a row of expected electrons, by the stream of `ray` from block 2^28 on.
  void read(const RenderAddress& address, std::uint64_t ray, std::span<const double> row_e,
            std::span<std::uint16_t> readings, Memory& memory) const;

 private:
  void read_dark(const RenderAddress& address, std::uint64_t ray, std::span<std::uint16_t> readings,
                 Memory& memory) const;
  void read_lit(const RenderAddress& address, std::uint64_t ray, std::span<const double> row_e,
                std::span<std::uint16_t> readings, Memory& memory) const;

  Sensor sensor_;
  DetectorEffects effects_;
  BlockDetector detector_;
  ReadingTable dark_;
};

}  // namespace scan::synth
