// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples beside one another, summed, so that an average over many is one over few.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace scan {

// Sums over the samples of a grain, each counted by its trust.
struct Grain {
  double trust = 0;
  Eigen::Vector3d points = Eigen::Vector3d::Zero();
  Eigen::Vector3d feet = Eigen::Vector3d::Zero();
  Eigen::Vector3d normals = Eigen::Vector3d::Zero();
  double points_along_normals = 0;

  Eigen::Vector3d foot() const { return feet / trust; }
  Eigen::Vector3d normal() const { return normals.normalized(); }
};

// The grain of each sample, counted from 0. Those of one grain have their feet in one cell, a fifth
// to a tenth of their reach wide, and their normals next to the same axis and sense, so that the
// two sides of a thin wall stay apart.
std::vector<std::uint32_t> grains_of(std::span<const Eigen::Vector3d> feet,
                                     std::span<const Eigen::Vector3d> normals,
                                     std::span<const double> reach);

struct GrainSamples {
  std::span<const Eigen::Vector3d> points, feet, normals;
  std::span<const double> trust;  // above 0
};
std::vector<Grain> summed_grains(std::span<const std::uint32_t> grain_of,
                                 const GrainSamples& samples);

}  // namespace scan
