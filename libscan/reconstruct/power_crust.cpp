// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/power_crust.h"

#include "libscan/core/error.h"
#ifdef LIBSCAN_WITH_CGAL
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/collapsing_mesh.h"
#include "libscan/reconstruct/noise.h"
#include "libscan/reconstruct/polar_balls.h"
#include "libscan/reconstruct/support.h"
#include "libscan/search/neighbour_search.h"
#endif

namespace scan {

#ifdef LIBSCAN_WITH_CGAL
namespace {

// Balls among points that scatter by sigma about a surface are held by points on either side of it,
// nearly all of which lie within twice sigma.
constexpr double least_radius_sigmas = 4;
constexpr std::size_t fewest_for_sigma = 16;  // estimate_sigma()
// Of a corner's equations: what rounding has made of equal rows is below 1e-15 times the balls'
// distances by the spacing.
constexpr double least_singular_share = 1e-6;
// Of those whose determinant is above, no singular value is below two thirds of this.
constexpr double safe_determinant = 1e-5;
constexpr double short_edge_spacings = 0.1;

double scatter_of(const PointCloud& cloud) {
  if (!cloud.sigma_m.empty()) return median(cloud.sigma_m);
  return cloud.size() < fewest_for_sigma ? 0 : estimate_sigma(cloud.points);
}

// Where four balls have equal power: a unit row for each after the first.
struct EqualPower {
  Eigen::Matrix3d rows;
  Eigen::Vector3d right;  // about the first one's centre
};

EqualPower equal_power(const std::array<Ball, 4>& balls) {
  EqualPower equations;
  for (int k = 0; k < 3; ++k) {
    const Ball &first = balls[0], &other = balls[k + 1];
    const Eigen::Vector3d apart = other.centre - first.centre;
    const double length = apart.norm();
    equations.rows.row(k) = apart / length;
    equations.right[k] =
        (apart.squaredNorm() - other.radius * other.radius + first.radius * first.radius) /
        (2 * length);
  }
  return equations;
}

// How far a place is from the farthest of the balls' surfaces.
double off_surfaces(const std::array<Ball, 4>& balls, const Eigen::Vector3d& place) {
  double off = 0;
  for (const Ball& ball : balls)
    off = std::max(off, std::abs((place - ball.centre).norm() - ball.radius));
  return off;
}

// Where four balls have equal power. Of planes that nearly coincide it cannot be told whether they
// do but for rounding, and meet anywhere, or where they say, as those of balls along a straight
// axis: there it is the place nearest to all four surfaces, of the latter and of those nearest to
// the points that the balls touch.
Eigen::Vector3d power_centre(const std::array<std::uint32_t, 4>& corner, const PolarBalls& polar) {
  const std::array<Ball, 4> balls{polar.balls[corner[0]], polar.balls[corner[1]],
                                  polar.balls[corner[2]], polar.balls[corner[3]]};
  const auto [rows, right] = equal_power(balls);
  if (std::abs(rows.determinant()) > safe_determinant)
    return balls[0].centre + rows.inverse() * right;
  Eigen::JacobiSVD<Eigen::Matrix3d> svd(rows, Eigen::ComputeFullU | Eigen::ComputeFullV);
  double least = unlimited_m;
  Eigen::Vector3d found = polar.touched[corner[0]];
  for (const double singular_share : {0.0, least_singular_share}) {
    svd.setThreshold(singular_share);
    for (const std::uint32_t ball : corner) {
      const Eigen::Vector3d& touched = polar.touched[ball];
      const Eigen::Vector3d place = touched + svd.solve(right - rows * (touched - balls[0].centre));
      const double off = off_surfaces(balls, place);
      if (!(off < least)) continue;
      least = off;
      found = place;
    }
  }
  return found;
}

// The faces between cells inside and cells outside, in triangles. What has no bounds lies outside.
Mesh crust_of(const PowerDiagram& diagram, const PolarBalls& polar,
              std::span<const char> is_inside) {
  const auto inside = [&](std::uint32_t ball) {
    return is_inside[ball] && !diagram.is_unbounded[ball];
  };
  Mesh all{.vertices = std::vector<Eigen::Vector3d>(diagram.corners.size())};
  for (const PowerFace& face : diagram.faces) {
    if (inside(face.first) == inside(face.second)) continue;
    const std::span<const std::uint32_t> c = diagram.corners_of(face);
    for (std::size_t k = 2; k < c.size(); ++k)
      if (inside(face.first))
        all.triangles.push_back({c[0], c[k - 1], c[k]});
      else
        all.triangles.push_back({c[0], c[k], c[k - 1]});
  }
  std::vector<std::uint32_t> corner_of;
  Mesh crust = kept_triangles(all, std::vector<char>(all.triangles.size(), 1), corner_of);
  parallel_for(crust.vertices.size(), [&](std::size_t v) {
    crust.vertices[v] = power_centre(diagram.corners[corner_of[v]], polar);
  });
  return crust;
}

struct Edge {
  double length_m;
  std::uint32_t a, b;
  bool operator<(const Edge& other) const {
    return std::tie(length_m, a, b) < std::tie(other.length_m, other.a, other.b);
  }
};

// Those no longer than the limit, the shortest first.
std::vector<Edge> short_edges(const CollapsingMesh& mesh, std::size_t triangles, double limit_m) {
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    if (!mesh.is_alive(t)) continue;
    const Triangle& c = mesh.triangle(t);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = c[k], b = c[(k + 1) % 3];
      if (a > b) continue;
      const double length_m = (mesh.at(a) - mesh.at(b)).norm();
      if (length_m <= limit_m) edges.push_back({length_m, a, b});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// Cells' faces have edges of any length, many of none: the short ones go, the shortest first. What
// goes makes way for others.
Mesh without_short_edges(const Mesh& mesh, double limit_m) {
  CollapsingMesh left(mesh);
  for (std::size_t before = 0; before != left.alive();) {
    before = left.alive();
    for (const Edge& edge : short_edges(left, mesh.triangles.size(), limit_m)) {
      if (left.around(edge.a).empty() || left.around(edge.b).empty()) continue;
      const Eigen::Vector3d middle = (left.at(edge.a) + left.at(edge.b)) / 2;
      if (left.may_collapse(edge.a, edge.b, middle)) left.collapse(edge.a, edge.b, middle);
    }
  }
  return left.mesh();
}

}  // namespace

SurfaceResult power_crust(const PointCloud& cloud, std::span<const double> spacing_m) {
  check(cloud);
  const Stopwatch watch;
  if (spacing_m.size() != cloud.size())
    throw Error(Trouble::input, "cloud: " + std::to_string(spacing_m.size()) + " spacings for " +
                                    std::to_string(cloud.size()) + " points");
  const std::vector<std::uint32_t> valid = finite_points(cloud);
  if (valid.size() < 4)
    throw Error(Trouble::input,
                "cloud: " + std::to_string(valid.size()) + " finite points, at least 4 needed");
  PointCloud used = subset(cloud, valid);
  const Eigen::Vector3d middle = bounds_of(used.points).center();
  for (auto& x : used.points) x -= middle;  // a large offset would cost the centres their digits
  std::vector<double> used_spacing_m;
  for (const std::uint32_t i : valid) used_spacing_m.push_back(spacing_m[i]);
  SurfaceResult result;
  result.sigma_m = scatter_of(used);
  PolarBalls polar = polar_balls(used.points, used_spacing_m, least_radius_sigmas * result.sigma_m);
  const PowerDiagram diagram = power_diagram(polar.balls);
  std::vector<PolarTie> ties = std::move(polar.opposites);
  for (const PowerFace& face : diagram.faces)
    ties.push_back({face.first, face.second,
                    same_side_certainty(polar.balls[face.first], polar.balls[face.second]), true});
  const Mesh crust =
      crust_of(diagram, polar, label_inside(polar.balls.size(), ties, polar.is_outer));
  if (crust.empty())
    throw Error(Trouble::computation, "power-crust: the points enclose nothing",
                "a sheet has no inside: try mls or delaunay");
  result.surface = without_short_edges(crust, short_edge_spacings * median(used_spacing_m));
  result.support_m = distance_to_points(result.surface, used.points);
  for (auto& x : result.surface.vertices) x += middle;
  result.unknowns = polar.balls.size();
  result.stop = SolveStop::direct;
  result.invalid_points = cloud.size() - used.size();
  result.cost.seconds = watch.seconds();
  return result;
}
#else
SurfaceResult power_crust(const PointCloud&, std::span<const double>) {
  throw Error(Trouble::usage, "power-crust: libscan was built without CGAL",
              "configure with -DLIBSCAN_WITH_CGAL=ON");
}
#endif

}  // namespace scan
