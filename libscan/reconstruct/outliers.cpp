// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/outliers.h"

#include <algorithm>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr double alone = 2;           // reach over the neighbours' median reach
constexpr double thin = 2;            // reach over that of the median point
constexpr double least_flatness = 3;  // width over thickness where neighbours spread in a plane

}  // namespace

std::vector<char> outlying(const LocalPlanes& all) {
  const std::size_t count = all.planes.size();
  std::vector<char> out(count, 0);
  if (all.neighbours < 3) return out;
  std::vector<double> reaches(count);
  for (std::size_t i = 0; i < count; ++i) reaches[i] = all.planes[i].reach_m;
  const double usual_m = median(reaches);
  parallel_chunks(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<double> theirs(all.neighbours);
    for (std::size_t i = begin; i < end; ++i) {
      const LocalPlane& plane = all.planes[i];
      for (std::size_t n = 0; n < all.neighbours; ++n)
        theirs[n] = all.planes[all.around[i * all.neighbours + n]].reach_m;
      const bool is_flat = plane.width_m > least_flatness * plane.thickness_m;
      const bool lies_alone = plane.reach_m > alone * median(theirs);
      const bool lies_thinly = plane.reach_m > thin * usual_m && !is_flat;
      const bool lies_beside =
          plane.offset_m > plane.width_m / 2 && plane.offset_m > 4 * plane.thickness_m;
      out[i] = lies_alone || lies_thinly || lies_beside;
    }
  });
  return out;
}

}  // namespace scan
