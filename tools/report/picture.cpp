// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/parallel.h"
#include "synth/ray_caster.h"
#include "tools/report/colour_map.h"

namespace scan {
namespace {

struct Side {
  const char* name;
  Eigen::Vector3d towards_viewer, right, up;
};

const std::vector<Side>& sides() {
  using Eigen::Vector3d;
  static const std::vector<Side> list = {
      {"front (-y)", -Vector3d::UnitY(), Vector3d::UnitX(), Vector3d::UnitZ()},
      {"right (+x)", Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()},
      {"back (+y)", Vector3d::UnitY(), -Vector3d::UnitX(), Vector3d::UnitZ()},
      {"left (-x)", -Vector3d::UnitX(), -Vector3d::UnitY(), Vector3d::UnitZ()},
      {"top (+z)", Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()},
      {"bottom (-z)", -Vector3d::UnitZ(), Vector3d::UnitX(), -Vector3d::UnitY()}};
  return list;
}

constexpr Colour background = {255, 255, 255};
constexpr Colour clay = {205, 190, 170};
constexpr int rays_per_side = 2;  // of a pixel, against jagged edges

// Weights of the triangle's corners at a point of its plane.
Eigen::Vector3d barycentric(const Mesh& mesh, const Triangle& t, const Eigen::Vector3d& x) {
  const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                        &c = mesh.vertices[t[2]];
  const Eigen::Vector3d area = (b - a).cross(c - a);
  const double v = (c - b).cross(x - b).dot(area), w = (a - c).cross(x - c).dot(area);
  const double whole = area.squaredNorm();
  return {v / whole, w / whole, 1 - (v + w) / whole};
}

struct Painter {
  const Mesh& mesh;
  const std::vector<double>& values;
  double limit;
  const synth::RayCaster& caster;

  Eigen::Vector3d shade(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    const auto hit = caster.closest(origin, direction);
    if (!hit) return Eigen::Vector3d(background[0], background[1], background[2]);
    const double light = 0.35 + 0.65 * std::abs(hit->normal.dot(direction));
    const Colour colour = values.empty() ? clay : diverging_colour(value_at(*hit));
    return light * Eigen::Vector3d(colour[0], colour[1], colour[2]);
  }

  double value_at(const synth::Hit& hit) const {
    const Triangle& t = mesh.triangles[hit.triangle];
    const Eigen::Vector3d weights = barycentric(mesh, t, hit.point);
    double value = 0;
    for (int corner = 0; corner < 3; ++corner) value += weights[corner] * values[t[corner]];
    return value / limit;
  }
};

View paint(const Painter& painter, const Side& side, const Bounds& box, double pixel_m,
           int size_px) {
  View view{side.name, Image<Colour>(size_px, size_px)};
  const double distance = box.diagonal().norm();
  const double sub = 1.0 / rays_per_side;
  parallel_for(
      static_cast<std::size_t>(size_px),
      [&](std::size_t row) {
        for (int column = 0; column < size_px; ++column) {
          Eigen::Vector3d sum = Eigen::Vector3d::Zero();
          for (int k = 0; k < rays_per_side * rays_per_side; ++k) {
            const int across = k % rays_per_side, down = k / rays_per_side;
            const double u = column + (across + 0.5) * sub - size_px / 2.0;
            const double v = static_cast<double>(row) + (down + 0.5) * sub - size_px / 2.0;
            const Eigen::Vector3d origin = box.center() + distance * side.towards_viewer +
                                           pixel_m * (u * side.right - v * side.up);
            sum += painter.shade(origin, -side.towards_viewer);
          }
          for (int channel = 0; channel < 3; ++channel)
            view.image(column, static_cast<int>(row))[channel] =
                static_cast<std::uint8_t>(std::lround(sum[channel] * sub * sub));
        }
      },
      8);
  return view;
}

}  // namespace

std::vector<View> six_views(const Mesh& mesh, const std::vector<double>& values, double limit,
                            int size_px) {
  synth::Scene scene;
  scene.materials.push_back({.name = "surface"});
  scene.objects.push_back({"surface", Pose::Identity(), mesh, 0});
  const synth::RayCaster caster(scene);
  const Bounds box = bounds_of(mesh.vertices);
  const double pixel_m = 1.08 * box.sizes().maxCoeff() / size_px;
  const Painter painter{mesh, values, limit > 0 ? limit : 1, caster};
  std::vector<View> views;
  for (const Side& side : sides()) views.push_back(paint(painter, side, box, pixel_m, size_px));
  return views;
}

double deviation_limit_m(std::vector<double> sizes) {
  std::erase_if(sizes, [](double d) { return !std::isfinite(d); });
  if (sizes.empty()) return 1;
  for (double& size : sizes) size = std::abs(size);
  const auto place =
      sizes.begin() + static_cast<long>(0.99 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), place, sizes.end());
  return std::max(*place, 1e-12);
}

Image<Colour> disparity_sheet(const Image<float>& measured, const Image<float>& truth) {
  constexpr Colour unknown = {70, 80, 110};
  constexpr double error_limit_px = 2;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const float d : truth.pixels) {
    if (!std::isfinite(d)) continue;
    least = std::min<double>(least, d);
    most = std::max<double>(most, d);
  }
  const auto grey = [&](float d) {
    if (!std::isfinite(d)) return unknown;
    const double share = std::clamp((d - least) / (most - least), 0.0, 1.0);
    const auto level = static_cast<std::uint8_t>(std::lround(20 + 235 * share));
    return Colour{level, level, level};
  };
  Image<Colour> sheet(3 * truth.width, truth.height);
  for (int row = 0; row < truth.height; ++row)
    for (int column = 0; column < truth.width; ++column) {
      const float d = measured(column, row), t = truth(column, row);
      sheet(column, row) = grey(d);
      sheet(truth.width + column, row) = grey(t);
      sheet(2 * truth.width + column, row) =
          std::isfinite(d - t) ? diverging_colour((d - t) / error_limit_px) : unknown;
    }
  return sheet;
}

Image<Colour> contact_sheet(const std::vector<View>& views) {
  constexpr int per_row = 3;
  const int size = views.front().image.width;
  const int rows = (static_cast<int>(views.size()) + per_row - 1) / per_row;
  Image<Colour> sheet(per_row * size, rows * size, background);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const int left = static_cast<int>(i) % per_row * size,
              top = static_cast<int>(i) / per_row * size;
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column)
        sheet(left + column, top + row) = views[i].image(column, row);
  }
  return sheet;
}

}  // namespace scan
