// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/choose_method.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "libscan/core/median.h"
#include "libscan/reconstruct/local_planes.h"
#include "libscan/reconstruct/samples.h"
#include "libscan/reconstruct/winding_number.h"

namespace scan {
namespace {

constexpr std::size_t neighbours = 24;
// Chosen from the scans of three bodies in docs/results.md: up to 0.22 SSD is nearer than local
// fits or at most twice as far, and closed; from 0.32 on its lid makes it worse, as on one scan at
// 0.23.
constexpr double most_open = 0.25;
// Thickness is the scatter, width some 1.4 spacings: scatter of a third of a spacing.
// Clouds with 0.1 % noise (torus, bunny) are at 0.19 and count as flat; local fits are near their
// end there: of the bunny they leave genus 3 and 100 open edges.
constexpr double flat = 0.25;
constexpr double trim_spacings = 3;  // gaps that chance leaves are narrower

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

// The winding number on a closed surface is 1/2 in the mean, -1/2 if its normals face inward. Seen
// from the surface, what is missing takes its share of half the directions.
double open_share(const PointCloud& cloud) {
  const WindingNumber winding(prepare_samples(cloud));
  return std::max(0.0, 1 - 2 * std::abs(winding.on_surface()));
}

double median_unflatness(const LocalPlanes& all) {
  std::vector<double> ratios;
  for (const LocalPlane& plane : all.planes)
    ratios.push_back(plane.width_m > 0 ? plane.thickness_m / plane.width_m : 1);
  return median(std::move(ratios));
}

}  // namespace

MethodChoice choose_method(const PreparedPoints& points) {
  MethodChoice choice;
  choice.open_share = open_share(points.cloud);
  choice.unflatness = median_unflatness(local_planes(points.cloud.points, neighbours));
  const std::string missing =
      "seen from itself, at most some " + percent(choice.open_share) + " of it is missing";
  if (choice.open_share <= most_open) {
    choice.reason = "the surface is closed (" + missing + "), which SSD makes most accurately";
  } else if (choice.unflatness < flat) {
    choice.method = ReconstructMethod::mls;
    choice.reason = "the surface is open (" + missing +
                    ") and smooth, and local fits end where the samples end";
  } else {
    choice.trim_m = trim_spacings * median(points.spacing_m);
    choice.reason =
        "the surface is open (" + missing +
        ") and too noisy for local fits, so SSD's is cut off where it leaves the points";
  }
  return choice;
}

}  // namespace scan
