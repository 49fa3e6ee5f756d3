// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points made small enough for a page: few, quantised to 16 bits, packed.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "libscan/core/point_cloud.h"

namespace scan {

// At most `most` of the indices 0 ... size - 1, rising: those of the `keep` largest absolute
// `weights` (not finite: none) and an even choice of the others. Empty weights: the even choice.
std::vector<std::uint32_t> thinned(std::size_t size, std::span<const double> weights,
                                   std::size_t most, std::size_t keep);

// Values on a grid: value = low + step * k.
struct Quantised {
  double low = 0, step = 0;
  std::vector<std::uint16_t> steps;
};
// Over the values' own range, which `most_step` steps fill; what is not finite counts as `low`.
Quantised quantised(std::span<const double> values, std::uint16_t most_step = 65535);

// What is known of each point; each array but `points` may be empty.
struct PagePoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> deviations_m;
  std::vector<double> support_m;
};

// { "count", "channels": [{"name", "low", "step"}], "data" }: "x", "y", "z", then "normal_u",
// "normal_v" (the octahedral map of Meyer et al. 2010, on [-1, 1]), "deviation" and "support" as
// far as they are known; normals and support, which only colours tell, on 256 steps. `data` is
// base64 of zlib's deflation of all channels one after the other: per channel the low bytes of all
// points, then the high ones, of the differences (modulo 65,536, zigzag) between neighbours along a
// curve that fills the box (Morton 1966).
nlohmann::ordered_json packed_points(const PagePoints& points);

// zlib's format (RFC 1950) at its best compression.
std::string deflated(std::string_view bytes);

}  // namespace scan
