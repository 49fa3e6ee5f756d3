// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/descriptor_matches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t few = 2;  // nearest kept per point and direction
constexpr std::size_t rows_at_once = 64;
constexpr float far = std::numeric_limits<float>::infinity();

using Table = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Descriptors = Eigen::Map<const Table>;

Descriptors descriptors_of(const ScanFeatures& features) {
  return {features.descriptors.data(), static_cast<Eigen::Index>(features.cloud.size()),
          static_cast<Eigen::Index>(ScanFeatures::dimensions)};
}

struct Nearest {
  std::array<std::uint32_t, few> index{};
  std::array<float, few> distance2;
  float mean_distance2 = 0;
};

// The nearest of b's descriptors to each of a's, the lower index first among equals.
std::vector<Nearest> nearest_of(const ScanFeatures& a, const ScanFeatures& b) {
  const Descriptors from = descriptors_of(a), to = descriptors_of(b);
  const Eigen::RowVectorXf to_squared = to.rowwise().squaredNorm().transpose();
  std::vector<Nearest> all(a.cloud.size());
  parallel_chunks(a.cloud.size(), rows_at_once, [&](std::size_t begin, std::size_t end) {
    const auto block = from.middleRows(Eigen::Index(begin), Eigen::Index(end - begin));
    const Table products = block * to.transpose();
    for (std::size_t i = begin; i < end; ++i) {
      Nearest& nearest = all[i];
      nearest.distance2.fill(far);
      const auto row = Eigen::Index(i - begin);
      const float own = block.row(row).squaredNorm();
      double sum = 0;
      for (Eigen::Index j = 0; j < to.rows(); ++j) {
        const float distance2 = std::max(0.0f, own + to_squared[j] - 2 * products(row, j));
        sum += distance2;
        if (!(distance2 < nearest.distance2.back())) continue;
        std::size_t place = few - 1;
        for (; place > 0 && distance2 < nearest.distance2[place - 1]; --place) {
          nearest.distance2[place] = nearest.distance2[place - 1];
          nearest.index[place] = nearest.index[place - 1];
        }
        nearest.distance2[place] = distance2;
        nearest.index[place] = static_cast<std::uint32_t>(j);
      }
      nearest.mean_distance2 = static_cast<float>(sum / static_cast<double>(to.rows()));
    }
  });
  return all;
}

bool holds(const Nearest& nearest, std::size_t index) {
  return std::find(nearest.index.begin(), nearest.index.end(), index) != nearest.index.end();
}

}  // namespace

std::vector<DescriptorMatch> match_descriptors(const ScanFeatures& source,
                                               const ScanFeatures& target, std::size_t most) {
  std::vector<DescriptorMatch> matches;
  if (source.cloud.empty() || target.cloud.empty()) return matches;
  const std::vector<Nearest> forth = nearest_of(source, target), back = nearest_of(target, source);
  for (std::uint32_t i = 0; i < forth.size(); ++i)
    for (std::size_t k = 0; k < few && forth[i].distance2[k] < far; ++k) {
      const std::uint32_t j = forth[i].index[k];
      if (!holds(back[j], i)) continue;
      const float mean2 = std::min(forth[i].mean_distance2, back[j].mean_distance2);
      matches.push_back({i, j, std::sqrt(forth[i].distance2[k] / std::max(mean2, 1e-20f))});
    }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  if (matches.size() > most) matches.resize(most);
  return matches;
}

}  // namespace scan
