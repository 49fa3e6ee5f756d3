// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_result.h"

#include <algorithm>

namespace scan {

std::string_view name_of(SolveStop stop) {
  switch (stop) {
    case SolveStop::converged:
      return "converged";
    case SolveStop::iteration_limit:
      return "iteration limit";
    case SolveStop::direct:
      return "direct";
  }
  return "unknown";
}

double unsupported_area_m2(const SurfaceResult& result) {
  if (result.data_spacing_m.empty()) return 0;
  double twice = 0;
  for (const Triangle& t : result.surface.triangles)
    if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
          return result.support_m[v] > supported_within_spacings * result.data_spacing_m[v];
        }))
      twice += area_vector(result.surface, t).norm();
  return twice / 2;
}

}  // namespace scan
