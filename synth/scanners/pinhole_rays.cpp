// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pinhole_rays.h"

#include <cmath>

#include "libscan/core/instruction_sets.h"

namespace scan::synth {
namespace {

SCAN_INLINE void aim_all(const Pinhole& p, std::size_t count, PinholeRays& rays) {
  for (std::size_t i = 0; i < count; ++i) {
    const double x = (rays.column_px[i] - p.cx_px) / p.fx_px;
    const double y = (rays.row_px[i] - p.cy_px) / p.fy_px;
    const double cosine = 1 / std::sqrt(x * x + y * y + 1), cosine2 = cosine * cosine;
    const double along[3] = {cosine * x, cosine * y, cosine};
    for (int axis = 0; axis < 3; ++axis) {
      rays.direction[axis][i] = along[axis];
      rays.in_world[axis][i] = p.rotation[axis][0] * along[0] + p.rotation[axis][1] * along[1] +
                               p.rotation[axis][2] * along[2];
    }
    rays.share[i] = 1 - p.vignetting * (1 - cosine2 * cosine2);
  }
}

void aim_plain(const Pinhole& pinhole, std::size_t count, PinholeRays& rays) {
  aim_all(pinhole, count, rays);
}
SCAN_AVX2 void aim_avx2(const Pinhole& pinhole, std::size_t count, PinholeRays& rays) {
  aim_all(pinhole, count, rays);
}
SCAN_AVX512 void aim_avx512(const Pinhole& pinhole, std::size_t count, PinholeRays& rays) {
  aim_all(pinhole, count, rays);
}

const Versions<PinholeKernel> versions(aim_plain, aim_avx2, aim_avx512);

}  // namespace

void aim(const Pinhole& pinhole, std::size_t count, PinholeRays& rays) {
  versions.fastest()(pinhole, count, rays);
}

std::span<PinholeKernel* const> pinhole_kernels() {
  return versions.all();
}

}  // namespace scan::synth
