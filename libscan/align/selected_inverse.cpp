// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/selected_inverse.h"

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace scan {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// A number and its derivative.
struct Dual {
  double value = 0, slope = 0;
  Dual& operator-=(const Dual& b) {
    value -= b.value, slope -= b.slope;
    return *this;
  }
};
Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.value * b.slope + a.slope * b.value};
}
Dual operator/(const Dual& a, const Dual& b) {
  const double ratio = a.value / b.value;
  return {ratio, (a.slope - ratio * b.slope) / b.value};
}

// Below the diagonal, by columns: rows ascending.
struct Entry {
  Eigen::Index row = 0;
  Dual number;
};
using Columns = std::vector<std::vector<Entry>>;

// The lower half of the permuted A with the derivative M, the wanted blocks among its pattern.
struct Lower {
  std::vector<Dual> diagonal;
  Columns columns;
};

// Of the entries of those blocks: calls use(block, row, column).
template <class Use>
void each_place(std::span<const BlockAt> blocks, Use&& use) {
  for (std::size_t k = 0; k < blocks.size(); ++k)
    for (int i = 0; i < 36; ++i)
      use(k, 6 * Eigen::Index(blocks[k].first) + i % 6, 6 * Eigen::Index(blocks[k].second) + i / 6);
}

Lower lower_half(const Sparse& a, const Sparse& m, std::span<const BlockAt> wanted,
                 const Eigen::VectorXi& place) {
  Lower lower{std::vector<Dual>(std::size_t(a.rows())), Columns(std::size_t(a.rows()))};
  const auto add = [&](Eigen::Index i, Eigen::Index j, const Dual& number) {
    const Eigen::Index row = place[i], column = place[j];
    if (row == column) lower.diagonal[std::size_t(row)] -= {-number.value, -number.slope};
    if (row > column) lower.columns[std::size_t(column)].push_back({row, number});
  };
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Sparse::InnerIterator at(a, j); at; ++at) add(at.row(), j, {at.value(), 0});
    for (Sparse::InnerIterator at(m, j); at; ++at) add(at.row(), j, {0, at.value()});
  }
  each_place(wanted, [&](std::size_t, Eigen::Index i, Eigen::Index j) {
    add(i, j, {});
    add(j, i, {});
  });
  return lower;
}

// Entries of one row become one, which leaves the rows ascending.
void merge(std::vector<Entry>& column) {
  std::stable_sort(column.begin(), column.end(),
                   [](const Entry& a, const Entry& b) { return a.row < b.row; });
  std::vector<Entry> merged;
  for (const Entry& entry : column) {
    if (merged.empty() || merged.back().row != entry.row)
      merged.push_back(entry);
    else
      merged.back().number -= {-entry.number.value, -entry.number.slope};
  }
  column = std::move(merged);
}

// L D L^T in place, right-looking: each column, once done, is taken from those that it meets.
void factorise(Lower& a) {
  const std::size_t size = a.diagonal.size();
  for (std::size_t j = 0; j < size; ++j) {
    merge(a.columns[j]);
    std::vector<Entry>& column = a.columns[j];
    const Dual pivot = a.diagonal[j];
    for (std::size_t s = 0; s < column.size(); ++s) {
      const Dual share = column[s].number / pivot;
      const auto k = std::size_t(column[s].row);
      a.diagonal[k] -= share * column[s].number;
      for (std::size_t t = s + 1; t < column.size(); ++t) {
        const Dual product = share * column[t].number;
        a.columns[k].push_back({column[t].row, {-product.value, -product.slope}});
      }
      // Few columns meet in one before it is merged anew, so that memory stays with the factor's.
      if (a.columns[k].size() > 4096) merge(a.columns[k]);
    }
    for (Entry& entry : column) entry.number = entry.number / pivot;
  }
}

// Z = A^-1 over the pattern of L, in its place: Z_ij = -sum L_kj Z_ik over k > j for i > j, and
// Z_jj = 1 / D_j - sum L_kj Z_kj, from the last column on.
void invert(Lower& a) {
  std::vector<Dual> sum(a.diagonal.size());
  std::vector<bool> wanted(a.diagonal.size(), false);
  for (std::size_t j = a.diagonal.size(); j-- > 0;) {
    std::vector<Entry>& column = a.columns[j];
    for (const Entry& entry : column) {
      wanted[std::size_t(entry.row)] = true;
      sum[std::size_t(entry.row)] = {};
    }
    for (const Entry& entry : column) {
      const auto k = std::size_t(entry.row);
      sum[k] -= entry.number * a.diagonal[k];
      Dual rest;
      std::size_t at = std::size_t(&entry - column.data()) + 1;
      for (const Entry& other : a.columns[k]) {
        if (!wanted[std::size_t(other.row)]) continue;
        while (column[at].row < other.row) ++at;
        sum[std::size_t(other.row)] -= entry.number * other.number;
        rest -= column[at].number * other.number;
      }
      sum[k] -= {-rest.value, -rest.slope};
    }
    Dual own = Dual{1, 0} / a.diagonal[j];
    for (Entry& entry : column) {
      const auto k = std::size_t(entry.row);
      own -= entry.number * sum[k];
      entry.number = sum[k];
      wanted[k] = false;
    }
    a.diagonal[j] = own;
  }
}

Dual entry_of(const Lower& z, Eigen::Index i, Eigen::Index j) {
  if (i == j) return z.diagonal[std::size_t(i)];
  const std::vector<Entry>& column = z.columns[std::size_t(std::min(i, j))];
  return std::lower_bound(column.begin(), column.end(), std::max(i, j),
                          [](const Entry& entry, Eigen::Index row) { return entry.row < row; })
      ->number;
}

// Those blocks of (A + e M)^-1 or its derivative, as `part` takes them from the numbers.
template <class Part>
std::vector<Matrix6> inverted_blocks(const Sparse& a, const Sparse& m,
                                     std::span<const BlockAt> places, Part&& part) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  const Sparse pattern = a.cwiseAbs() + m.cwiseAbs();
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower>(), order);
  // The ordering says which row comes to each place.
  const Eigen::VectorXi place = order.inverse().eval().indices();
  Lower lower = lower_half(a, m, places, place);
  factorise(lower);
  invert(lower);
  std::vector<Matrix6> blocks(places.size());
  each_place(places, [&](std::size_t k, Eigen::Index i, Eigen::Index j) {
    blocks[k](i % 6, j % 6) = part(entry_of(lower, place[i], place[j]));
  });
  return blocks;
}

}  // namespace

std::vector<Matrix6> inverse_blocks(const Sparse& a) {
  std::vector<BlockAt> diagonal;
  for (std::size_t k = 0; k < std::size_t(a.rows() / 6); ++k) diagonal.emplace_back(k, k);
  return inverted_blocks(a, Sparse(a.rows(), a.cols()), diagonal,
                         [](const Dual& number) { return number.value; });
}

std::vector<Matrix6> sandwich_blocks(const Sparse& a, const Sparse& m,
                                     std::span<const BlockAt> places) {
  return inverted_blocks(a, m, places, [](const Dual& number) { return -number.slope; });
}

}  // namespace scan
