// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples of a true surface, uniform by area.
//
// Analytic solids by integral geometry: isotropic uniform random lines through a ball meet every
// surface in it uniformly by area, and n lines through a ball of radius R meet area A about
// n A / (2 pi R^2) times (Cauchy and Crofton; Santalo 1976, eq. 14.70). One way for all solids,
// blends included, and equal line density gives equal density on all of them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "libscan/verify/line_crossings.h"
#include "libscan/verify/surface_error.h"
#include "libscan/verify/true_surface_parts.h"

namespace scan {
namespace {

constexpr double pi = std::numbers::pi;

using Samples = std::vector<SurfaceSample>;

// Isotropic and uniform: any direction, then any place on the disc across it.
Line random_line(const Ball& ball, RandomStream& random) {
  const double z = 2 * random.uniform() - 1, angle = 2 * pi * random.uniform();
  const double radius = std::sqrt(1 - z * z);
  const Eigen::Vector3d w(radius * std::cos(angle), radius * std::sin(angle), z);
  const Eigen::Vector3d u = w.unitOrthogonal(), v = w.cross(u);
  const double r = ball.radius_m * std::sqrt(random.uniform());
  const double place = 2 * pi * random.uniform();
  return {ball.centre + r * (std::cos(place) * u + std::sin(place) * v) - ball.radius_m * w, w};
}

// Where one part's samples come from; `density` is samples per square metre.
struct Request {
  double density;
  std::uint64_t seed;
  std::uint32_t stream;
};

Samples on_solid(const PlacedShape& shape, const Ball& ball, const Request& request) {
  // n lines through the ball give n A / (2 pi R^2) samples of area A
  const auto lines = static_cast<std::size_t>(
      std::llround(request.density * 2 * pi * ball.radius_m * ball.radius_m));
  constexpr std::size_t chunk = 256;
  std::vector<Samples> found((lines + chunk - 1) / chunk);
  parallel_chunks(lines, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RandomStream random(request.seed, request.stream, i);
      add_crossings(shape, random_line(ball, random), 2 * ball.radius_m, found[begin / chunk]);
    }
  });
  Samples samples;
  for (const Samples& some : found) samples.insert(samples.end(), some.begin(), some.end());
  return samples;
}

// A plane has no end: what is sampled is the rectangle that the region's shadow on it fills.
Samples on_plane(const Pose& world_from_plane, const Bounds& region, const Request& request) {
  Bounds shadow;
  for (int corner = 0; corner < 8; ++corner)
    shadow.extend(world_from_plane.inverse() *
                  region.corner(static_cast<Bounds::CornerType>(corner)));
  const Eigen::Vector3d sizes = shadow.sizes();
  const auto count =
      static_cast<std::size_t>(std::llround(request.density * sizes.x() * sizes.y()));
  Samples samples;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(request.seed, request.stream, i);
    const double u = random.uniform(), v = random.uniform();
    const Eigen::Vector3d in_plane(shadow.min().x() + u * sizes.x(),
                                   shadow.min().y() + v * sizes.y(), 0);
    samples.push_back({world_from_plane * in_plane, world_from_plane.linear().col(2), 0});
  }
  return samples;
}

Samples on_part(const TrueSurfaceParts& parts, std::size_t part, const Bounds& region,
                const Request& request) {
  if (part >= parts.shapes.size()) {
    const Mesh& mesh = parts.meshes[part - parts.shapes.size()]->mesh();
    const auto count = static_cast<std::size_t>(std::llround(request.density * area_m2(mesh)));
    return sample_surface(mesh, count, RandomStream(request.seed, request.stream, 0).bits32());
  }
  const PlacedShape& shape = parts.shapes[part];
  if (std::holds_alternative<PlaneShape>(shape.shape))
    return on_plane(shape.parent_from_shape, region, request);
  const Bounds box = bounds_of(shape);
  if (box.sizes().allFinite()) return on_solid(shape, ball_around(box), request);
  Samples samples = on_solid(shape, ball_around(region), request);
  std::erase_if(samples, [&](const SurfaceSample& s) { return !region.contains(s.point); });
  return samples;
}

Samples visible_samples(const TrueSurfaceParts& parts, const Bounds& region, double density,
                        std::uint64_t seed, std::uint32_t round) {
  Samples visible;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto stream = static_cast<std::uint32_t>(part * 64 + round);
    const Samples drawn = on_part(parts, part, region, {density, seed, stream});
    std::vector<char> hidden(drawn.size());
    parallel_for(drawn.size(), [&](std::size_t i) {
      hidden[i] = parts.is_hidden(part, drawn[i].point, drawn[i].normal);
    });
    for (std::size_t i = 0; i < drawn.size(); ++i)
      if (!hidden[i]) visible.push_back(drawn[i]);
  }
  return visible;
}

// Every n-th of the list, so that no part of it is favoured.
Samples thinned(const Samples& samples, std::size_t count) {
  Samples kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < count; ++i) kept.push_back(samples[i * samples.size() / count]);
  return kept;
}

}  // namespace

Samples sample_truth(const TrueSurface& truth, std::size_t count, std::uint64_t seed,
                     const Bounds& plane_region) {
  const TrueSurfaceParts parts(truth);
  Bounds region = parts.bounds;
  if (!plane_region.isEmpty()) region.extend(plane_region);
  if (parts.size() == 0) throw Error(Trouble::input, "true surface: neither a shape nor a mesh");
  if (region.isEmpty())
    throw Error(Trouble::input, "true surface: a plane without bounds cannot be sampled",
                "add a bounded object or measured data beside it");

  // The first round guesses the area from the region and measures the density that is needed.
  double density = 1000 / region.sizes().squaredNorm();
  Samples samples;
  for (std::uint32_t round = 0; round < 16 && samples.size() < count; ++round) {
    const Samples more = visible_samples(parts, region, density, seed, round);
    samples.insert(samples.end(), more.begin(), more.end());
    const double missing = static_cast<double>(count) - static_cast<double>(samples.size());
    density *= more.empty() ? 16 : std::max(missing, 1.0) * 1.05 / static_cast<double>(more.size());
  }
  if (samples.size() < count)
    throw Error(Trouble::computation, "true surface: no visible surface to sample");
  return thinned(samples, count);
}

}  // namespace scan
