// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "synth/transport/chain_starts.h"

namespace scan::synth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t most_starts = 6;  // of one kind at one sheet
constexpr double apart = 0.2;           // starts of one kind, over the body's size
constexpr int circle_samples = 96;

Eigen::Vector3d pull_of(const Sheet::Sample& at, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& target) {
  return (from - at.point).normalized() + (target - at.point).normalized();
}

// How far a reflection at the sample is from Fermat's principle: the sine between its normal and
// the bisector of the ways to both ends. The sample itself may be hidden from an end.
double bisector_sine(const Sheet::Sample& sample, const Eigen::Vector3d& from,
                     const Eigen::Vector3d& target, bool from_inside) {
  const Eigen::Vector3d pull = pull_of(sample, from, target);
  if (!(pull.dot(from_inside ? -sample.normal : sample.normal) > 0)) return infinity;
  return pull.normalized().cross(sample.normal).norm();
}

Sheet::Sample back_on_surface(const SmoothBody& body, Eigen::Vector3d point) {
  DistanceField here = field(body.shape, point);
  for (int i = 0; i < 3; ++i) {
    point -= here.value_m * here.gradient;
    here = field(body.shape, point);
  }
  return {point, here.gradient.normalized()};
}

// By which angle the chain, entered at the sample, misses the target.
double miss_angle(const SmoothSurfaces& surfaces, const Chain& chain, const Sheet::Sample& sample,
                  const Eigen::Vector3d& from, const Eigen::Vector3d& target) {
  const Eigen::Vector3d way = sample.point - from;
  if ((way.dot(sample.normal) > 0) != chain.turns[0].from_inside) return infinity;
  const auto shot = shoot(surfaces, chain, from, way.normalized(), target);
  if (!shot || !(shot->last_m > 0)) return infinity;
  return std::atan2(shot->miss.norm(), shot->last_m);
}

// The best samples, each away from those before it.
template <class Badness>
std::vector<Sheet::Sample> best_of(const std::vector<Sheet::Sample>& samples, double apart_m,
                                   const Badness& badness) {
  std::vector<double> bad(samples.size());
  for (std::size_t i = 0; i < bad.size(); ++i) bad[i] = badness(samples[i]);
  std::vector<Sheet::Sample> best;
  while (best.size() < most_starts) {
    const auto next = std::min_element(bad.begin(), bad.end());
    if (next == bad.end() || !(*next < infinity)) break;
    best.push_back(samples[next - bad.begin()]);
    for (std::size_t i = 0; i < bad.size(); ++i)
      if ((samples[i].point - best.back().point).norm() < apart_m) bad[i] = infinity;
  }
  return best;
}

// All ways over and through a ball lie in the plane of both ends and its centre.
std::vector<Sheet::Sample> circle_on_ball(const SmoothBody& ball, const Eigen::Vector3d& from,
                                          const Eigen::Vector3d& target) {
  const double radius_m = std::get<SphereShape>(ball.shape.shape).radius_m;
  const Eigen::Vector3d x = (from - ball.centre).normalized();
  Eigen::Vector3d y = target - ball.centre;
  y -= y.dot(x) * x;
  if (!(y.norm() > 1e-9 * radius_m)) y = x.unitOrthogonal();
  y.normalize();
  std::vector<Sheet::Sample> samples;
  for (int i = 0; i < circle_samples; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / circle_samples;
    const Eigen::Vector3d normal = std::cos(angle) * x + std::sin(angle) * y;
    samples.push_back({ball.centre + radius_m * normal, normal});
  }
  return samples;
}

// Samples of a closed curve that are better than their neighbours.
template <class Badness>
std::vector<Sheet::Sample> local_best_of(const std::vector<Sheet::Sample>& samples,
                                         const Badness& badness) {
  std::vector<double> bad(samples.size());
  for (std::size_t i = 0; i < bad.size(); ++i) bad[i] = badness(samples[i]);
  std::vector<Sheet::Sample> best;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const double before = bad[(i + bad.size() - 1) % bad.size()],
                 behind = bad[(i + 1) % bad.size()];
    if (bad[i] < infinity && bad[i] <= before && bad[i] < behind) best.push_back(samples[i]);
  }
  return best;
}

