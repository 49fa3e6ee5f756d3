// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/shared_noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "libscan/core/parallel.h"
#include "libscan/core/shape.h"

namespace scan {
namespace {

// Patches of two widths, one twice the other; half as many where else some narrow ones would be all
// but empty. Where these are, too, the wide ones tell alone: what they share across their borders
// is then missed.
constexpr std::size_t most_wide_patches = 64, least_wide_patches = 32;
constexpr std::size_t narrow_in_wide = 4;
constexpr std::size_t least_points_of_patch = 4;
constexpr std::size_t parallel_points = 1024;  // some 100 us; below, a task costs what it saves
// Noise of their own is estimated at 1 +- 0.32 by 64 patches (6.5 / 64 below). Cut off at 1 the
// inverses of its estimates would have a mean of 0.87, cut off so many sigmas below 0.99.
constexpr double least_in_sigmas = 1.5;

class Patches {
 public:
  Patches(std::span<const Vector6> pulls, std::span<const Eigen::Vector3d> at, std::size_t count)
      : at_(at), count_(count), order_(pulls.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    halve(0, count);
    patches_.resize(count);
    parallel_for(
        count,
        [&](std::size_t patch) {
          for (std::size_t k = begin_of(patch); k < begin_of(patch + 1); ++k)
            patches_[patch] += pulls[order_[k]];
        },
        16);
  }

  // The ratio over `count` patches, a power of two of which each is a run of the finest. The
  // estimate has followed each patch by its share P of the variance, so that tr P^2 is missing.
  double ratio(std::size_t count, int dimensions) const {
    double squares = 0, followed = 0;
    const std::size_t step = count_ / count;
    for (std::size_t first = 0; first < count_; first += step) {
      Patch patch;
      for (std::size_t i = first; i < first + step; ++i) {
        patch.sum += patches_[i].sum;
        patch.share += patches_[i].share;
      }
      squares += patch.sum.squaredNorm();
      followed += patch.share.squaredNorm();
    }
    return squares / std::max(dimensions - followed, 0.5 * dimensions);
  }

 private:
  struct Patch {
    Vector6 sum = Vector6::Zero();
    Matrix6 share = Matrix6::Zero();
    void operator+=(const Vector6& pull) {
      sum += pull;
      share.noalias() += pull * pull.transpose();
    }
  };

  std::size_t begin_of(std::size_t patch) const { return patch * order_.size() / count_; }

  // Cuts the patches [first, last) in halves along the longest side of their points, over and over.
  void halve(std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    const std::size_t middle = (first + last) / 2;
    const auto place = [&](std::size_t patch) {
      return order_.begin() + static_cast<std::ptrdiff_t>(begin_of(patch));
    };
    Eigen::AlignedBox3d box;
    for (auto k = place(first); k != place(last); ++k) box.extend(at_[*k]);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    std::nth_element(place(first), place(middle), place(last),
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double x = at_[a][axis], y = at_[b][axis];
                       return x < y || (x == y && a < b);
                     });
    parallel_for(
        2, [&](std::size_t half) { half == 0 ? halve(first, middle) : halve(middle, last); },
        begin_of(last) - begin_of(first) > parallel_points ? 1 : 2);
  }

  std::span<const Eigen::Vector3d> at_;
  std::size_t count_;
  std::vector<std::uint32_t> order_;
  std::vector<Patch> patches_;  // the finest
};

}  // namespace

double noise_sharing(std::span<const Vector6> pulls, std::span<const Eigen::Vector3d> at,
                     int dimensions) {
  const auto enough_for = [&](std::size_t wide) {
    return pulls.size() >= least_points_of_patch * narrow_in_wide * wide;
  };
  const std::size_t wide = enough_for(most_wide_patches) ? most_wide_patches : least_wide_patches;
  const Patches patches(pulls, at, narrow_in_wide * wide);
  double root = std::sqrt(patches.ratio(wide, dimensions));
  double variance = 2;  // times the patches' number, of the square of a sum of normal noise
  if (enough_for(wide)) {
    const double narrow_root = std::sqrt(patches.ratio(narrow_in_wide * wide, dimensions));
    root = std::max(0.5 * root, 2 * root - narrow_root);
    // Roots vary by half: the wide by 1 / 2, the narrow by 1 / 8, which is in the wide, too; the
    // root by 4 / 2 + 1 / 8 - 4 / 8, and its square by four times that.
    variance = 6.5;
  }
  variance /= static_cast<double>(wide);
  // The mean of the inverse is above the inverse of the mean by the variance.
  return std::max(1 / (1 + least_in_sigmas * std::sqrt(variance)), root * root * (1 + variance));
}

}  // namespace scan
