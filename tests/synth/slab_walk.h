// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// An oracle for translucent bodies: a plain random walk in a plane-parallel slab, which shares no
// code with the library but its random numbers.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "tests/synth/stream_mean.h"

namespace scan::synth {

// Between z = 0, where light enters, and z = thickness_m; `index` over that of the outside.
struct Slab {
  double absorption_per_m = 0;
  double scattering_per_m = 1;
  double mean_cosine = 0;
  double index = 1;
  double thickness_m = std::numeric_limits<double>::infinity();
  bool beam = false;  // light enters at the origin at right angles; else evenly from all sides
};

// Over the light that falls on it (a beam: that enters it).
struct SlabLight {
  StreamMean reflected;  // from inside
  StreamMean transmitted;
  StreamMean absorbed;
  StreamMean path_m;              // mean geometric length inside of the light that comes back
  StreamMean square_radius_m2;    // mean of its squared distance from the beam
  StreamMean leaving_path_m;      // of all light that leaves, over the light that falls on it
  std::vector<StreamMean> rings;  // shares of it that leave between the radii asked for
};

// Of unpolarised light at a flat boundary; index: behind over before.
inline double fresnel_of_slab(double cosine, double index) {
  const double sine2 = (1 - cosine * cosine) / (index * index);
  if (sine2 >= 1) return 1;
  const double behind = std::sqrt(1 - sine2);
  const double s = (cosine - index * behind) / (cosine + index * behind);
  const double p = (index * cosine - behind) / (index * cosine + behind);
  return (s * s + p * p) / 2;
}

struct Photon {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double weight = 1;
  double path_m = 0;
};

inline Photon entering(const Slab& slab, RandomStream& random) {
  Photon photon;
  if (slab.beam) return photon;
  const double cosine = std::sqrt(1 - random.uniform());
  const double sine = std::sqrt(1 - cosine * cosine) / slab.index;
  photon.direction = {sine, 0, std::sqrt(1 - sine * sine)};
  photon.weight = 1 - fresnel_of_slab(cosine, slab.index);
  return photon;
}

// Henyey and Greenstein by the textbook's formula about the axis, then turned to it.
inline Eigen::Vector3d scattered(const Eigen::Vector3d& travel, double g, RandomStream& random) {
  const double u = random.uniform(), turn = 2 * std::numbers::pi * random.uniform();
  const double s = (1 - g * g) / (1 - g + 2 * g * u);
  const double c = g == 0 ? 1 - 2 * u : (1 + g * g - s * s) / (2 * g);
  const double sine = std::sqrt(std::max(0.0, 1 - c * c));
  const Eigen::Vector3d local(sine * std::cos(turn), sine * std::sin(turn), c);
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), travel) * local;
}

// Until the photon leaves (z tells where) or dies; returns the energy absorbed on the way. A faint
// photon lives on by chance, with what the others lose (roulette keeps the mean).
inline double walk(const Slab& slab, Photon& photon, RandomStream& random) {
  const double extinction = slab.absorption_per_m + slab.scattering_per_m;
  double absorbed = 0;
  while (true) {
    double flight_m = -std::log1p(-random.uniform()) / extinction;
    const double dz = photon.direction.z();
    const double face = dz < 0 ? 0 : slab.thickness_m;
    const double to_face_m =
        dz == 0 ? std::numeric_limits<double>::infinity() : (face - photon.x.z()) / dz;
    if (flight_m >= to_face_m) {
      photon.x += to_face_m * photon.direction;
      photon.x.z() = face;
      photon.path_m += to_face_m;
      if (random.uniform() >= fresnel_of_slab(std::abs(dz), 1 / slab.index)) return absorbed;
      photon.direction.z() = -dz;  // the flight starts anew: it has no memory
      continue;
    }
    photon.x += flight_m * photon.direction;
    photon.path_m += flight_m;
    absorbed += photon.weight * slab.absorption_per_m / extinction;
    photon.weight *= slab.scattering_per_m / extinction;
    if (photon.weight < 0.02) {
      const bool lives = random.uniform() < 0.1;
      absorbed += photon.weight * (lives ? -9 : 1);
      photon.weight *= lives ? 10 : 0;
      if (!lives) return absorbed;
    }
    photon.direction = scattered(photon.direction, slab.mean_cosine, random).normalized();
  }
}

inline SlabLight light_of(const Slab& slab, int photons, const std::vector<double>& radii_m = {},
                          int batches = 32) {
  const std::size_t quantities = 6 + radii_m.size();
  std::vector<std::vector<double>> found(quantities, std::vector<double>(batches, 0.0));
  parallel_for(
      batches,
      [&](std::size_t batch) {
        std::vector<double> sum(quantities, 0.0);
        for (int i = 0; i < photons / batches; ++i) {
          RandomStream random(21, static_cast<std::uint32_t>(batch), i);
          Photon photon = entering(slab, random);
          sum[2] += walk(slab, photon, random);
          sum[5] += photon.weight * photon.path_m;
          if (photon.x.z() > 0) {
            sum[1] += photon.weight;
            continue;
          }
          const double radius_m = photon.x.head<2>().norm();
          sum[0] += photon.weight;
          sum[3] += photon.weight * photon.path_m;
          sum[4] += photon.weight * radius_m * radius_m;
          for (std::size_t k = 1; k < radii_m.size(); ++k)
            if (radius_m >= radii_m[k - 1] && radius_m < radii_m[k]) sum[5 + k] += photon.weight;
        }
        for (std::size_t q = 0; q < quantities; ++q)
          found[q][batch] = q == 3 || q == 4 ? sum[q] / sum[0] : sum[q] / (photons / batches);
      },
      1);
  SlabLight light{mean_of(found[0]),
                  mean_of(found[1]),
                  mean_of(found[2]),
                  mean_of(found[3]),
                  mean_of(found[4]),
                  mean_of(found[5]),
                  {}};
  for (std::size_t k = 1; k < radii_m.size(); ++k) light.rings.push_back(mean_of(found[5 + k]));
  return light;
}

}  // namespace scan::synth