template <class Badness>
std::vector<Sheet::Sample> starts_on(const SmoothSurfaces& surfaces, int s,
                                     const Eigen::Vector3d& from, const Eigen::Vector3d& target,
                                     const Badness& badness) {
  const SmoothBody& body = surfaces.body_of(s);
  if (std::holds_alternative<SphereShape>(body.shape.shape))
    return local_best_of(circle_on_ball(body, from, target), badness);
  return best_of(surfaces.sheets[s].samples, apart * body.size_m, badness);
}

Chain one_reflection(int sheet, bool from_inside) {
  Chain chain;
  chain.add({.sheet = sheet, .reflects = true, .from_inside = from_inside});
  return chain;
}

void add_reflection_starts(const SmoothSurfaces& surfaces, int s, bool from_inside,
                           const Eigen::Vector3d& from, const Eigen::Vector3d& target,
                           std::vector<Start>& starts) {
  const auto badness = [&](const Sheet::Sample& at) {
    return bisector_sine(at, from, target, from_inside);
  };
  std::vector<Sheet::Sample> samples = starts_on(surfaces, s, from, target, badness);
  // Of grazing reflections, and of those close to an end, no sample may be near.
  for (const Eigen::Vector3d& near : {from, target, Eigen::Vector3d((from + target) / 2)})
    samples.push_back(back_on_surface(surfaces.body_of(s), near));
  const std::size_t first = starts.size();
  for (const Sheet::Sample& sample : samples) {
    if (!(badness(sample) < infinity)) continue;
    const Eigen::Vector3d direction = (sample.point - from).normalized();
    const bool is_new = std::none_of(starts.begin() + first, starts.end(), [&](const Start& known) {
      return (known.direction - direction).norm() < 1e-3;
    });
    if (is_new)
      starts.push_back({.direction = direction, .reflections = one_reflection(s, from_inside)});
  }
}

void add_passage_starts(const SmoothSurfaces& surfaces, int s, bool is_inside,
                        int inner_reflections, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& target, std::vector<Start>& starts) {
  Chain chain;
  if (!is_inside) chain.add({.sheet = s});
  for (int i = 0; i < inner_reflections; ++i)
    chain.add({.sheet = s, .reflects = true, .from_inside = true});
  chain.add({.sheet = s, .from_inside = true});
  const Chain reflections = inner_reflections > 0 ? one_reflection(s, true) : Chain{};
  const auto badness = [&](const Sheet::Sample& at) {
    return miss_angle(surfaces, chain, at, from, target);
  };
  for (const Sheet::Sample& sample : starts_on(surfaces, s, from, target, badness))
    starts.push_back({.direction = (sample.point - from).normalized(), .reflections = reflections});
}

}  // namespace

void add_curved_starts(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from,
                       const Lamp& lamp, int most, std::vector<Start>& starts) {
  const Eigen::Vector3d target = lamp.position - surfaces.origin;
  for (const int s : surfaces.curved) {
    const SmoothBody& body = surfaces.body_of(s);
    if (!lamp.lights(surfaces.sheets[s].body)) continue;
    const bool is_inside = body.is_clear && surfaces.is_inside(s, from);
    const bool reflects = !body.is_clear || body.index != 1;
    if (reflects) add_reflection_starts(surfaces, s, is_inside, from, target, starts);
    if (!body.is_clear) continue;
    const int passage = is_inside ? 1 : 2;
    if (passage <= most) add_passage_starts(surfaces, s, is_inside, 0, from, target, starts);
    if (reflects && passage + 1 <= most)
      add_passage_starts(surfaces, s, is_inside, 1, from, target, starts);
  }
}

}  // namespace scan::synth
