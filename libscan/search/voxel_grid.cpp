// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/voxel_grid.h"

#include <array>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

using Key = std::array<std::int64_t, 3>;

// Odd multiples of the places, whose sum the finalizer of splitmix64 (Steele, Lea, Flood, OOPSLA
// 2014) mixes: every bit reaches every bit.
std::uint64_t hash_of(const Key& key) {
  std::uint64_t hash = static_cast<std::uint64_t>(key[0]) * 0x9e3779b97f4a7c15u +
                       static_cast<std::uint64_t>(key[1]) * 0xd1342543de82ef95u +
                       static_cast<std::uint64_t>(key[2]) * 0xaf251af3b0f025b5u;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
  return hash ^ (hash >> 31);
}

// Spelt out: std::array compares bytes by a call.
bool same(const Key& a, const Key& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// Numbers keys by first appearance. Open addressing with linear probing (Knuth, TAOCP 3, 6.4 L).
class KeyNumbers {
 public:
  std::uint32_t number_of(const Key& key) {
    if (2 * keys_.size() >= slots_.size()) grow();
    std::uint32_t& slot = slots_[slot_of(key)];
    if (slot == empty) {
      slot = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return slot;
  }

 private:
  static constexpr std::uint32_t empty = 0xffffffffu;
  // Where the key is, or else belongs.
  std::size_t slot_of(const Key& key) const {
    std::size_t at = hash_of(key) & (slots_.size() - 1);
    while (slots_[at] != empty && !same(keys_[slots_[at]], key))
      at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), empty);
    for (std::size_t i = 0; i < keys_.size(); ++i)
      slots_[slot_of(keys_[i])] = static_cast<std::uint32_t>(i);
  }

  std::vector<Key> keys_;
  std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(1024, empty);  // a power of two
};

void check_side(const Bounds& box, double side_m) {
  if (!(side_m > 0))
    throw Error(Trouble::usage, "voxel grid: side " + std::to_string(side_m) + " m, must be > 0");
  if (!box.isEmpty() && !(box.sizes().maxCoeff() / side_m < 0x1p63))
    throw Error(Trouble::usage, "voxel grid: more than 2^63 cubes along an axis",
                "choose longer sides");
}

Key key_of(const Eigen::Vector3d& point, const Bounds& box, double side_m) {
  Key key;
  for (int axis = 0; axis < 3; ++axis)
    key[axis] = static_cast<std::int64_t>((point[axis] - box.min()[axis]) / side_m);  // not below 0
  return key;
}

// The cube of each used point, numbered by first appearance.
struct Cubes {
  std::vector<std::uint32_t> points;  // that are used
  std::vector<std::uint32_t> cube;    // of each of them
  std::vector<double> count;          // points in each cube
};

Cubes assign_cubes(const PointCloud& cloud, const Bounds& box, double side_m) {
  Cubes cubes{finite_points(cloud), {}, {}};
  cubes.cube.reserve(cubes.points.size());
  KeyNumbers numbers;
  for (const std::uint32_t i : cubes.points) {
    const std::uint32_t number = numbers.number_of(key_of(cloud.points[i], box, side_m));
    if (number == cubes.count.size()) cubes.count.push_back(0);
    cubes.cube.push_back(number);
    cubes.count[number] += 1;
  }
  return cubes;
}

// Mean per cube of values[i] - origin, plus origin: far from zero nothing is lost in the sum.
template <class T>
std::vector<T> means(const std::vector<T>& values, const Cubes& cubes, const T& zero,
                     const T& origin) {
  std::vector<T> mean;
  if (values.empty()) return mean;
  mean.assign(cubes.count.size(), zero);
  for (std::size_t i = 0; i < cubes.points.size(); ++i)
    mean[cubes.cube[i]] += values[cubes.points[i]] - origin;
  for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = origin + mean[c] / cubes.count[c];
  return mean;
}

}  // namespace

PointCloud voxel_grid(const PointCloud& cloud, double side_m) {
  check(cloud);
  const Bounds box = bounds_of(cloud.points);
  check_side(box, side_m);
  const Cubes cubes = assign_cubes(cloud, box, side_m);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d no_covariance = Eigen::Matrix3d::Zero();
  PointCloud thinned;
  thinned.points = means(cloud.points, cubes, zero, box.min());
  thinned.normals = means(cloud.normals, cubes, zero, zero);
  thinned.sigma_m = means(cloud.sigma_m, cubes, 0.0, 0.0);
  thinned.covariances = means(cloud.covariances, cubes, no_covariance, no_covariance);
  thinned.intensity = means(cloud.intensity, cubes, 0.0, 0.0);
  for (auto& normal : thinned.normals) normal.stableNormalize();  // (0,0,0), unknown, stays
  return thinned;
}

}  // namespace scan
