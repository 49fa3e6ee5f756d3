// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "libscan/core/error.h"
#include "libscan/core/shortest.h"
#include "synth/check_pose.h"
#include "synth/spherical_rectangle.h"

namespace scan::synth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const std::string& field, double value, const std::string& limit) {
  throw Error(Trouble::input, field + " is " + shortest(value) + ", must be " + limit);
}

void check_power(double value, const std::string& field) {
  if (!(value >= 0 && std::isfinite(value))) refuse(field, value, "finite and not negative");
}

void check_size(double value_m, const std::string& field) {
  if (!(value_m > 0 && std::isfinite(value_m))) refuse(field, value_m, "finite and above 0");
}

void check_kind(const PointLight& light, const std::string& place) {
  if (!light.position_m.allFinite())
    throw Error(Trouble::input, place + "/position_m is not finite");
  check_power(light.intensity_w_sr, place + "/intensity_w_sr");
}

void check_kind(const AreaLight& light, const std::string& place) {
  check_pose(light.world_from_light, place + "/world_from_light");
  check_size(light.width_m, place + "/width_m");
  check_size(light.height_m, place + "/height_m");
  check_power(light.radiance_w_m2_sr, place + "/radiance_w_m2_sr");
}

void check_kind(const Environment& sky, const std::string& place) {
  check_power(sky.radiance_w_m2_sr, place + "/radiance_w_m2_sr");
  for (const float value : sky.map.pixels) check_power(value, place + "/map");
}

// Cosines of the polar angles above and below a row of the map, and with them its cells' size.
struct Band {
  Band(const Environment& sky, int row)
      : top(std::cos(std::numbers::pi * row / sky.map.height)),
        bottom(std::cos(std::numbers::pi * (row + 1) / sky.map.height)),
        cell_sr(2 * std::numbers::pi / sky.map.width * (top - bottom)) {}
  double top, bottom, cell_sr;
};

Eigen::Vector3d direction_at(double polar_cosine, double turns) {
  const double across = std::sqrt(std::max(0.0, (1 - polar_cosine) * (1 + polar_cosine)));
  const double azimuth = 2 * std::numbers::pi * turns;
  return {across * std::cos(azimuth), across * std::sin(azimuth), polar_cosine};
}

// Turns running sums into shares of their last; all zero stays all zero.
void normalise(std::span<double> running) {
  const double total = running.back();
  for (double& sum : running) sum = total > 0 ? sum / total : 0;
}

// The interval of the cumulative shares (the last is 1, u below) that holds u, and where in it.
struct Pick {
  int index;
  double share;   // of the interval
  double within;  // in [0, 1)
};
Pick pick(std::span<const double> up_to, double u) {
  const auto above = std::upper_bound(up_to.begin(), up_to.end(), u);
  const double below = above == up_to.begin() ? 0 : *(above - 1);
  return {static_cast<int>(above - up_to.begin()), *above - below, (u - below) / (*above - below)};
}

double share(std::span<const double> up_to, int index) {
  return up_to[index] - (index == 0 ? 0 : up_to[index - 1]);
}

std::span<const double> columns_of(const PreparedLight& light, const Environment& sky, int row) {
  return {light.columns_up_to.data() + sky.map.index(0, row),
          static_cast<std::size_t>(sky.map.width)};
}

void prepare_map(const Environment& sky, PreparedLight& light) {
  double all = 0;
  for (int row = 0; row < sky.map.height; ++row) {
    double in_row = 0;
    for (int column = 0; column < sky.map.width; ++column)
      light.columns_up_to.push_back(in_row += sky.map(column, row));
    all += in_row * Band(sky, row).cell_sr;
    light.rows_up_to.push_back(all);
    if (in_row > 0)
      normalise({light.columns_up_to.end() - sky.map.width, light.columns_up_to.end()});
  }
  normalise(light.rows_up_to);
  if (!(all > 0)) light.rows_up_to.clear(), light.columns_up_to.clear();
}

LightSample sample_kind(const PreparedLight&, const PointLight& lamp, const Eigen::Vector3d& x,
                        const Eigen::Vector2d&) {
  const Eigen::Vector3d way = lamp.position_m - x;
  const double distance_m = way.norm();
  if (!(distance_m > 0)) return {};
  return {way / distance_m, distance_m, lamp.intensity_w_sr / (distance_m * distance_m), 0};
}

