// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_result.h"

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

}  // namespace scan
