// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/patch_fit.h"

#include <cmath>
#include <utility>

namespace scan::synth {
namespace {

// Root mean square of a candidate that is new to the others: of coordinates up to 1, of a normal's
// lean in rad.
constexpr double least_part = 1e-3;
constexpr int most_degree = 6;

// Columns by the modified Gram-Schmidt method, each swept twice against rounding.
class Orthonormal {
 public:
  explicit Orthonormal(Eigen::Index rows) : rows_(rows) {}

  void add(Eigen::VectorXd column) {
    for (int sweep = 0; sweep < 2; ++sweep)
      for (const Eigen::VectorXd& other : columns_) column -= other.dot(column) * other;
    const double norm = column.norm();
    if (norm > least_part * std::sqrt(static_cast<double>(rows_)))
      columns_.push_back(column / norm);
  }
  Eigen::Index size() const { return static_cast<Eigen::Index>(columns_.size()); }
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd all(rows_, size());
    for (Eigen::Index i = 0; i < size(); ++i) all.col(i) = columns_[static_cast<std::size_t>(i)];
    return all;
  }

 private:
  Eigen::Index rows_;
  std::vector<Eigen::VectorXd> columns_;
};

}  // namespace

PatchBasis patch_basis(std::span<const PatchPlace> places) {
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixX2d place(count, 2);
  Eigen::MatrixX3d normal(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    place.row(i) = places[static_cast<std::size_t>(i)].place_px;
    normal.row(i) = places[static_cast<std::size_t>(i)].normal;
  }
  const Eigen::RowVector2d low = place.colwise().minCoeff(), high = place.colwise().maxCoeff();
  const double half_px = std::max((high - low).maxCoeff() / 2, 0.5);
  const Eigen::ArrayXd u = (place.col(0).array() - (low[0] + high[0]) / 2) / half_px;
  const Eigen::ArrayXd v = (place.col(1).array() - (low[1] + high[1]) / 2) / half_px;
  const Eigen::Vector3d mean = normal.colwise().sum().normalized();
  const Eigen::Vector3d across = mean.unitOrthogonal();
  Orthonormal columns(count);
  const auto add_degree = [&](int degree) {
    for (int power = 0; power <= degree; ++power) columns.add(u.pow(degree - power) * v.pow(power));
  };
  PatchBasis basis;
  for (int degree = 0; degree <= most_degree; ++degree) {
    const Eigen::Index more = degree + 1 + (degree == 2 ? 2 : 0);
    if (degree > 1 && 3 * (columns.size() + more) > count) break;
    add_degree(degree);
    if (degree == 2) {
      columns.add(normal * across);
      columns.add(normal * mean.cross(across));
    }
    basis.count.push_back(columns.size());
  }
  basis.functions = columns.matrix();
  return basis;
}

Spread spread_of(const std::array<Eigen::ArrayXd, patch_streams>& values) {
  Spread spread{.mean = values[0], .variance = Eigen::ArrayXd::Zero(values[0].size())};
  for (int k = 1; k < patch_streams; ++k) spread.mean += values[k];
  spread.mean /= patch_streams;
  for (const Eigen::ArrayXd& value : values)
    spread.variance += (value - spread.mean).square() / (patch_streams * (patch_streams - 1));
  return spread;
}

// For a fit that lacks nothing the residuals' square over what chance leaves is 1 and scatters by
// sqrt(2 / n + 2 / 3n) for n pixels of normal values; six times that is significant.
PatchFit fit_patch(PatchBasis basis, const std::array<Eigen::MatrixXd, patch_streams>& values) {
  PatchFit fit{.basis = std::move(basis)};
  const Eigen::MatrixXd& q = fit.basis.functions;
  std::array<Eigen::ArrayXd, patch_streams> first;
  for (int k = 0; k < patch_streams; ++k) {
    fit.coefficients[k] = q.transpose() * values[k];
    first[k] = values[k].col(0).array();
  }
  const Spread spread = spread_of(first);
  const Eigen::VectorXd mean = spread.mean;
  const auto pixels = static_cast<double>(q.rows()), free = pixels - static_cast<double>(q.cols());
  const double residual = (mean - q * (q.transpose() * mean)).squaredNorm() / pixels;
  fit.pixel_chance = spread.variance.mean();
  const double expected = fit.pixel_chance * free / pixels;
  if (residual > expected * (1 + 6 * std::sqrt(8 / (3 * pixels))))
    fit.structure = residual - expected;
  return fit;
}

}  // namespace scan::synth
