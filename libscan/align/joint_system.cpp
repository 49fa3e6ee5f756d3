// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_system.h"

#include <cmath>

namespace scan {
namespace {

void add_block(JointEntries& entries, Eigen::Index row, Eigen::Index column, const Matrix6& block) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      entries.push_back({static_cast<int>(row + i), static_cast<int>(column + j), block(i, j)});
}

constexpr double rounding_share = 1e-10;  // as in observability.cpp

}  // namespace

Matrix6 rounding_of(const Matrix6& matrix) {
  return rounding_share * std::max(matrix.trace() / 6, 1e-300) * Matrix6::Identity();
}

Matrix6 twist_to_form(const JointFrame& frame, std::size_t scan, const JointForm& form) {
  Matrix6 carry = Matrix6::Identity();
  carry.bottomLeftCorner<3, 3>() =
      -cross_matrix(form.frame.centre - frame.centres[scan]) / form.frame.size_m;
  carry.bottomRightCorner<3, 3>() *= frame.size_m / form.frame.size_m;
  return carry;
}

JointSystem::JointSystem(std::span<const JointForm> forms, const JointFrame& frame)
    : forms_(forms), frame_(frame), row_(frame.centres.size(), -1) {
  std::vector<bool> used(frame.centres.size(), false);
  for (const JointForm& form : forms) used[form.source] = used[form.target] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i] || !frame.free[i]) continue;
    row_[i] = rows_;
    rows_ += 6;
  }
}

JointEntries JointSystem::assemble(std::span<const Matrix6> matrices) const {
  JointEntries entries;
  for (std::size_t k = 0; k < forms_.size(); ++k) {
    const JointForm& form = forms_[k];
    for (const std::size_t i : {form.source, form.target})
      for (const std::size_t j : {form.source, form.target}) {
        if (!has(i) || !has(j)) continue;
        const double sign = i == j ? 1 : -1;
        add_block(entries, row(i), row(j),
                  sign * twist_to_form(frame_, i, form).transpose() * matrices[k] *
                      twist_to_form(frame_, j, form));
      }
  }
  return entries;
}

JointEntries JointSystem::sum_of(std::span<const JointDetail> details) const {
  std::vector<Matrix6> matrices;
  for (const JointDetail& detail : details)
    matrices.push_back(detail.curvature + rounding_of(detail.curvature));
  return assemble(matrices);
}

Eigen::VectorXd JointSystem::right_side() const {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows_);
  for (const JointForm& form : forms_) {
    if (has(form.source))
      b.segment<6>(row(form.source)) +=
          twist_to_form(frame_, form.source, form).transpose() * form.b;
    if (has(form.target))
      b.segment<6>(row(form.target)) -=
          twist_to_form(frame_, form.target, form).transpose() * form.b;
  }
  return b;
}

JointEntries JointSystem::information(const GuessPrior& prior) const {
  JointEntries entries;
  for (std::size_t i = 0; i < prior.information.size(); ++i)
    if (has(i)) add_block(entries, row(i), row(i), prior.information[i]);
  return entries;
}

Eigen::VectorXd JointSystem::right_side(const GuessPrior& prior) const {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows_);
  for (std::size_t i = 0; i < prior.information.size(); ++i)
    if (has(i)) b.segment<6>(row(i)) = prior.information[i] * prior.twists[i];
  return b;
}

PlacePulls JointSystem::pulls_by_place(std::span<const JointDetail> details,
                                       std::span<const double> factors) const {
  PlacePulls places;
  for (std::size_t k = 0; k < forms_.size(); ++k) {
    const JointForm& form = forms_[k];
    for (const std::size_t scan : {form.source, form.target}) {
      if (!has(scan)) continue;
      const Matrix6 carry = (scan == form.source ? factors[k] : -factors[k]) *
                            twist_to_form(frame_, scan, form).transpose();
      for (const PatchPull& pull : details[k].pulls) {
        Vector6& sum = places[pull.place].try_emplace(scan, Vector6::Zero()).first->second;
        sum += carry * pull.gradient;
      }
    }
  }
  return places;
}

JointEntries JointSystem::scatter(const PlacePulls& places) const {
  // Added up block by block: each place meets few scans, each couple of scans many places.
  std::map<std::pair<std::size_t, std::size_t>, Matrix6> blocks;
  for (const auto& [place, pulls] : places)
    for (const auto& [i, a] : pulls)
      for (const auto& [j, b] : pulls) {
        Matrix6& sum = blocks.try_emplace({i, j}, Matrix6::Zero()).first->second;
        sum += a * b.transpose();
      }
  JointEntries entries;
  for (const auto& [scans, block] : blocks)
    add_block(entries, row(scans.first), row(scans.second), block);
  return entries;
}

std::vector<Vector6> JointSystem::twists(const Eigen::VectorXd& x) const {
  std::vector<Vector6> all(row_.size(), Vector6::Zero());
  for (std::size_t i = 0; i < all.size(); ++i)
    if (has(i)) all[i] = x.segment<6>(row(i));
  return all;
}

JointBasis JointSystem::expanded(const Eigen::MatrixXd& columns) const {
  JointBasis all = JointBasis::Zero(6 * Eigen::Index(row_.size()), columns.cols());
  if (columns.cols() == 0) return all;  // a matrix without elements has no blocks to point to
  for (std::size_t i = 0; i < row_.size(); ++i)
    if (has(i)) all.middleRows<6>(6 * Eigen::Index(i)) = columns.middleRows<6>(row(i));
  return all;
}

Eigen::MatrixXd JointSystem::reduced(const JointBasis& columns) const {
  Eigen::MatrixXd part(rows_, columns.cols());
  if (columns.cols() == 0) return part;
  for (std::size_t i = 0; i < row_.size(); ++i)
    if (has(i)) part.middleRows<6>(row(i)) = columns.middleRows<6>(6 * Eigen::Index(i));
  return part;
}

}  // namespace scan
