// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/polar_balls.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libscan/core/point_cloud.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr double frame_sizes = 5;
constexpr std::uint32_t none = no_point;

// How far a ball's centre may be from those it does for, in spacings of the points; their points
// may be as far from its surface as facets between points are from a curved one, spacing^2 / 8
// radius.
constexpr double beside_spacings = 0.5;

void append_frame(std::vector<Eigen::Vector3d>& points) {
  const Bounds box = bounds_of(points);
  const double half = 0.5 * frame_sizes * box.sizes().maxCoeff();
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    points.push_back(box.center() + half * sign);
  }
}

// A corner of Voronoi cells, and the ball around it that touches their points.
struct Pole {
  Ball ball;
  std::uint32_t point = 0;  // one of them
  bool is_outer = false;    // touches the frame
};

class Poles {
 public:
  Poles(std::span<const Eigen::Vector3d> points, double least_radius)
      : points_(points), least_radius_(least_radius) {
    std::vector<Eigen::Vector3d> framed(points.begin(), points.end());
    append_frame(framed);
    cells_ = voronoi_cells(framed);
    pole_of_.assign(cells_.corners.size(), none);
    std::vector<char> is_outer(cells_.corners.size(), 0);
    for (std::size_t k = points.size(); k < framed.size(); ++k)
      for (const std::uint32_t corner : cells_.of_point[k]) is_outer[corner] = 1;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      for (const std::uint32_t corner : cells_.of_point[i])
        if (is_outer[corner]) list_[add(corner, i)].is_outer = true;
      add_pair(i);
    }
  }

  const std::vector<Pole>& list() const { return list_; }
  // The two poles of a point, by their places in the list.
  const std::vector<PolarTie>& opposites() const { return opposites_; }

 private:
  std::uint32_t add(std::uint32_t corner, std::uint32_t point) {
    if (pole_of_[corner] == none) {
      pole_of_[corner] = static_cast<std::uint32_t>(list_.size());
      const Eigen::Vector3d& centre = cells_.corners[corner];
      list_.push_back({{centre, (centre - points_[point]).norm()}, point});
    }
    return pole_of_[corner];
  }

  // The corner farthest from a point, of those behind it as `towards` sees it.
  std::uint32_t farthest(std::uint32_t point, const Eigen::Vector3d& towards) const {
    std::uint32_t found = none;
    double most2 = least_radius_ * least_radius_;
    for (const std::uint32_t corner : cells_.of_point[point]) {
      const Eigen::Vector3d d = cells_.corners[corner] - points_[point];
      if (towards.dot(d) > 0 || !(d.squaredNorm() > most2)) continue;
      most2 = d.squaredNorm();
      found = corner;
    }
    return found;
  }

  void add_pair(std::uint32_t point) {
    const std::uint32_t first = farthest(point, Eigen::Vector3d::Zero());
    if (first == none) return;
    const Eigen::Vector3d towards = cells_.corners[first] - points_[point];
    const std::uint32_t second = farthest(point, towards);
    const std::uint32_t one = add(first, point);
    if (second == none) return;
    const Eigen::Vector3d away = cells_.corners[second] - points_[point];
    const double certainty = -towards.normalized().dot(away.normalized());
    opposites_.push_back({one, add(second, point), std::min(certainty, 1.0), false});
  }

  std::span<const Eigen::Vector3d> points_;
  double least_radius_;
  VoronoiCells cells_;
  std::vector<std::uint32_t> pole_of_;  // by corner
  std::vector<Pole> list_;
  std::vector<PolarTie> opposites_;
};

// What stands for each pole: the largest first, a ball does for the poles beside it whose points it
// nearly touches, too. So the thousands of equal balls in the middle of a sphere are one, and those
// along the axis of a ring as many as its shape asks for; each one's thin cell would meet all that
// are round it.
std::vector<std::uint32_t> stand_ins(const std::vector<Pole>& poles,
                                     std::span<const Eigen::Vector3d> points,
                                     std::span<const double> spacing) {
  std::vector<std::uint32_t> order(poles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return poles[a].ball.radius > poles[b].ball.radius;
  });
  std::vector<Eigen::Vector3d> centres;
  for (const Pole& pole : poles) centres.push_back(pole.ball.centre);
  const KdTree tree(centres);
  std::vector<std::uint32_t> stand_in(poles.size(), none);
  std::vector<Neighbour> near;
  for (const std::uint32_t i : order) {
    if (stand_in[i] != none) continue;
    const Ball& ball = poles[i].ball;
    tree.within(ball.centre, beside_spacings * spacing[poles[i].point], near);
    for (const Neighbour& n : near) {
      const std::uint32_t touched = poles[n.index].point;
      const double gap = (points[touched] - ball.centre).norm() - ball.radius;
      if (stand_in[n.index] == none && poles[n.index].is_outer == poles[i].is_outer &&
          gap * 8 * ball.radius <= spacing[touched] * spacing[touched])
        stand_in[n.index] = i;
    }
    stand_in[i] = i;
  }
  return stand_in;
}

}  // namespace

PolarBalls polar_balls(std::span<const Eigen::Vector3d> points, std::span<const double> spacing,
                       double least_radius) {
  const Poles poles(points, least_radius);
  const std::vector<std::uint32_t> stand_in = stand_ins(poles.list(), points, spacing);
  PolarBalls polar;
  std::vector<std::uint32_t> number(stand_in.size(), none);
  for (std::uint32_t i = 0; i < stand_in.size(); ++i)
    if (stand_in[i] == i) {
      number[i] = static_cast<std::uint32_t>(polar.balls.size());
      polar.balls.push_back(poles.list()[i].ball);
      polar.touched.push_back(points[poles.list()[i].point]);
      polar.is_outer.push_back(poles.list()[i].is_outer);
    }
  for (PolarTie tie : poles.opposites()) {
    tie.first = number[stand_in[tie.first]];
    tie.second = number[stand_in[tie.second]];
    if (tie.certainty > 0 && tie.first != tie.second) polar.opposites.push_back(tie);
  }
  return polar;
}

}  // namespace scan
