// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/decimate.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <tuple>

#include "libscan/core/error.h"
#include "libscan/core/shortest.h"
#include "libscan/reconstruct/collapsing_mesh.h"
#include "libscan/reconstruct/support.h"
#include "libscan/search/hausdorff.h"

namespace scan {
namespace {

constexpr double rim_weight = 10;  // a rim's shape against that of the surface beside it
constexpr double inner_share =
    0.9;  // of the tolerance, for the points that are looked at on the way
constexpr int most_attempts = 4;
// Along the seams of the other mesh parts must be as short as some tolerances. Tori of 200,000
// triangles take 50 for each with a thirteenth of an edge as the tolerance, 130 with a thirtieth.
constexpr std::size_t most_queries_per_triangle = 500;

// Sum of squared distances from planes, about an origin near them.
struct Quadric {
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  double constant = 0;

  void add_plane(double weight, const Eigen::Vector3d& normal, double offset) {
    square += weight * normal * normal.transpose();
    linear += weight * offset * normal;
    constant += weight * offset * offset;
  }
  void operator+=(const Quadric& other) {
    square += other.square;
    linear += other.linear;
    constant += other.constant;
  }
  double at(const Eigen::Vector3d& x) const {
    return x.dot(square * x) + 2 * linear.dot(x) + constant;
  }
};

struct Candidate {
  double cost;
  std::uint32_t kept, gone, version;
  Eigen::Vector3d place;
  // The cheapest comes first; ties by number.
  bool operator<(const Candidate& other) const {
    return std::tie(cost, kept, gone, version) >
           std::tie(other.cost, other.kept, other.gone, other.version);
  }
};

class Decimator {
 public:
  Decimator(const Mesh& mesh, const MeshSearch& search, double tolerance_m)
      : origin_(mesh.vertices.front()),
        mesh_(mesh),
        old_(mesh),
        search_(search),
        tolerance_m_(tolerance_m),
        quadrics_(mesh.vertices.size()),
        versions_(mesh.vertices.size(), 0),
        stands_for_(mesh.triangles.size()) {
    for (const Triangle& t : mesh.triangles) add_planes(t);
    places_ = mesh.vertices;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
      if (!mesh_.around(v).empty()) stands_for_[mesh_.around(v).front()].push_back(v);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
        if (a > b && !is_rim(a, b)) continue;
        stands_for_[i].push_back(static_cast<std::uint32_t>(places_.size()));
        places_.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
        push(a, b);
      }
  }

  Mesh run() {
    while (!queue_.empty()) {
      const Candidate c = queue_.top();
      queue_.pop();
      if (c.version != versions_[c.kept] + versions_[c.gone] || mesh_.around(c.kept).empty() ||
          mesh_.around(c.gone).empty())
        continue;
      if (mesh_.may_collapse(c.kept, c.gone, c.place) && collapse_within_tolerance(c)) requeue(c);
    }
    return mesh_.mesh();
  }

 private:
  bool is_rim(std::uint32_t a, std::uint32_t b) const {
    int triangles = 0;
    for (const std::uint32_t t : mesh_.around(a))
      triangles += std::count(mesh_.triangle(t).begin(), mesh_.triangle(t).end(), b) > 0;
    return triangles == 1;
  }

  void add_planes(const Triangle& t) {
    const Eigen::Vector3d twice = area_vector(old_, t);
    const double area = twice.norm() / 2;
    if (!(area > 0)) return;
    const Eigen::Vector3d normal = twice / (2 * area);
    const auto add = [&](std::uint32_t v, double weight, const Eigen::Vector3d& n) {
      quadrics_[v].add_plane(weight, n, -n.dot(mesh_.at(t[0]) - origin_));
    };
    for (const std::uint32_t v : t) add(v, area / 3, normal);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (!is_rim(a, b)) continue;
      const Eigen::Vector3d along = mesh_.at(b) - mesh_.at(a);
      const Eigen::Vector3d across = along.cross(normal).normalized();
      for (const std::uint32_t v : {a, b})
        quadrics_[v].add_plane(rim_weight * along.squaredNorm(), across,
                               -across.dot(mesh_.at(a) - origin_));
    }
  }

  // The place of least cost, or the better of ends and middle where there is no clear one.
  void push(std::uint32_t a, std::uint32_t b) {
    Quadric sum = quadrics_[a];
    sum += quadrics_[b];
    const Eigen::Vector3d ends[3] = {mesh_.at(a) - origin_, mesh_.at(b) - origin_,
                                     (mesh_.at(a) + mesh_.at(b)) / 2 - origin_};
    Eigen::Vector3d best = ends[0];
    for (const Eigen::Vector3d& x : ends)
      if (sum.at(x) < sum.at(best)) best = x;
    // Held lightly to the middle, so that along a plane or an edge it stays beside the mesh's edge.
    const double hold = 1e-3 * sum.square.trace();
    if (hold > 0) {
      const Eigen::Vector3d solved = (sum.square + hold * Eigen::Matrix3d::Identity())
                                         .ldlt()
                                         .solve(hold * ends[2] - sum.linear);
      if (solved.allFinite() && sum.at(solved) < sum.at(best)) best = solved;
    }
    queue_.push({sum.at(best), a, b, versions_[a] + versions_[b], best + origin_});
  }

