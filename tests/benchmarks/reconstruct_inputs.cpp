// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/reconstruct_inputs.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "libscan/io/ply.h"
#include "libscan/io/scan_file.h"
#include "libscan/search/kd_tree.h"
#include "libscan/verify/surface_error.h"
#include "tests/benchmarks/reconstruct_bodies.h"
#include "tests/benchmarks/reconstruct_views.h"

namespace scan {
namespace {

namespace fs = std::filesystem;

enum class Damage {
  none,
  density,
  holes,
  cap,
  outliers,
  flips,
  patch,
  views,
  turned_views,
  scanned
};

struct Plan {
  const char* name;
  const char* body;
  double noise_percent = 0;  // of the diagonal
  Damage damage = Damage::none;
  double amount = 0;      // outliers and flips: share
  std::size_t count = 0;  // 0: what the caller wants
};

const std::vector<Plan>& plans() {
  static const std::vector<Plan> list{
      {"sphere", "sphere"},
      {"torus", "torus"},
      {"csg", "csg"},
      {"bunny", "bunny"},
      {"plate", "plate"},
      {"torus-0.1", "torus", 0.1},
      {"bunny-0.1", "bunny", 0.1},
      {"csg-0.1", "csg", 0.1},
      {"plate-0.1", "plate", 0.1},
      {"torus-0.5", "torus", 0.5},
      {"bunny-0.5", "bunny", 0.5},
      {"csg-0.5", "csg", 0.5},
      {"torus-1", "torus", 1},
      {"bunny-1", "bunny", 1},
      {"csg-1", "csg", 1},
      {"bunny-outliers-5", "bunny", 0.1, Damage::outliers, 0.05},
      {"bunny-outliers-20", "bunny", 0.1, Damage::outliers, 0.20},
      {"bunny-flipped-10", "bunny", 0.1, Damage::flips, 0.10},
      {"bunny-flipped-30", "bunny", 0.1, Damage::flips, 0.30},
      {"bunny-flipped-patch", "bunny", 0.1, Damage::patch},
      {"torus-density", "torus", 0.05, Damage::density},
      {"bunny-density", "bunny", 0.05, Damage::density},
      {"torus-holes", "torus", 0.05, Damage::holes},
      {"bunny-holes", "bunny", 0.05, Damage::holes},
      {"smooth-bunny", "smooth-bunny"},
      {"smooth-bunny-0.1", "smooth-bunny", 0.1},
      {"smooth-bunny-0.5", "smooth-bunny", 0.5},
      {"smooth-bunny-density", "smooth-bunny", 0.05, Damage::density},
      {"bunny-5000", "bunny", 0, Damage::none, 0, 5000},
      {"sphere-cap", "sphere", 0.05, Damage::cap},
      {"bunny-views", "bunny", 0.05, Damage::turned_views},
      {"anchor-views", "anchor", 0.05, Damage::views},
      {"lordquas-views", "lordquas", 0.05, Damage::views},
      {"anchor-3000", "anchor", 0, Damage::scanned},
      {"lordquas-3000", "lordquas", 0, Damage::scanned},
      {"bunny-scans", "bunny", 0, Damage::scanned},
  };
  return list;
}

Bounds bounds(const TrueSurface& truth) {
  return truth.meshes.empty() ? bounds_of(truth.shapes.front())
                              : bounds_of(truth.meshes.front().vertices);
}

Eigen::Vector3d random_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

Eigen::Vector3d random_in(const Bounds& box, RandomStream& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return box.min() + Eigen::Vector3d(x, y, z).cwiseProduct(box.sizes());
}

using Samples = std::vector<SurfaceSample>;

void keep_some(Samples& samples, std::uint64_t seed,
               const std::function<double(const Eigen::Vector3d&)>& share) {
  RandomStream random(seed, 1, 0);
  std::erase_if(samples,
                [&](const SurfaceSample& s) { return !(random.uniform() < share(s.point)); });
}

// Samples of the body, less those that the damage takes away.
Samples samples_of(const TrueSurface& truth, const Plan& plan, std::size_t count) {
  const Bounds box = bounds(truth);
  switch (plan.damage) {
    case Damage::density: {
      // The mean of 200^-u over [0, 1] is 1 / 5.3; other distributions along x are not far off.
      Samples samples = sample_truth(truth, 12 * count, 1);
      keep_some(samples, 2, [&](const Eigen::Vector3d& x) {
        return std::pow(200.0, -(x[0] - box.min()[0]) / box.sizes()[0]);
      });
      RandomStream random(3, 0, 0);
      for (std::size_t i = 0; i < samples.size(); ++i)  // Fisher and Yates
        std::swap(samples[i], samples[i + random.bits32() % (samples.size() - i)]);
      samples.resize(std::min(samples.size(), count));
      return samples;
    }
    case Damage::holes: {
      Samples samples = sample_truth(truth, count, 1);
      for (const SurfaceSample& hole : sample_truth(truth, 6, 7))
        keep_some(samples, 2, [&](const Eigen::Vector3d& x) {
          return (x - hole.point).norm() > 0.07 * box.diagonal().norm() ? 1.0 : 0.0;
        });
      return samples;
    }
    case Damage::cap: {
      Samples samples = sample_truth(truth, count * 20 / 7, 1);  // 0.35 of the sphere
      keep_some(samples, 2, [](const Eigen::Vector3d& x) { return x[2] > 0.3 ? 1.0 : 0.0; });
      return samples;
    }
    default:
      return sample_truth(truth, count, 1);
  }
}

// Directions of least spread among the nearest points, turned as the normals that are there.
void fit_normals(PointCloud& cloud, std::size_t neighbours) {
  const KdTree tree(cloud.points);
  parallel_for(cloud.size(), [&](std::size_t i) {
    std::vector<Neighbour> near;
    tree.k_nearest(cloud.points[i], neighbours, near);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Neighbour& n : near) mean += cloud.points[n.index];
    mean /= static_cast<double>(near.size());
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const Neighbour& n : near) {
      const Eigen::Vector3d x = cloud.points[n.index] - mean;
      moments += x * x.transpose();
    }
    const Eigen::Vector3d normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
    cloud.normals[i] = normal.dot(cloud.normals[i]) < 0 ? Eigen::Vector3d(-normal) : normal;
  });
}

