// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/selected_inverse.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <utility>

#include "libscan/core/random.h"

namespace scan {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Ties = std::vector<std::pair<std::size_t, std::size_t>>;

// Sum over the ties of (x_i - x_j)^T Q (x_i - x_j), Q random, and over all of 0.1 x^2.
Sparse tied(std::size_t count, const Ties& ties, std::uint64_t seed) {
  Eigen::MatrixXd dense =
      0.1 * Eigen::MatrixXd::Identity(6 * Eigen::Index(count), 6 * Eigen::Index(count));
  for (std::size_t k = 0; k < ties.size(); ++k) {
    RandomStream random(seed, 0, k);
    Matrix6 root;
    for (Eigen::Index i = 0; i < 36; ++i) root(i % 6, i / 6) = random.normal();
    const Matrix6 q = root * root.transpose();
    for (const auto& [i, j, sign] : {std::tuple(ties[k].first, ties[k].first, 1.0),
                                     {ties[k].second, ties[k].second, 1.0},
                                     {ties[k].first, ties[k].second, -1.0},
                                     {ties[k].second, ties[k].first, -1.0}})
      dense.block<6, 6>(6 * Eigen::Index(i), 6 * Eigen::Index(j)) += sign * q;
  }
  return dense.sparseView();
}

// A ring, chords across it and a spur: elimination fills in.
const Ties ring_with_chords = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 7},
                               {7, 0}, {0, 4}, {2, 6}, {7, 8}, {8, 9}, {1, 5}};

// Both solve the same equations: to rounding times the condition, some 1e4.
TEST(InverseBlocks, AreThoseOfTheDenseInverse) {
  const Sparse a = tied(10, ring_with_chords, 1);
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(a).inverse();
  const std::vector<Matrix6> blocks = inverse_blocks(a);
  ASSERT_EQ(blocks.size(), 10u);
  for (Eigen::Index k = 0; k < 10; ++k) {
    const Matrix6 expected = inverse.block<6, 6>(6 * k, 6 * k);
    EXPECT_LT((blocks[std::size_t(k)] - expected).norm(), 1e-10 * expected.norm()) << k;
  }
}

// M joins blocks that A does not, too.
TEST(SandwichBlocks, AreThoseOfTheDenseProduct) {
  const Sparse a = tied(10, ring_with_chords, 2), m = tied(10, {{0, 1}, {3, 9}, {4, 5}, {2, 8}}, 3);
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(a).inverse();
  const Eigen::MatrixXd product = inverse * m * inverse;
  // Beside the diagonal: of a tie, of a couple that M alone joins, and of one that nothing does.
  std::vector<BlockAt> places = {{4, 5}, {9, 3}, {0, 9}};
  for (std::size_t k = 0; k < 10; ++k) places.emplace_back(k, k);
  const std::vector<Matrix6> blocks = sandwich_blocks(a, m, places);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto [i, j] = places[k];
    const Matrix6 expected = product.block<6, 6>(6 * Eigen::Index(i), 6 * Eigen::Index(j));
    EXPECT_LT((blocks[k] - expected).norm(), 1e-10 * product.norm()) << i << ' ' << j;
  }
}

TEST(InverseBlocks, OfAMatrixOfBlocksAreTheirInverses) {
  const Sparse a = tied(3, {}, 4);
  for (const Matrix6& block : inverse_blocks(a))
    EXPECT_LT((block - 10 * Matrix6::Identity()).norm(), 1e-13);
}

}  // namespace
}  // namespace scan
