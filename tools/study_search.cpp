// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study_search.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace scan {
namespace {

constexpr std::size_t share_of_grid = 5;
constexpr double model_slack = 1.5;  // so far the model's seconds may be off

bool is_known(const StudyPoint& point) {
  return std::isfinite(point.error);
}

// Where the factor of each variation's value stands among the unknowns; 0 is the common one.
std::vector<Eigen::Index> columns(const Study& study) {
  std::vector<Eigen::Index> first{1};
  for (const Variation& variation : study.vary)
    first.push_back(first.back() + static_cast<Eigen::Index>(variation.choices.size()));
  return first;
}

Eigen::RowVectorXd row_of(const Setting& setting, const std::vector<Eigen::Index>& first) {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(first.back());
  row(0) = 1;
  for (std::size_t i = 0; i < setting.size(); ++i)
    row(first[i] + static_cast<Eigen::Index>(setting[i])) = 1;
  return row;
}

// The factors' logarithms by least squares; of the many solutions the shortest, which leaves a
// value that was never tried at the middle of its list's.
Eigen::VectorXd fitted(const std::vector<StudyPoint>& tried, const std::vector<Eigen::Index>& first,
                       double StudyPoint::*quantity) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(tried.size()), first.back());
  Eigen::VectorXd logs = Eigen::VectorXd::Zero(rows.rows());
  rows.setZero();
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (!is_known(tried[i]) || !(tried[i].*quantity > 0)) continue;
    rows.row(static_cast<Eigen::Index>(i)) = row_of(tried[i].setting, first);
    logs(static_cast<Eigen::Index>(i)) = std::log(tried[i].*quantity);
  }
  return rows.completeOrthogonalDecomposition().solve(logs);
}

// Every setting of the grid: as tried, or as the model sees it (then `runs` is 0).
std::vector<StudyPoint> estimated(const Study& study, const std::vector<StudyPoint>& tried) {
  const auto first = columns(study);
  const Eigen::VectorXd error = fitted(tried, first, &StudyPoint::error);
  const Eigen::VectorXd seconds = fitted(tried, first, &StudyPoint::seconds);
  std::vector<StudyPoint> points;
  for (const Setting& setting : grid(study)) {
    const auto found = std::find_if(tried.begin(), tried.end(), [&](const StudyPoint& point) {
      return point.setting == setting;
    });
    const Eigen::RowVectorXd row = row_of(setting, first);
    points.push_back(found != tried.end() ? *found
                                          : StudyPoint{.setting = setting,
                                                       .error = std::exp(row.dot(error)),
                                                       .seconds = std::exp(row.dot(seconds))});
  }
  return points;
}

// The middle of all lists, and what differs from it in one field.
std::vector<Setting> star(const Study& study) {
  Setting middle;
  for (const Variation& variation : study.vary) middle.push_back(variation.choices.size() / 2);
  std::vector<Setting> settings{middle};
  for (std::size_t k = 0; k < study.vary.size(); ++k)
    for (std::size_t i = 0; i < study.vary[k].choices.size(); ++i) {
      Setting setting = middle;
      setting[k] = i;
      if (setting != middle) settings.push_back(setting);
    }
  return settings;
}

int fields_apart(const Setting& a, const Setting& b) {
  int apart = 0;
  for (std::size_t k = 0; k < a.size(); ++k) apart += a[k] != b[k];
  return apart;
}

class Search {
 public:
  Search(const Study& study, double tolerance, const Measure& measure)
      : study_(study),
        tolerance_(tolerance),
        measure_(measure),
        most_runs_(grid(study).size() * static_cast<std::size_t>(study.seeds) / share_of_grid) {}

  void try_once(const Setting& setting) {
    tried_.push_back(measure_(setting, 1));
    ++runs_;
  }

  // Until what is advised has run with all seeds.
  void follow_the_model() {
    while (true) {
      const auto points = estimated(study_, tried_);
      const auto best = advised(points, tolerance_);
      if (!best || points[*best].runs >= static_cast<std::size_t>(study_.seeds)) return;
      if (points[*best].runs == 0)
        try_once(points[*best].setting);
      else
        run_all_seeds(points[*best].setting);
    }
  }

  // Tries one more setting that may be cheaper than the advised one, or better where none is within
  // the tolerance: of those that differ in the fewest fields the best by the model. False if there
  // is none, or no runs for it are left.
  bool look_beside_the_advice() {
    if (runs_ + static_cast<std::size_t>(study_.seeds) > most_runs_) return false;
    const auto points = estimated(study_, tried_);
    const auto best = advised(points, tolerance_);
    if (!best) return false;
    const StudyPoint& incumbent = points[*best];
    const double most_seconds = incumbent.error <= tolerance_
                                    ? model_slack * incumbent.seconds
                                    : std::numeric_limits<double>::infinity();
    const StudyPoint* next = nullptr;
    const auto rank = [&](const StudyPoint& point) {
      return std::pair(fields_apart(point.setting, incumbent.setting), point.error);
    };
    for (const StudyPoint& point : points)
      if (point.runs == 0 && point.seconds < most_seconds && (!next || rank(point) < rank(*next)))
        next = &point;
    if (!next) return false;
    try_once(next->setting);
    return true;
  }

  std::vector<StudyPoint> take() {
    mark_front(tried_);
    return std::move(tried_);
  }

 private:
  void run_all_seeds(const Setting& setting) {
    const auto found = std::find_if(tried_.begin(), tried_.end(), [&](const StudyPoint& point) {
      return point.setting == setting;
    });
    *found = measure_(setting, study_.seeds);
    runs_ += static_cast<std::size_t>(study_.seeds) - 1;
  }

  const Study& study_;
  double tolerance_;
  const Measure& measure_;
  std::size_t most_runs_, runs_ = 0;
  std::vector<StudyPoint> tried_;
};

}  // namespace

void mark_front(std::vector<StudyPoint>& points) {
  for (StudyPoint& point : points)
    point.on_front =
        is_known(point) && std::none_of(points.begin(), points.end(), [&](const StudyPoint& other) {
          return is_known(other) && other.error <= point.error && other.seconds <= point.seconds &&
                 (other.error < point.error || other.seconds < point.seconds);
        });
}

std::optional<std::size_t> advised(const std::vector<StudyPoint>& points, double tolerance) {
  std::optional<std::size_t> cheapest, best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_known(points[i])) continue;
    if (!best || points[i].error < points[*best].error) best = i;
    if (points[i].error <= tolerance &&
        (!cheapest || points[i].seconds < points[*cheapest].seconds))
      cheapest = i;
  }
  return cheapest ? cheapest : best;
}

std::vector<StudyPoint> search_grid(const Study& study, const Measure& measure) {
  std::vector<StudyPoint> points;
  for (const Setting& setting : grid(study)) points.push_back(measure(setting, study.seeds));
  mark_front(points);
  return points;
}

std::vector<StudyPoint> search_adaptively(const Study& study, double tolerance,
                                          const Measure& measure) {
  Search search(study, tolerance, measure);
  for (const Setting& setting : star(study)) search.try_once(setting);
  search.follow_the_model();
  while (search.look_beside_the_advice()) search.follow_the_model();
  return search.take();
}

}  // namespace scan
