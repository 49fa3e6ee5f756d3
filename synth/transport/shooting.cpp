// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/shooting.h"

#include <cmath>

#include "synth/shape_rays.h"

namespace scan::synth {
namespace {

using Across = Eigen::Matrix<double, 3, 2>;

// A ray with its change by two parameters (Igehy 1999, "Tracing Ray Differentials").
struct Pencil {
  Eigen::Vector3d point, direction;
  Across point_change = Across::Zero();
  Across direction_change;
};

Across frame_across(const Eigen::Vector3d& direction) {
  Across frame;
  frame.col(0) = direction.unitOrthogonal();
  frame.col(1) = direction.cross(frame.col(0));
  return frame;
}

// Distance and outward normal where the ray meets the sheet from the side that the turn asks for.
std::optional<ShapeHit> meet_sheet(const SmoothSurfaces& surfaces, const Turn& turn,
                                   const Pencil& ray) {
  const Sheet& sheet = surfaces.sheets[turn.sheet];
  if (sheet.is_flat) {
    const double slope = sheet.normal.dot(ray.direction);
    const double distance_m = (sheet.offset_m - sheet.normal.dot(ray.point)) / slope;
    if (!(distance_m > 0 && std::isfinite(distance_m)) || (slope > 0) != turn.from_inside)
      return std::nullopt;
    return ShapeHit{distance_m, sheet.normal};
  }
  const SmoothBody& body = surfaces.body_of(turn.sheet);
  auto hit = intersect(body.shape, Ray{ray.point, ray.direction, 1e-10 * body.size_m});
  if (!hit || (hit->normal.dot(ray.direction) > 0) != turn.from_inside ||
      surfaces.sheet_at(sheet.body, 0, hit->normal) != turn.sheet)
    return std::nullopt;
  hit->normal.normalize();
  return hit;
}

// Carries the pencil to the surface, and its change onto the tangent plane (Igehy's eq. 10).
void advance(double distance_m, const Eigen::Vector3d& normal, Pencil& ray) {
  ray.point += distance_m * ray.direction;
  ray.point_change += distance_m * ray.direction_change;
  ray.point_change -=
      ray.direction * (normal.transpose() * ray.point_change) / normal.dot(ray.direction);
}

// Igehy's eqs. 14 to 18; `normal` against the ray, `curvature` its change per metre.
bool turn_pencil(const Eigen::Vector3d& normal, const Eigen::Matrix3d& curvature, bool reflects,
                 double index, Pencil& ray) {
  const auto direction = turned(ray.direction, normal, reflects, index);
  if (!direction) return false;
  const double cosine = -ray.direction.dot(normal);
  const Across normal_change = curvature * ray.point_change;
  const Eigen::RowVector2d cosine_change =
      -(normal.transpose() * ray.direction_change + ray.direction.transpose() * normal_change);
  double along = 2 * cosine, factor = 1;  // direction' = factor direction + along normal
  Eigen::RowVector2d along_change = 2 * cosine_change;
  if (!reflects) {
    factor = 1 / index;
    const double cosine_behind = -direction->dot(normal);
    along = factor * cosine - cosine_behind;
    along_change = (factor - factor * factor * cosine / cosine_behind) * cosine_change;
  }
  ray.direction_change =
      factor * ray.direction_change + normal * along_change + along * normal_change;
  ray.direction = *direction;
  return true;
}

bool is_near(const Shot& shot, double share, double distance_m) {
  return shot.miss.norm() <= share * distance_m && shot.last_m > 0;
}

}  // namespace

std::optional<Eigen::Vector3d> turned(const Eigen::Vector3d& direction,
                                      const Eigen::Vector3d& normal, bool reflects, double index) {
  const double cosine = -direction.dot(normal);
  if (reflects) return (direction + 2 * cosine * normal).normalized();
  const double cosine2_behind = 1 - (1 - cosine) * (1 + cosine) / (index * index);
  if (!(cosine2_behind > 0)) return std::nullopt;
  return (direction / index + (cosine / index - std::sqrt(cosine2_behind)) * normal).normalized();
}

double relative_index(const SmoothSurfaces& surfaces, const Turn& turn) {
  const double index = surfaces.body_of(turn.sheet).index;
  return turn.from_inside ? 1 / index : index;
}

std::optional<Shot> shoot(const SmoothSurfaces& surfaces, const Chain& chain,
                          const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                          const Eigen::Vector3d& target) {
  Shot shot;
  shot.across_first = frame_across(direction);
  Pencil ray{.point = start, .direction = direction, .direction_change = shot.across_first};
  for (int i = 0; i < chain.size; ++i) {
    const Turn& turn = chain.turns[i];
    const auto hit = meet_sheet(surfaces, turn, ray);
    if (!hit) return std::nullopt;
    advance(hit->distance_m, hit->normal, ray);
    shot.points[i] = ray.point;
    shot.normals[i] = hit->normal;
    shot.directions[i] = ray.direction;
    const Sheet& sheet = surfaces.sheets[turn.sheet];
    const double side = turn.from_inside ? -1 : 1;
    const Eigen::Matrix3d curvature =
        side * normal_gradient(surfaces.bodies[sheet.body], sheet, ray.point, hit->normal);
    if (!turn_pencil(side * hit->normal, curvature, turn.reflects, relative_index(surfaces, turn),
                     ray))
      return std::nullopt;
  }
  const Eigen::Vector3d way = target - ray.point;
  shot.directions[chain.size] = ray.direction;
  shot.last_m = ray.direction.dot(way);
  shot.miss = way - shot.last_m * ray.direction;
  const Across across = frame_across(ray.direction);
  shot.gradient = across.transpose() * (ray.point_change + shot.last_m * ray.direction_change);
  shot.miss_across = across.transpose() * shot.miss;
  return shot;
}

std::optional<Shot> solve(const SmoothSurfaces& surfaces, const Chain& chain,
                          const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                          const Eigen::Vector3d& target) {
  const double distance_m = (target - start).norm();
  auto best = shoot(surfaces, chain, start, direction, target);
  for (int iteration = 0; best && iteration < 30; ++iteration) {
    if (is_near(*best, 1e-12, distance_m)) return best;
    Eigen::Vector2d step = best->gradient.partialPivLu().solve(best->miss_across);
    if (!step.allFinite()) return std::nullopt;
    if (step.norm() > 0.5) step *= 0.5 / step.norm();
    bool nearer = false;
    for (int halving = 0; halving < 12 && !nearer; ++halving, step /= 2) {
      const Eigen::Vector3d tried = (best->directions[0] + best->across_first * step).normalized();
      const auto shot = shoot(surfaces, chain, start, tried, target);
      nearer = shot && shot->miss.norm() < best->miss.norm();
      if (nearer) best = shot;
    }
    if (!nearer) break;
  }
  if (best && is_near(*best, 1e-10, distance_m)) return best;
  return std::nullopt;
}

}  // namespace scan::synth
