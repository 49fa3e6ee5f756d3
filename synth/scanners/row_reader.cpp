// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/row_reader.h"

namespace scan::synth {
namespace {

constexpr std::size_t per_block = 4;  // numbers of a stream
// Where a row's stream has the normal numbers of its lit pixels, the words of its dark ones, and
// those of a pixel that is read by itself: as many blocks apart as a reading can need.
constexpr std::uint32_t lit_block = 1u << 28, dark_block = 1u << 29, dark_more_block = 1u << 30,
                        alone_block = 1u << 31;
constexpr std::uint32_t blocks_alone = 256;

void name_blocks(std::uint64_t ray, std::uint32_t first, std::size_t numbers,
                 std::vector<BlockAddress>& blocks) {
  blocks.clear();
  for (std::size_t b = 0; b < (numbers + per_block - 1) / per_block; ++b)
    blocks.push_back({ray, first + b});
}

}  // namespace

RowReader::RowReader(const Sensor& sensor, const DetectorEffects& effects)
    : sensor_(sensor), effects_(effects), detector_(sensor, effects), dark_(sensor, effects, 0) {}

void RowReader::read(const RenderAddress& address, std::uint64_t ray, std::span<const double> row_e,
                     std::span<std::uint16_t> readings, Memory& memory) const {
  memory.lit.clear();
  for (std::size_t i = 0; i < row_e.size(); ++i)
    if (row_e[i] != 0) memory.lit.push_back(i);
  if (memory.lit.size() < row_e.size()) read_dark(address, ray, readings, memory);
  if (!memory.lit.empty()) read_lit(address, ray, row_e, readings, memory);
}

// As if the whole row were.
void RowReader::read_dark(const RenderAddress& address, std::uint64_t ray,
                          std::span<std::uint16_t> readings, Memory& memory) const {
  name_blocks(ray, dark_block, dark_.words_for(readings.size()), memory.blocks);
  memory.words.resize(per_block * memory.blocks.size());
  draw_words(address.seed, address.scan, memory.blocks, memory.words);
  RandomStream more(address.seed, address.scan, ray, dark_more_block);
  dark_.draw(memory.words, more, readings);
}

void RowReader::read_lit(const RenderAddress& address, std::uint64_t ray,
                         std::span<const double> row_e, std::span<std::uint16_t> readings,
                         Memory& memory) const {
  memory.expected_e.clear();
  for (const std::size_t i : memory.lit) memory.expected_e.push_back(row_e[i]);
  memory.readings.resize(memory.lit.size());
  if (detector_.needs_normals()) {
    name_blocks(ray, lit_block, memory.lit.size(), memory.blocks);
    memory.normals.resize(per_block * memory.blocks.size());
    draw_normals(address.seed, address.scan, memory.blocks, memory.normals);
  }
  detector_.read(memory.expected_e, memory.normals, memory.readings, [&](std::size_t k) {
    const auto place = static_cast<std::uint32_t>(memory.lit[k]);
    RandomStream random(address.seed, address.scan, ray, alone_block + blocks_alone * place);
    return read_pixel(sensor_, effects_, memory.expected_e[k], random);
  });
  for (std::size_t k = 0; k < memory.lit.size(); ++k) readings[memory.lit[k]] = memory.readings[k];
}

}  // namespace scan::synth
