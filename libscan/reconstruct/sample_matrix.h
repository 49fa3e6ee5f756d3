// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Entries of the samples' term as a matrix: what the preconditioner needs of them.
#pragma once

#include "libscan/reconstruct/sample_term.h"

namespace scan {

// Both are quick where samples that follow one another in `chosen` are near one another.

// sum += diagonal of the matrix of the chosen samples' term; `sum` holds all blocks.
void add_sample_diagonal(const BlockLevel& level, const Samples& samples,
                         const SampleWeights& weights, std::span<const std::uint32_t> chosen,
                         std::vector<double>& sum);

// matrix += that matrix, dense; for a level whose blocks are all active. `row_of`: row of each of
// the level's functions that lies in the cube.
void add_sample_matrix(const BlockLevel& level, const Samples& samples,
                       const SampleWeights& weights, std::span<const std::uint32_t> chosen,
                       std::span<const std::int32_t> row_of, Eigen::MatrixXd& matrix);

}  // namespace scan
