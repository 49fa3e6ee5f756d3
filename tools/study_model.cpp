// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study_model.h"

#include <algorithm>
#include <cmath>

namespace scan {
namespace {

constexpr double correlation_length = 2;  // places in a list of numbers
constexpr double usual_weight = 0.5;

bool is_ordered(const Variation& variation) {
  return std::all_of(variation.choices.begin(), variation.choices.end(),
                     [](const Choice& choice) { return choice.label.is_number(); });
}

Eigen::MatrixXd correlation_of(const Variation& variation) {
  const auto count = static_cast<Eigen::Index>(variation.choices.size());
  if (!is_ordered(variation)) return Eigen::MatrixXd::Identity(count, count);
  return Eigen::MatrixXd::NullaryExpr(count, count, [](Eigen::Index i, Eigen::Index j) {
    return std::exp(-std::abs(static_cast<double>(i - j)) / correlation_length);
  });
}

// (A x B x ...) v, the last factor counting fastest, as grid() does.
Eigen::VectorXd kronecker_times(const std::vector<Eigen::MatrixXd>& factors, Eigen::VectorXd v) {
  for (auto factor = factors.rbegin(); factor != factors.rend(); ++factor) {
    const Eigen::Index width = factor->rows(), rest = v.size() / width;
    const Eigen::MatrixXd turned = (*factor * v.reshaped(width, rest)).transpose();
    v = turned.reshaped();
  }
  return v;
}

}  // namespace

StudyModel::StudyModel(const Study& study) : grid_(grid(study)), seeds_(study.seeds) {
  for (const Variation& variation : study.vary) correlations_.push_back(correlation_of(variation));
  shape_.weights.assign(study.vary.size(), usual_weight);
}

double StudyModel::covariance(const Shape& shape, std::size_t a, std::size_t b) const {
  double product = 1;
  for (std::size_t k = 0; k < correlations_.size(); ++k)
    product *= 1 + shape.weights[k] * correlations_[k](static_cast<Eigen::Index>(grid_[a][k]),
                                                       static_cast<Eigen::Index>(grid_[b][k]));
  return product;
}

Eigen::MatrixXd StudyModel::covariances(const Shape& shape) const {
  const auto count = static_cast<Eigen::Index>(observed_.size());
  return Eigen::MatrixXd::NullaryExpr(count, count, [&](Eigen::Index i, Eigen::Index j) {
    const StudyObservation &a = observed_[static_cast<std::size_t>(i)],
                           &b = observed_[static_cast<std::size_t>(j)];
    const double smooth = covariance(shape, a.place, b.place);
    return smooth * (a.seed == b.seed ? 1 + shape.seed_share : 1) + (i == j ? shape.run_share : 0);
  });
}

// But for a constant, with the scale under which it is largest.
double StudyModel::log_likelihood(const Shape& shape) const {
  const Eigen::LLT<Eigen::MatrixXd> solver(covariances(shape));
  const auto count = static_cast<double>(values_.size());
  const double scale2 = values_.dot(solver.solve(values_)) / count;
  const double log_root_determinant = solver.matrixLLT().diagonal().array().log().sum();
  return -0.5 * count * std::log(std::max(scale2, 1e-30)) - log_root_determinant;
}

// Coordinate by coordinate in steps of a factor, from where the last one was.
void StudyModel::choose_shape() {
  constexpr double step = 2.5;
  double best = log_likelihood(shape_);
  const auto improve = [&](double& value, double least, double most) {
    bool is_better = false;
    for (const double factor : {step, 1 / step})
      for (double before = value; value * factor >= least && value * factor <= most;
           before = value) {
        value *= factor;
        const double likelihood = log_likelihood(shape_);
        if (likelihood <= best) {
          value = before;
          break;
        }
        best = likelihood;
        is_better = true;
      }
    return is_better;
  };
  for (int sweep = 0; sweep < 3; ++sweep) {
    bool is_better = false;
    for (double& weight : shape_.weights) is_better |= improve(weight, 1e-3, 10);
    is_better |= improve(shape_.seed_share, 1e-8, 1);
    is_better |= improve(shape_.run_share, 1e-8, 1);
    if (!is_better) return;
  }
}

void StudyModel::fit(const std::vector<StudyObservation>& observations) {
  observed_ = observations;
  values_.resize(static_cast<Eigen::Index>(observed_.size()));
  for (std::size_t i = 0; i < observed_.size(); ++i)
    values_(static_cast<Eigen::Index>(i)) = observed_[i].log_value;
  mean_ = values_.mean();
  values_.array() -= mean_;
  if (10 * observed_.size() >= 11 * observations_of_shape_) {
    choose_shape();
    observations_of_shape_ = observed_.size();
  }
  solver_.compute(covariances(shape_));
  towards_observed_ = covariances_with_observed();
  scale_ = std::sqrt(values_.dot(solver_.solve(values_)) / static_cast<double>(values_.size()));
}

// Covariances of the settings' averages over the seeds with what was observed.
Eigen::MatrixXd StudyModel::covariances_with_observed() const {
  const double seeds = seeds_;
  return Eigen::MatrixXd::NullaryExpr(
      static_cast<Eigen::Index>(grid_.size()), values_.size(), [&](Eigen::Index i, Eigen::Index j) {
        const auto place = static_cast<std::size_t>(i);
        const StudyObservation& run = observed_[static_cast<std::size_t>(j)];
        return covariance(shape_, place, run.place) * (1 + shape_.seed_share / seeds) +
               (run.place == place ? shape_.run_share / seeds : 0);
      });
}

Eigen::VectorXd StudyModel::variances() const {
  const double of_all =
      covariance(shape_, 0, 0) * (1 + shape_.seed_share / seeds_) + shape_.run_share / seeds_;
  if (observed_.empty())
    return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(grid_.size()), of_all);
  const Eigen::MatrixXd known = solver_.matrixL().solve(towards_observed_.transpose());
  return of_all - known.colwise().squaredNorm().transpose().array();
}

