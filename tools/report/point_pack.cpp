// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/point_pack.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <numeric>

#include "tools/report/html.h"

namespace scan {
namespace {

constexpr std::uint16_t most_coarse_step = 255;

// Every third bit.
std::uint64_t spread(std::uint64_t v) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 16; ++i) bits |= (v >> i & 1) << (3 * i);
  return bits;
}

struct Channel {
  std::string name;
  Quantised values;
};

Channel channel(const std::string& name, std::size_t count,
                const std::function<double(std::size_t)>& value, std::uint16_t most_step = 65535) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = value(i);
  return {name, quantised(values, most_step)};
}

double sign(double v) {
  return v < 0 ? -1 : 1;
}

// Of a unit vector onto the square [-1, 1]^2.
Eigen::Vector2d octahedral(const Eigen::Vector3d& n) {
  const double size = n.cwiseAbs().sum();
  if (!(size > 0)) return {0, 0};
  const Eigen::Vector2d flat = n.head<2>() / size;
  if (n.z() >= 0) return flat;
  return {(1 - std::abs(flat.y())) * sign(flat.x()), (1 - std::abs(flat.x())) * sign(flat.y())};
}

std::vector<Channel> channels_of(const PagePoints& p) {
  const std::size_t count = p.points.size();
  std::vector<Channel> channels;
  for (int axis = 0; axis < 3; ++axis)
    channels.push_back(channel(std::string(1, static_cast<char>('x' + axis)), count,
                               [&](std::size_t i) { return p.points[i][axis]; }));
  if (!p.normals.empty())
    for (int axis = 0; axis < 2; ++axis) {
      Channel normal{axis == 0 ? "normal_u" : "normal_v", {-1, 2.0 / most_coarse_step, {}}};
      for (const Eigen::Vector3d& n : p.normals)
        normal.values.steps.push_back(static_cast<std::uint16_t>(
            std::lround((octahedral(n)[axis] + 1) / 2 * most_coarse_step)));
      channels.push_back(std::move(normal));
    }
  if (!p.deviations_m.empty())
    channels.push_back(channel("deviation", count, [&](auto i) { return p.deviations_m[i]; }));
  if (!p.support_m.empty())
    channels.push_back(channel(
        "support", count, [&](auto i) { return p.support_m[i]; }, most_coarse_step));
  return channels;
}

std::vector<std::uint32_t> curve_order(const std::vector<Channel>& channels, std::size_t count) {
  std::vector<std::uint64_t> key(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      key[i] |= spread(channels[axis].values.steps[i]) << axis;
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
  return order;
}

// Small differences of either sign become small numbers.
std::uint16_t zigzag(std::uint16_t difference) {
  return static_cast<std::uint16_t>(difference << 1 ^ (difference & 0x8000 ? 0xffff : 0));
}

std::string planes(const Quantised& values, std::span<const std::uint32_t> order) {
  std::string low, high;
  std::uint16_t before = 0;
  for (const std::uint32_t i : order) {
    const std::uint16_t now = values.steps[i];
    const std::uint16_t coded = zigzag(static_cast<std::uint16_t>(now - before));
    low += static_cast<char>(coded & 0xff);
    high += static_cast<char>(coded >> 8);
    before = now;
  }
  return low + high;
}

}  // namespace

std::vector<std::uint32_t> thinned(std::size_t size, std::span<const double> weights,
                                   std::size_t most, std::size_t keep) {
  std::vector<std::uint32_t> order(size);
  std::iota(order.begin(), order.end(), 0u);
  if (size <= most) return order;
  keep = weights.empty() ? 0 : std::min(keep, most);
  const auto weight = [&](std::uint32_t i) {
    return std::isfinite(weights[i]) ? std::abs(weights[i]) : -1;
  };
  if (keep > 0)
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return weight(a) > weight(b); });
  std::vector<std::uint32_t> chosen(order.begin(), order.begin() + static_cast<long>(keep));
  std::vector<std::uint32_t> rest(order.begin() + static_cast<long>(keep), order.end());
  std::sort(rest.begin(), rest.end());
  const std::size_t wanted = most - keep;
  for (std::size_t k = 0; k < wanted; ++k) chosen.push_back(rest[k * rest.size() / wanted]);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Quantised quantised(std::span<const double> values, std::uint16_t most_step) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double v : values)
    if (std::isfinite(v)) least = std::min(least, v), most = std::max(most, v);
  Quantised result;
  if (least <= most) result = {least, (most - least) / most_step, {}};
  for (const double v : values)
    result.steps.push_back(
        std::isfinite(v) && result.step > 0
            ? static_cast<std::uint16_t>(std::lround((v - result.low) / result.step))
            : std::uint16_t{0});
  return result;
}

nlohmann::ordered_json packed_points(const PagePoints& points) {
  const std::vector<Channel> channels = channels_of(points);
  const auto order = curve_order(channels, points.points.size());
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string bytes;
  for (const Channel& one : channels) {
    list.push_back({{"name", one.name}, {"low", one.values.low}, {"step", one.values.step}});
    bytes += planes(one.values, order);
  }
  return {{"count", points.points.size()}, {"channels", list}, {"data", base64(deflated(bytes))}};
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                Z_BEST_COMPRESSION) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

}  // namespace scan
