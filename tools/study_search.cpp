// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study_search.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace scan {
namespace {

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
  std::vector<StudyPoint> tried;
  for (const Setting& setting : star(study)) tried.push_back(measure(setting, 1));
  while (true) {
    const auto points = estimated(study, tried);
    const auto best = advised(points, tolerance);
    if (!best) break;
    const StudyPoint& next = points[*best];
    if (next.runs >= static_cast<std::size_t>(study.seeds)) break;
    if (next.runs == 0) {
      tried.push_back(measure(next.setting, 1));
      continue;
    }
    const auto found = std::find_if(tried.begin(), tried.end(), [&](const StudyPoint& point) {
      return point.setting == next.setting;
    });
    *found = measure(next.setting, study.seeds);
  }
  mark_front(tried);
  return tried;
}

}  // namespace scan
