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
constexpr double margin = 1.08;

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

// Fills the view's image, all else of which is set.
void paint(const Painter& painter, double distance, View& view) {
  const double sub = 1.0 / rays_per_side;
  const int width = view.image.width, height = view.image.height;
  parallel_for(
      static_cast<std::size_t>(height),
      [&](std::size_t row) {
        for (int column = 0; column < width; ++column) {
          Eigen::Vector3d sum = Eigen::Vector3d::Zero();
          for (int k = 0; k < rays_per_side * rays_per_side; ++k) {
            const int across = k % rays_per_side, down = k / rays_per_side;
            const double u = column + (across + 0.5) * sub - width / 2.0;
            const double v = static_cast<double>(row) + (down + 0.5) * sub - height / 2.0;
            const Eigen::Vector3d origin = view.centre + distance * view.towards_viewer +
                                           view.pixel_m * (u * view.right - v * view.up);
            sum += painter.shade(origin, -view.towards_viewer);
          }
          for (int channel = 0; channel < 3; ++channel)
            view.image(column, static_cast<int>(row))[channel] =
                static_cast<std::uint8_t>(std::lround(sum[channel] * sub * sub));
        }
      },
      8);
}

synth::Scene scene_of(const Mesh& mesh) {
  synth::Scene scene;
  scene.materials.push_back({.name = "surface"});
  scene.objects.push_back({"surface", Pose::Identity(), mesh, 0});
  return scene;
}

// Half of what a box measures along a direction.
double half_extent(const Bounds& box, const Eigen::Vector3d& direction) {
  return 0.5 * box.sizes().dot(direction.cwiseAbs());
}

}  // namespace

Eigen::Vector2d View::place(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d from_centre = point - centre;
  return {image.width / 2.0 + from_centre.dot(right) / pixel_m,
          image.height / 2.0 - from_centre.dot(up) / pixel_m};
}

struct Portrait::Parts {
  synth::RayCaster caster;
  Painter painter;
  Bounds box;

  Parts(const Mesh& mesh, const std::vector<double>& values, double limit)
      : caster(scene_of(mesh)),
        painter{mesh, values, limit > 0 ? limit : 1, caster},
        box(bounds_of(mesh.vertices)) {}
};

Portrait::Portrait(const Mesh& mesh, const std::vector<double>& values, double limit)
    : parts_(std::make_unique<Parts>(mesh, values, limit)) {}
Portrait::~Portrait() = default;

std::vector<View> Portrait::six_views(int size_px) const {
  const Bounds& box = parts_->box;
  std::vector<View> views;
  for (const Side& side : sides()) {
    View view{side.name,
              Image<Colour>(size_px, size_px),
              box.center(),
              side.towards_viewer,
              side.right,
              side.up,
              margin * box.sizes().maxCoeff() / size_px};
    paint(parts_->painter, box.diagonal().norm(), view);
    views.push_back(std::move(view));
  }
  return views;
}

View Portrait::oblique_view(int width_px, int height_px) const {
  const Bounds& box = parts_->box;
  const Eigen::Vector3d towards = Eigen::Vector3d(0.55, -0.75, 0.45).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(towards).normalized();
  const Eigen::Vector3d up = towards.cross(right);
  const double pixel_m =
      2 * margin * std::max(half_extent(box, right) / width_px, half_extent(box, up) / height_px);
  View view{"front, right and above",
            Image<Colour>(width_px, height_px),
            box.center(),
            towards,
            right,
            up,
            pixel_m};
  paint(parts_->painter, box.diagonal().norm(), view);
  return view;
}

bool Portrait::is_seen(const View& view, const Eigen::Vector3d& point, double tolerance_m) const {
  const double distance = parts_->box.diagonal().norm();
  const auto hit =
      parts_->caster.closest(point + distance * view.towards_viewer, -view.towards_viewer);
  return hit && (hit->point - point).dot(view.towards_viewer) < tolerance_m;
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
