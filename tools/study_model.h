// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the runs of a study tell about those that were not done: a Gaussian process over the grid of
// settings and the seeds.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "libscan/core/random.h"
#include "tools/study.h"

namespace scan {

// The logarithm of a run's error or seconds.
struct StudyObservation {
  std::size_t place = 0;  // of its setting in the grid
  int seed = 0;
  double log_value = 0;
};

// Logarithms are, for each seed, f + g_seed + h: f and the g are Gaussian with the covariance
//   C(x, x') = product over the fields k of (1 + w_k c_k(x_k, x'_k))
// between settings (times `seed_share` for g), h is independent from run to run. The product holds
// the effect of each field, of each two together, and so on, the higher the weaker for w_k < 1
// (Durrande et al. 2012). c_k falls with the places between two numbers of a list, and is 0 between
// two different words. Scale, weights, share and h are those under which what was observed is the
// likeliest (Rasmussen and Williams 2006, section 5.4).
class StudyModel {
 public:
  explicit StudyModel(const Study& study);

  // Weights stay as they were while the observations have grown by less than a tenth.
  void fit(const std::vector<StudyObservation>& observations);

  // One drawing of each setting's logarithm, averaged over all seeds, given what was observed.
  Eigen::VectorXd draw(RandomStream& random) const;

  // Their variances given what was observed, in units of the scale.
  Eigen::VectorXd variances() const;

 private:
  struct Shape {
    std::vector<double> weights;  // of the fields
    double seed_share = 0.01;     // of g's variance in f's
    double run_share = 1e-4;      // of h's
  };
  double covariance(const Shape& shape, std::size_t a, std::size_t b) const;
  Eigen::MatrixXd covariances(const Shape& shape) const;
  double log_likelihood(const Shape& shape) const;
  void choose_shape();
  Eigen::MatrixXd covariances_with_observed() const;
  Eigen::VectorXd smooth_drawing(RandomStream& random) const;

  std::vector<Setting> grid_;
  std::vector<Eigen::MatrixXd> correlations_;  // c_k
  int seeds_;
  Shape shape_;
  std::size_t observations_of_shape_ = 0;
  std::vector<StudyObservation> observed_;
  Eigen::VectorXd values_;  // observed, less their mean
  double mean_ = 0, scale_ = 1;
  Eigen::MatrixXd towards_observed_;  // from the averages of all settings
  Eigen::LLT<Eigen::MatrixXd> solver_;
};

}  // namespace scan