// f or g of all settings, before anything is known of them and without its scale.
Eigen::VectorXd StudyModel::smooth_drawing(RandomStream& random) const {
  Eigen::VectorXd normals(static_cast<Eigen::Index>(grid_.size()));
  for (double& normal : normals) normal = random.normal();
  std::vector<Eigen::MatrixXd> roots;
  for (std::size_t k = 0; k < correlations_.size(); ++k) {
    const Eigen::MatrixXd factor = 1 + shape_.weights[k] * correlations_[k].array();
    roots.emplace_back(factor.llt().matrixL());
  }
  return kronecker_times(roots, normals);
}

// Matheron's rule: a drawing that knows nothing, and what moves it to the observations (Wilson et
// al. 2020, equation 9).
Eigen::VectorXd StudyModel::draw(RandomStream& random) const {
  const Eigen::Index count = static_cast<Eigen::Index>(grid_.size());
  const Eigen::VectorXd smooth = smooth_drawing(random);
  Eigen::MatrixXd of_seed(count, seeds_);
  for (int s = 0; s < seeds_; ++s) {
    of_seed.col(s) = smooth + std::sqrt(shape_.seed_share) * smooth_drawing(random);
    for (double& value : of_seed.col(s)) value += std::sqrt(shape_.run_share) * random.normal();
  }
  Eigen::VectorXd missed(values_.size());
  for (std::size_t i = 0; i < observed_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double drawn = of_seed(static_cast<Eigen::Index>(observed_[i].place), observed_[i].seed);
    missed(at) = values_(at) - scale_ * drawn;
  }
  return (mean_ + scale_ * of_seed.rowwise().mean().array()).matrix() +
         towards_observed_ * solver_.solve(missed);
}

}  // namespace scan