void round_to_floats(std::vector<Eigen::Vector3d>& points) {
  for (auto& x : points) x = x.cast<float>().cast<double>();
}

std::size_t neighbours_at(double noise_percent) {
  return noise_percent > 0.7 ? 60 : noise_percent > 0.2 ? 40 : 20;
}

void add_noise(PointCloud& cloud, double sigma_m) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RandomStream random(4, 0, i);
    cloud.points[i] += sigma_m * random_vector(random);
  }
}

void add_outliers(PointCloud& cloud, Bounds box, double share) {
  const Eigen::Vector3d grow = 0.1 * box.sizes();
  box = Bounds(box.min() - grow, box.max() + grow);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(cloud.size()));
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(5, 0, i);
    cloud.points.push_back(random_in(box, random));
    cloud.normals.push_back(random_vector(random).normalized());
  }
}

void flip(PointCloud& cloud, const Plan& plan, const Bounds& box) {
  const Eigen::Vector3d end(box.max()[0], box.center()[1], box.center()[2]);
  Eigen::Vector3d centre = cloud.points.front();
  for (const auto& x : cloud.points)
    if ((x - end).norm() < (centre - end).norm()) centre = x;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RandomStream random(6, 0, i);
    const bool wrong = plan.damage == Damage::patch
                           ? (cloud.points[i] - centre).norm() < 0.2 * box.diagonal().norm()
                           : random.uniform() < plan.amount;
    if (wrong) cloud.normals[i] = -cloud.normals[i];
  }
}

PointCloud sampled_cloud(const TrueSurface& truth, const Plan& plan, std::size_t count) {
  const Bounds box = bounds(truth);
  PointCloud cloud;
  for (const SurfaceSample& sample : samples_of(truth, plan, count)) {
    cloud.points.push_back(sample.point);
    cloud.normals.push_back(sample.normal);
  }
  if (plan.noise_percent > 0) {
    add_noise(cloud, plan.noise_percent / 100 * box.diagonal().norm());
    fit_normals(cloud, neighbours_at(plan.noise_percent));
  }
  if (plan.damage == Damage::outliers) add_outliers(cloud, box, plan.amount);
  if (plan.damage == Damage::flips || plan.damage == Damage::patch) flip(cloud, plan, box);
  round_to_floats(cloud.points);
  return cloud;
}

void take_views(ReconstructInput& input, const Plan& plan, std::size_t count) {
  const double diagonal_m = input.diagonal_m;
  ViewOptions options{.points = count, .sigma_m = plan.noise_percent / 100 * diagonal_m};
  if (plan.damage == Damage::turned_views) {
    options.displacement_m = 0.0008 * diagonal_m;
    options.turn_rad = 0.0015;
  }
  Views views = views_of(input.truth.meshes.front(), options);
  input.cloud = std::move(views.cloud);
  input.viewpoints = std::move(views.viewpoints);
  fit_normals(input.cloud, neighbours_at(plan.noise_percent));
  round_to_floats(input.cloud.points);
}

void read_scanned(ReconstructInput& input, const Plan& plan, const fs::path& data) {
  if (std::string(plan.body) == "bunny") {
    Views views = stanford_views(data);
    input.cloud = std::move(views.cloud);
    input.viewpoints = std::move(views.viewpoints);
    return;
  }
  const fs::path file =
      data / "reconbench" / "derived" / (plan.body + std::string("_mvs_full.ply"));
  const Ply ply = read_ply(file);
  input.cloud = cloud_from(ply, file);
  const PlyElement& vertex = *ply.find("vertex");
  const auto x = vertex.numbers("sx"), y = vertex.numbers("sy"), z = vertex.numbers("sz");
  for (std::size_t i = 0; i < x.size(); ++i) input.viewpoints.push_back({x[i], y[i], z[i]});
}

}  // namespace

const std::vector<std::string>& reconstruct_input_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Plan& plan : plans()) list.push_back(plan.name);
    return list;
  }();
  return names;
}

ReconstructInput make_reconstruct_input(const std::string& name, const fs::path& data,
                                        std::size_t count) {
  const auto plan = std::find_if(plans().begin(), plans().end(),
                                 [&](const Plan& candidate) { return name == candidate.name; });
  if (plan == plans().end())
    throw Error(Trouble::usage, "input: " + name + " is unknown",
                "nearest: " + nearest_word(name, reconstruct_input_names()));
  ReconstructInput input;
  input.name = name;
  input.truth = reconstruct_body(plan->body, data);
  input.diagonal_m = bounds(input.truth).diagonal().norm();
  if (plan->count > 0) count = plan->count;
  if (plan->damage == Damage::scanned)
    read_scanned(input, *plan, data);
  else if (plan->damage == Damage::views || plan->damage == Damage::turned_views)
    take_views(input, *plan, count);
  else
    input.cloud = sampled_cloud(input.truth, *plan, count);
  return input;
}

}  // namespace scan
