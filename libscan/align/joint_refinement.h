// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The second step of many scans: all poses together, over point-to-plane pairs between all scans that
// overlap (Pulli 1999; the pairs of two scans are compressed to one quadratic form, so that the
// solver's work does not grow with the points).
#pragma once

#include <span>
#include <vector>

#include "libscan/align/multiview.h"
#include "libscan/align/observability.h"

namespace scan {

// The sum of w (r + J x)^2 over the pairs of two scans, x = twist of `source` minus twist of
// `target`, both about the frame shared by all. To first order only this difference matters: with
// r = n . (q - p) a twist of the target turns n too, which gives exactly the opposite derivative.
struct ScanPairForm {
  std::size_t source = 0, target = 0;
  std::size_t pairs = 0;
  double squares_m2 = 0;  // weighted sum of squared residuals
  double weights = 0;
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
};

// Twists of all scans that minimise the sum of the forms, those of fixed scans zero; by Ceres.
std::vector<Vector6> solve_forms(std::span<const ScanPairForm> forms, std::size_t scans,
                                 const std::vector<bool>& fixed);

}  // namespace scan