LightSample sample_kind(const PreparedLight&, const AreaLight& lamp, const Eigen::Vector3d& x,
                        const Eigen::Vector2d& u) {
  const Eigen::Vector3d x_in_light = lamp.world_from_light.inverse() * x;
  if (!(x_in_light.z() > 0)) return {};
  const SphericalRectangle seen({lamp.width_m / 2, lamp.height_m / 2}, x_in_light);
  const Eigen::Vector2d point = seen.point(u);
  const Eigen::Vector3d way(point.x() - x_in_light.x(), point.y() - x_in_light.y(),
                            -x_in_light.z());
  const double distance_m = way.norm();
  return {lamp.world_from_light.linear() * (way / distance_m), distance_m, lamp.radiance_w_m2_sr,
          seen.density(point)};
}

LightSample sample_kind(const PreparedLight& light, const Environment& sky, const Eigen::Vector3d&,
                        const Eigen::Vector2d& u) {
  if (light.rows_up_to.empty()) {
    const double radiance = sky.map.empty() ? sky.radiance_w_m2_sr : 0;
    return {direction_at(1 - 2 * u.y(), u.x()), infinity, radiance, 1 / (4 * std::numbers::pi)};
  }
  const Pick row = pick(light.rows_up_to, u.y());
  const Pick column = pick(columns_of(light, sky, row.index), u.x());
  const Band band(sky, row.index);
  return {direction_at(band.top + row.within * (band.bottom - band.top),
                       (column.index + column.within) / sky.map.width),
          infinity, sky.radiance_w_m2_sr * sky.map(column.index, row.index),
          row.share * column.share / band.cell_sr};
}

LightSample along_kind(const PreparedLight&, const PointLight& lamp, const Eigen::Vector3d& x,
                       const Eigen::Vector3d& direction) {
  return {direction, (lamp.position_m - x).norm(), 0, 0};
}

LightSample along_kind(const PreparedLight&, const AreaLight& lamp, const Eigen::Vector3d& x,
                       const Eigen::Vector3d& direction) {
  const Pose light_from_world = lamp.world_from_light.inverse();
  const Eigen::Vector3d o = light_from_world * x, d = light_from_world.linear() * direction;
  if (!(o.z() > 0 && d.z() < 0)) return {.direction = direction};
  const double distance_m = -o.z() / d.z();
  const Eigen::Vector2d point = (o + distance_m * d).head<2>();
  const Eigen::Vector2d half(lamp.width_m / 2, lamp.height_m / 2);
  if ((point.cwiseAbs().array() > half.array()).any()) return {.direction = direction};
  return {direction, distance_m, lamp.radiance_w_m2_sr, SphericalRectangle(half, o).density(point)};
}

LightSample along_kind(const PreparedLight& light, const Environment& sky, const Eigen::Vector3d&,
                       const Eigen::Vector3d& direction) {
  if (light.rows_up_to.empty()) {
    const double radiance = sky.map.empty() ? sky.radiance_w_m2_sr : 0;
    return {direction, infinity, radiance, 1 / (4 * std::numbers::pi)};
  }
  const double polar = std::acos(std::clamp(direction.z(), -1.0, 1.0)) / std::numbers::pi;
  double turns = std::atan2(direction.y(), direction.x()) / (2 * std::numbers::pi);
  if (turns < 0) turns += 1;
  const int row = std::min(static_cast<int>(polar * sky.map.height), sky.map.height - 1);
  const int column = std::min(static_cast<int>(turns * sky.map.width), sky.map.width - 1);
  return {direction, infinity, sky.radiance_w_m2_sr * sky.map(column, row),
          share(light.rows_up_to, row) * share(columns_of(light, sky, row), column) /
              Band(sky, row).cell_sr};
}

}  // namespace

void check(const Light& light, const std::string& place) {
  std::visit([&](const auto& kind) { check_kind(kind, place); }, light);
}

PreparedLight::PreparedLight(const Light& described) : light(described) {
  if (const auto* sky = std::get_if<Environment>(&light); sky && !sky->map.empty())
    prepare_map(*sky, *this);
}

LightSample sample_light(const PreparedLight& light, const Eigen::Vector3d& x,
                         const Eigen::Vector2d& u) {
  return std::visit([&](const auto& kind) { return sample_kind(light, kind, x, u); }, light.light);
}

LightSample light_along(const PreparedLight& light, const Eigen::Vector3d& x,
                        const Eigen::Vector3d& direction) {
  return std::visit([&](const auto& kind) { return along_kind(light, kind, x, direction); },
                    light.light);
}

}  // namespace scan::synth
