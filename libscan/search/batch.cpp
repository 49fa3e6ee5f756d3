// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/batch.h"

#include <algorithm>
#include <array>
#include <utility>

#include "libscan/search/local_frame.h"

namespace scan {
namespace {

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

constexpr int bits_per_axis = 14;
constexpr unsigned digit_bits = 11;  // four digits for 3 * 14 bits and the flag above them
constexpr std::uint64_t not_finite = std::uint64_t{1} << (3 * bits_per_axis);

// Bit b of a number below 2^21 moves to bit 3 b (Sean Anderson's interleaving by masks, extended to
// three).
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

std::uint64_t key_of(const Eigen::Vector3d& point, const LocalFrame& frame) {
  if (!point.allFinite()) return not_finite;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double unit = ((point[axis] - frame.origin_m[axis]) * frame.units_per_m + 1) / 2;
    const auto cell = static_cast<std::uint64_t>(std::ldexp(unit, bits_per_axis));
    key |= spread(std::min(cell, (std::uint64_t{1} << bits_per_axis) - 1)) << axis;
  }
  return key;
}

// One pass of a radix sort, lowest digits first: stable, so equal keys keep their order.
void sort_by_digit(const std::vector<Keyed>& from, std::vector<Keyed>& to, unsigned shift) {
  std::array<std::uint32_t, 1u << digit_bits> next{};
  const auto digit = [&](const Keyed& k) { return k.key >> shift & (next.size() - 1); };
  for (const Keyed& k : from) ++next[digit(k)];
  std::uint32_t sum = 0;
  for (std::uint32_t& n : next) sum += std::exchange(n, sum);
  for (const Keyed& k : from) to[next[digit(k)]++] = k;
}

}  // namespace

std::vector<std::uint32_t> curve_order(std::span<const Eigen::Vector3d> points) {
  const LocalFrame frame = local_frame(points);
  std::vector<Keyed> sorted(points.size()), other(points.size());
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        sorted[i] = {key_of(points[i], frame), static_cast<std::uint32_t>(i)};
      },
      4096);
  for (unsigned shift = 0; shift <= 3 * bits_per_axis; shift += digit_bits) {
    sort_by_digit(sorted, other, shift);
    std::swap(sorted, other);
  }
  std::vector<std::uint32_t> order(points.size());
  std::transform(sorted.begin(), sorted.end(), order.begin(),
                 [](const Keyed& k) { return k.index; });
  return order;
}

}  // namespace scan