  using Corners = std::array<Eigen::Vector3d, 3>;

  // Undone if an old place is too far from all triangles that come, or one of these from the old
  // surface.
  bool collapse_within_tolerance(const Candidate& c) {
    const double inner_m = inner_share * tolerance_m_;
    if (search_.closest(c.place).distance_m > inner_m) return false;
    std::vector<std::uint32_t> star(mesh_.around(c.kept).begin(), mesh_.around(c.kept).end());
    star.insert(star.end(), mesh_.around(c.gone).begin(), mesh_.around(c.gone).end());
    std::sort(star.begin(), star.end());
    star.erase(std::unique(star.begin(), star.end()), star.end());
    std::vector<std::uint32_t> left;
    std::vector<Corners> corners;
    for (const std::uint32_t t : star) {
      const Triangle& old = mesh_.triangle(t);
      const auto has = [&](std::uint32_t v) { return std::count(old.begin(), old.end(), v) > 0; };
      if (has(c.kept) && has(c.gone)) continue;
      left.push_back(t);
      Corners& places = corners.emplace_back();
      for (int k = 0; k < 3; ++k)
        places[k] = old[k] == c.kept || old[k] == c.gone ? c.place : mesh_.at(old[k]);
      if (!is_near(places, inner_m)) return false;
    }
    std::vector<std::vector<std::uint32_t>> lists(left.size());
    if (!share_out(star, corners, inner_m, lists)) return false;
    for (const std::uint32_t t : star) stands_for_[t] = {};
    for (std::size_t i = 0; i < left.size(); ++i) stands_for_[left[i]] = std::move(lists[i]);
    mesh_.collapse(c.kept, c.gone, c.place);
    return true;
  }

  // The places that the star stands for go to the nearest of the triangles that come; false if one
  // is too far from all.
  bool share_out(const std::vector<std::uint32_t>& star, const std::vector<Corners>& corners,
                 double inner_m, std::vector<std::vector<std::uint32_t>>& lists) const {
    for (const std::uint32_t t : star)
      for (const std::uint32_t place : stands_for_[t]) {
        const Eigen::Vector3d& x = places_[place];
        double least2 = inner_m * inner_m;
        std::size_t nearest = corners.size();
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const auto& [p, q, r] = corners[i];
          const double d2 = (x - closest_point_on_triangle(x, p, q, r)).squaredNorm();
          if (d2 > least2) continue;
          least2 = d2;
          nearest = i;
        }
        if (nearest == corners.size()) return false;
        lists[nearest].push_back(place);
      }
    return true;
  }

  // Whether a new triangle's middle and those of its sides are near the old surface.
  bool is_near(const Corners& c, double inner_m) const {
    const auto near = [&](const Eigen::Vector3d& x) {
      return search_.closest(x).distance_m <= inner_m;
    };
    return near((c[0] + c[1] + c[2]) / 3) && near((c[0] + c[1]) / 2) && near((c[1] + c[2]) / 2) &&
           near((c[2] + c[0]) / 2);
  }

  void requeue(const Candidate& c) {
    quadrics_[c.kept] += quadrics_[c.gone];
    ++versions_[c.kept];
    ++versions_[c.gone];
    for (const std::uint32_t v : mesh_.neighbours(c.kept)) push(c.kept, v);
  }

  Eigen::Vector3d origin_;
  CollapsingMesh mesh_;
  const Mesh& old_;
  const MeshSearch& search_;
  double tolerance_m_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> versions_;
  std::vector<Eigen::Vector3d> places_;                 // the old vertices and middles of edges
  std::vector<std::vector<std::uint32_t>> stands_for_;  // places, by triangle
  std::priority_queue<Candidate> queue_;
};

void carry_over(const Mesh& from, SurfaceResult& result) {
  const Mesh& now = result.surface;
  const auto carry = [&](std::vector<double>& values) {
    if (!values.empty()) values = of_nearest_points(now, from.vertices, values);
  };
  carry(result.support_m);
  carry(result.data_spacing_m);
  carry(result.standard_error_m);
  carry(result.vertex_smoothing_m);
}

}  // namespace

DecimateReport decimate(SurfaceResult& result, double tolerance_m) {
  if (!(tolerance_m > 0))
    throw Error(Trouble::usage,
                "decimate: tolerance is " + shortest(tolerance_m) + " m, must be above 0");
  DecimateReport report{.tolerance_m = tolerance_m,
                        .triangles_before = result.surface.triangles.size()};
  if (result.surface.empty()) return report;
  const MeshSearch search(result.surface);
  const std::size_t most_queries = most_queries_per_triangle * report.triangles_before;
  double inside_m = tolerance_m;
  for (int attempt = 0; attempt < most_attempts; ++attempt, inside_m *= 0.7) {
    Mesh fewer = Decimator(result.surface, search, inside_m).run();
    const double bound_m =
        hausdorff_distance(fewer, result.surface,
                           {.limit_m = tolerance_m, .most_queries = most_queries})
            .high_m;
    if (bound_m > tolerance_m) continue;
    std::swap(result.surface, fewer);
    carry_over(fewer, result);
    report.bound_m = bound_m;
    report.is_proven = true;
    break;
  }
  result.decimation = report;
  return report;
}

}  // namespace scan
