// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/outliers.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/disjoint_sets.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr double alone = 2;           // reach over the neighbours' median reach
constexpr double thin = 2;            // reach over that of the median point
constexpr double least_flatness = 3;  // width over thickness where neighbours spread in a plane
constexpr double most_slope = 0.5;    // sine of the angle from a plane to a neighbour
constexpr double least_cosine = 0.5;  // between the planes' normals
constexpr double body_share = 0.01;   // of all points: so many are a body of their own

struct Cloud {
  const LocalPlanes& all;
  std::span<const Eigen::Vector3d> points;

  std::span<const std::uint32_t> around(std::size_t i) const {
    return std::span(all.around).subspan(i * all.neighbours, all.neighbours);
  }
};

bool agree(const Cloud& cloud, std::size_t i, std::size_t j) {
  const Eigen::Vector3d &n = cloud.all.planes[i].normal, &m = cloud.all.planes[j].normal;
  const Eigen::Vector3d apart = cloud.points[j] - cloud.points[i];
  const double most_rise_m = most_slope * apart.norm();
  return std::abs(n.dot(apart)) < most_rise_m && std::abs(m.dot(apart)) < most_rise_m &&
         std::abs(n.dot(m)) > least_cosine;
}

// How many of the point's neighbours fulfil a condition.
template <class Condition>
std::size_t count_around(const Cloud& cloud, std::size_t i, Condition&& condition) {
  const auto around = cloud.around(i);
  return static_cast<std::size_t>(std::count_if(around.begin(), around.end(), condition));
}

bool is_flat(const LocalPlane& plane) {
  return plane.width_m > least_flatness * plane.thickness_m;
}

bool lies_on_sheet(const Cloud& cloud, std::size_t i) {
  const auto agrees_with_half = [&](std::size_t j) {
    return 2 * count_around(cloud, j, [&](std::size_t k) { return agree(cloud, j, k); }) >=
           cloud.all.neighbours;
  };
  return agrees_with_half(i) &&
         4 * count_around(cloud, i, agrees_with_half) >= 3 * cloud.all.neighbours;
}

bool lies_alone(const Cloud& cloud, std::size_t i) {
  std::vector<double> reaches_m;
  for (const std::uint32_t n : cloud.around(i)) reaches_m.push_back(cloud.all.planes[n].reach_m);
  return cloud.all.planes[i].reach_m > alone * median(reaches_m);
}

bool lies_beside(const LocalPlane& plane) {
  return plane.offset_m > plane.width_m / 2 && plane.offset_m > 4 * plane.thickness_m;
}

enum class Place : char { body, thin_sheet, nowhere };

std::vector<Place> places(const Cloud& cloud) {
  const std::vector<LocalPlane>& planes = cloud.all.planes;
  std::vector<double> reaches_m(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) reaches_m[i] = planes[i].reach_m;
  const double most_m = thin * median(reaches_m);
  std::vector<Place> places(planes.size());
  parallel_chunks(planes.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      places[i] = lies_alone(cloud, i) || lies_beside(planes[i])  ? Place::nowhere
                  : planes[i].reach_m <= most_m                   ? Place::body
                  : is_flat(planes[i]) || lies_on_sheet(cloud, i) ? Place::thin_sheet
                                                                  : Place::nowhere;
  });
  return places;
}

// Thin sheets that agree, from neighbour to neighbour, with no body, and are too small to be one.
void leave_out_islands(const Cloud& cloud, std::vector<Place>& places) {
  DisjointSets pieces(places.size());
  for (std::uint32_t i = 0; i < places.size(); ++i)
    if (places[i] == Place::thin_sheet)
      for (const std::uint32_t n : cloud.around(i))
        if (places[n] != Place::nowhere && agree(cloud, i, n)) pieces.unite(i, n);
  std::vector<std::size_t> size(places.size(), 0);
  const auto least = static_cast<std::size_t>(body_share * static_cast<double>(places.size()));
  for (std::uint32_t i = 0; i < places.size(); ++i)
    if (places[i] != Place::nowhere)
      size[pieces.name_of(i)] += places[i] == Place::body ? places.size() : 1;
  for (std::uint32_t i = 0; i < places.size(); ++i)
    if (places[i] == Place::thin_sheet && size[pieces.name_of(i)] < least)
      places[i] = Place::nowhere;
}

}  // namespace

std::vector<char> outlying(const LocalPlanes& all, std::span<const Eigen::Vector3d> points) {
  std::vector<char> out(all.planes.size(), 0);
  if (all.neighbours < 3) return out;
  const Cloud cloud{all, points};
  std::vector<Place> where = places(cloud);
  leave_out_islands(cloud, where);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = where[i] == Place::nowhere;
  return out;
}

}  // namespace scan
