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
constexpr std::size_t rows_per_task = 512, rows_per_product = 64;
constexpr float far = std::numeric_limits<float>::infinity();

using Table = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Descriptors = Eigen::Map<const Table>;

Descriptors descriptors_of(const ScanFeatures& features) {
  return {features.descriptors.data(), static_cast<Eigen::Index>(features.cloud.size()),
          static_cast<Eigen::Index>(ScanFeatures::dimensions)};
}

// The nearest few of those offered, the first offered first among equals.
struct Nearest {
  std::array<std::uint32_t, few> index{};
  std::array<float, few> distance2 = far_away();
  float sum_distance2 = 0;

  static constexpr std::array<float, few> far_away() {
    std::array<float, few> all{};
    all.fill(far);
    return all;
  }
  void offer(std::size_t candidate, float candidate_distance2) {
    if (!(candidate_distance2 < distance2.back())) return;
    std::size_t place = few - 1;
    for (; place > 0 && candidate_distance2 < distance2[place - 1]; --place) {
      distance2[place] = distance2[place - 1];
      index[place] = index[place - 1];
    }
    distance2[place] = candidate_distance2;
    index[place] = static_cast<std::uint32_t>(candidate);
  }
  void take_in(const Nearest& other) {
    for (std::size_t k = 0; k < few; ++k) offer(other.index[k], other.distance2[k]);
    sum_distance2 += other.sum_distance2;
  }
};

struct BothWays {
  std::vector<Nearest> forth, back;  // of each of a's among b's, of each of b's among a's
};

// |x - y|^2 = |x|^2 + |y|^2 - 2 x . y, the products a block of rows at a time; what a block says of
// the columns is gathered in `back`.
void compare_rows(const Descriptors& from, const Descriptors& to, const Eigen::RowVectorXf& squared,
                  std::size_t begin, std::size_t end, std::vector<Nearest>& forth,
                  std::vector<Nearest>& back) {
  const auto block = from.middleRows(Eigen::Index(begin), Eigen::Index(end - begin));
  const Table products = block * to.transpose();
  for (std::size_t i = begin; i < end; ++i) {
    const auto row = Eigen::Index(i - begin);
    const float own = block.row(row).squaredNorm();
    for (Eigen::Index j = 0; j < to.rows(); ++j) {
      const float distance2 = std::max(0.0f, own + squared[j] - 2 * products(row, j));
      forth[i].sum_distance2 += distance2;
      forth[i].offer(std::size_t(j), distance2);
      back[std::size_t(j)].sum_distance2 += distance2;
      back[std::size_t(j)].offer(i, distance2);
    }
  }
}

BothWays nearest_both_ways(const ScanFeatures& a, const ScanFeatures& b) {
  const Descriptors from = descriptors_of(a), to = descriptors_of(b);
  const Eigen::RowVectorXf squared = to.rowwise().squaredNorm().transpose();
  BothWays all{std::vector<Nearest>(a.cloud.size()), std::vector<Nearest>(b.cloud.size())};
  const std::size_t tasks = (a.cloud.size() + rows_per_task - 1) / rows_per_task;
  std::vector<std::vector<Nearest>> back(tasks);
  parallel_chunks(a.cloud.size(), rows_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<Nearest>& of_task = back[begin / rows_per_task];
    of_task.resize(b.cloud.size());
    for (std::size_t first = begin; first < end; first += rows_per_product)
      compare_rows(from, to, squared, first, std::min(end, first + rows_per_product), all.forth,
                   of_task);
  });
  for (const std::vector<Nearest>& of_task : back)  // in order: the same for any number of threads
    for (std::size_t j = 0; j < of_task.size(); ++j) all.back[j].take_in(of_task[j]);
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
  const auto [forth, back] = nearest_both_ways(source, target);
  for (std::uint32_t i = 0; i < forth.size(); ++i)
    for (std::size_t k = 0; k < few && forth[i].distance2[k] < far; ++k) {
      const std::uint32_t j = forth[i].index[k];
      if (!holds(back[j], i)) continue;
      const float mean2 = std::min(forth[i].sum_distance2 / static_cast<float>(target.cloud.size()),
                                   back[j].sum_distance2 / static_cast<float>(source.cloud.size()));
      matches.push_back({i, j, std::sqrt(forth[i].distance2[k] / std::max(mean2, 1e-20f))});
    }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  if (matches.size() > most) matches.resize(most);
  return matches;
}

}  // namespace scan
