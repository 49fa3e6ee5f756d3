// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/chain_starts.h"

#include <cmath>

namespace scan::synth {
namespace {

constexpr int most_aims = 8;  // at one body

// Facet sequences of one length are looked at as long as they are at most that many.
constexpr double most_sequences = 200;

// Images of the target, from the last reflection to the first. turns[k] is the k-th reflection from
// the target's end; images[k] the target seen over the first k of them, images[0] itself.
struct ImageStack {
  std::array<int, Connection::most_bounces> sheets;
  std::array<bool, Connection::most_bounces> from_inside;
  std::array<Eigen::Vector3d, Connection::most_bounces + 1> images;
  int size = 0;
};

bool meets_rectangle(const Sheet& sheet, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     double slack_m, Eigen::Vector3d& point) {
  const double a = sheet.normal.dot(from) - sheet.offset_m;
  const double b = sheet.normal.dot(to) - sheet.offset_m;
  const double share = a / (a - b);
  if (!(share > -1e-9 && share < 1 + 1e-9)) return false;
  point = from + share * (to - from);
  const Eigen::Vector2d across = sheet.axes.transpose() * (point - sheet.centre);
  return (across.cwiseAbs().array() <= sheet.half_m.array() + slack_m).all();
}

// The unfolded straight line meets every facet in turn, give or take what refraction may shift it,
// and leaves the lamp where it shines.
bool may_be_seen(const SmoothSurfaces& surfaces, const ImageStack& stack, const Lamp& lamp,
                 Eigen::Vector3d from) {
  const double length_m = (stack.images[stack.size] - from).norm();
  for (int k = stack.size; k-- > 0;) {
    const Sheet& sheet = surfaces.sheets[stack.sheets[k]];
    Eigen::Vector3d point;
    if (!meets_rectangle(sheet, from, stack.images[k + 1],
                         surfaces.slack_m + 1e-9 * sheet.half_m.norm(), point))
      return false;
    from = point;
  }
  if (!lamp.emitter) return true;
  if (surfaces.slack_m > 0) return lamp.emitter->reaches(surfaces.origin + from, surfaces.slack_m);
  return lamp.emitter->irradiance((from - stack.images[0]).normalized(), length_m) > 0;
}

// Whether light of the lamp may come to the facet straight or through clear bodies.
bool may_be_lit(const SmoothSurfaces& surfaces, const Sheet& sheet, const Lamp& lamp) {
  if (!lamp.lights(sheet.body)) return false;
  return !lamp.emitter || lamp.emitter->reaches(surfaces.origin + sheet.centre,
                                                sheet.half_m.norm() + surfaces.slack_m);
}

Start start_at_image(const ImageStack& stack, const Eigen::Vector3d& from) {
  Start start{.direction = (stack.images[stack.size] - from).normalized()};
  for (int k = stack.size; k-- > 0;)
    start.reflections.add(
        {.sheet = stack.sheets[k], .reflects = true, .from_inside = stack.from_inside[k]});
  return start;
}

void add_images_behind(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from,
                       const Lamp& lamp, int most, ImageStack& stack, std::vector<Start>& starts) {
  const Eigen::Vector3d target = stack.images[stack.size];
  for (const int s : surfaces.flat_reflectors) {
    if (stack.size > 0 && stack.sheets[stack.size - 1] == s) continue;
    const Sheet& sheet = surfaces.sheets[s];
    if (stack.size == 0 && !may_be_lit(surfaces, sheet, lamp)) continue;
    const double height_m = sheet.normal.dot(target) - sheet.offset_m;
    if (height_m == 0) continue;
    const bool from_inside = height_m < 0;
    stack.sheets[stack.size] = s;
    stack.from_inside[stack.size] = from_inside;
    stack.images[++stack.size] = target - 2 * height_m * sheet.normal;
    const double from_height_m = sheet.normal.dot(from) - sheet.offset_m;
    if (from_height_m * height_m > 0 && may_be_seen(surfaces, stack, lamp, from))
      starts.push_back(start_at_image(stack, from));
    if (stack.size < most) add_images_behind(surfaces, from, lamp, most, stack, starts);
    --stack.size;
  }
}

bool passes_near(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                 const Eigen::Vector3d& centre, double radius_m) {
  const Eigen::Vector3d way = to - from;
  const double share = std::clamp(way.dot(centre - from) / way.squaredNorm(), 0.0, 1.0);
  return (from + share * way - centre).norm() < radius_m;
}

// Out of the clear body around a point where the straight line would be reflected totally: as light
// that comes straight to where that line leaves the body goes on inside.
void add_way_out(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from,
                 const Eigen::Vector3d& target, std::vector<Start>& starts) {
  const Eigen::Vector3d way = target - from;
  const auto exit = surfaces.caster.closest(from, way.normalized(), 0, way.norm());
  if (!exit || !(exit->normal.dot(way) > 0)) return;
  const Turn turn{.sheet = surfaces.sheet_at(exit->object, exit->triangle, exit->normal)};
  if (turn.sheet < 0 || !surfaces.body_of(turn.sheet).is_clear) return;
  const auto inside = turned((exit->point - target).normalized(), exit->normal, false,
                             relative_index(surfaces, turn));
  if (inside) starts.push_back({.direction = -*inside});
}

}  // namespace

std::optional<Chain> follow(const SmoothSurfaces& surfaces, const Start& start,
                            const Eigen::Vector3d& from, const Eigen::Vector3d& target, int most) {
  Chain chain;
  Eigen::Vector3d point = from, direction = start.direction;
  int reflections = 0;
  while (true) {
    const auto hit = surfaces.caster.closest(point, direction);
    const bool is_done = reflections == start.reflections.size;
    if (!hit || (is_done && direction.dot(target - point) < hit->distance_m)) {
      if (!is_done || chain.size == 0) return std::nullopt;
      return chain;
    }
    if (chain.size == most) return std::nullopt;
    Turn turn{.sheet = surfaces.sheet_at(hit->object, hit->triangle, hit->normal),
              .reflects = true,
              .from_inside = hit->normal.dot(direction) > 0};
    if (!is_done && turn == start.reflections.turns[reflections]) {
      ++reflections;
    } else if (turn.sheet >= 0 && surfaces.body_of(turn.sheet).is_clear) {
      turn.reflects = false;
    } else {
      return std::nullopt;
    }
    const Eigen::Vector3d normal = turn.from_inside ? -hit->normal : hit->normal;
    const auto next = turned(direction, normal, turn.reflects, relative_index(surfaces, turn));
    if (!next) return std::nullopt;
    chain.add(turn);
    direction = *next;
    point = surfaces.caster.leave(*hit, direction);
  }
}

void add_aims(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from,
              const Eigen::Vector3d& target, const Chain& straight, std::vector<Start>& starts) {
  if (straight.size == 0) add_way_out(surfaces, from, target, starts);
  std::vector<int> aims(surfaces.bodies.size(), 0);
  for (int i = 0; i < straight.size; ++i)
    aims[surfaces.sheets[straight.turns[i].sheet].body] = most_aims;
  for (const Sheet& sheet : surfaces.sheets) {
    const SmoothBody& body = surfaces.bodies[sheet.body];
    if (!sheet.is_flat || !body.is_clear || aims[sheet.body] == most_aims) continue;
    if (!(sheet.normal.dot(from) > sheet.offset_m)) continue;
    if (!passes_near(from, target, body.centre, body.size_m / 2)) continue;
    ++aims[sheet.body];
    starts.push_back({.direction = (sheet.centre - from).normalized()});
  }
}

void add_images(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from, const Lamp& lamp,
                int most, std::vector<Start>& starts) {
  if (surfaces.flat_reflectors.empty()) return;
  const double facets = static_cast<double>(surfaces.flat_reflectors.size());
  int in_a_row = 1;
  while (in_a_row < most && std::pow(facets, in_a_row + 1) <= most_sequences) ++in_a_row;
  ImageStack stack;
  stack.images[0] = lamp.position - surfaces.origin;
  add_images_behind(surfaces, from, lamp, in_a_row, stack, starts);
}

}  // namespace scan::synth
