// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/study_model.h"

namespace scan {
namespace {

constexpr std::size_t share_of_grid = 5;
constexpr std::size_t share_of_first = 4;  // of those runs, before what was seen tells where to go
constexpr std::uint32_t drawings = 128;    // of the whole grid, to tell what may be the advice

bool is_known(const StudyPoint& point) {
  return std::isfinite(point.error);
}

// As many as a model of the fields' own effects has unknowns.
std::size_t first_runs(const Study& study) {
  std::size_t runs = 1;
  for (const Variation& variation : study.vary) runs += variation.choices.size() - 1;
  return runs;
}

// What the runs of each setting left, seed by seed, for the model. Runs that failed count as ten
// times worse than the worst, so that their neighbours are held for bad.
std::vector<StudyObservation> observed(const std::vector<StudyPoint>& points,
                                       std::vector<double> StudyPoint::*quantity) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const StudyPoint& point : points)
    for (const double value : point.*quantity)
      if (std::isfinite(value) && value > 0) {
        least = std::min(least, value);
        most = std::max(most, value);
      }
  if (most == 0) least = most = 1;
  std::vector<StudyObservation> observations;
  for (std::size_t place = 0; place < points.size(); ++place)
    for (std::size_t seed = 0; seed < points[place].runs; ++seed) {
      const double value = (points[place].*quantity)[seed];
      const double shown = std::isfinite(value) ? std::max(value, least / 10) : 10 * most;
      observations.push_back({place, static_cast<int>(seed), std::log(shown)});
    }
  return observations;
}

class Search {
 public:
  Search(const Study& study, double tolerance, const Measure& measure)
      : study_(study),
        tolerance_(tolerance),
        measure_(measure),
        seeds_(static_cast<std::size_t>(study.seeds)),
        error_(study),
        seconds_(study) {
    for (const Setting& setting : grid(study)) points_.push_back({.setting = setting});
    runs_left_ = std::max(points_.size() * seeds_ / share_of_grid, first_runs(study) + seeds_ - 1);
  }

  // Where the model knows least.
  void run_first() {
    for (std::size_t left = std::min(first_runs(study_), runs_left_ / share_of_first); left > 0;
         --left) {
      Eigen::VectorXd variances = error_.variances();
      for (std::size_t i = 0; i < points_.size(); ++i)
        if (points_[i].runs > 0) variances(static_cast<Eigen::Index>(i)) = -1;
      Eigen::Index place;
      variances.maxCoeff(&place);
      run_once_more(static_cast<std::size_t>(place));
      error_.fit(observed(points_, &StudyPoint::errors));
    }
  }

  // Runs what is most often the advice, until that has run with all its seeds in every drawing.
  void run_what_may_be_advised() {
    while (runs_left_ > 0) {
      error_.fit(observed(points_, &StudyPoint::errors));
      seconds_.fit(observed(points_, &StudyPoint::seed_seconds));
      const std::vector<std::size_t> times = times_advised();
      std::size_t next = points_.size();
      for (std::size_t i = 0; i < points_.size(); ++i)
        if (can_be_completed(points_[i]) && times[i] > (next < points_.size() ? times[next] : 0))
          next = i;
      if (next == points_.size()) return;
      run_once_more(next);
    }
  }

  std::vector<StudyPoint> take() {
    std::erase_if(points_, [](const StudyPoint& point) { return point.runs == 0; });
    mark_front(points_);
    return std::move(points_);
  }

 private:
  bool can_be_completed(const StudyPoint& point) const {
    return point.runs < seeds_ && seeds_ - point.runs <= runs_left_;
  }

  void run_once_more(std::size_t place) {
    StudyPoint& point = points_[place];
    point = measure_(point.setting, static_cast<int>(point.runs) + 1);
    --runs_left_;
  }

  // How often each setting is the advice, were the others as they are drawn.
  std::vector<std::size_t> times_advised() const {
    std::vector<std::size_t> times(points_.size(), 0);
    for (std::uint32_t i = 0; i < drawings; ++i) {
      RandomStream random(runs_left_, i, 0);
      const Eigen::VectorXd error = error_.draw(random), seconds = seconds_.draw(random);
      std::vector<StudyPoint> drawn = points_;
      for (std::size_t place = 0; place < drawn.size(); ++place) {
        if (drawn[place].runs < seeds_) {
          drawn[place].error = std::exp(error(static_cast<Eigen::Index>(place)));
          drawn[place].seconds = std::exp(seconds(static_cast<Eigen::Index>(place)));
        }
        drawn[place].runs = seeds_;
      }
      if (const auto best = advised(drawn, tolerance_)) ++times[*best];
    }
    return times;
  }

  const Study& study_;
  double tolerance_;
  const Measure& measure_;
  std::size_t seeds_, runs_left_ = 0;
  StudyModel error_, seconds_;
  std::vector<StudyPoint> points_;  // of the whole grid
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
  std::size_t most_runs = 0;
  for (const StudyPoint& point : points) most_runs = std::max(most_runs, point.runs);
  std::optional<std::size_t> cheapest, best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_known(points[i]) || points[i].runs < most_runs) continue;
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
  search.run_first();
  search.run_what_may_be_advised();
  return search.take();
}

}  // namespace scan
