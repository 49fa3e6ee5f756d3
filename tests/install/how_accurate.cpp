// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The whole road by libscan's functions: how well does a phase camera measure a bud from all
// around?
#include <cstdio>

#include "libscan/acquire/acquire.h"
#include "libscan/align/multiview.h"
#include "libscan/reconstruct/reconstruct.h"
#include "libscan/verify/surface_error.h"
#include "synth/ray_caster.h"
#include "synth/scanner.h"
#include "synth/scene.h"
#include "synth/viewpoints.h"

int main() {
  using namespace scan;
  const synth::Scene scene{.objects = {{.name = "bud", .geometry = synth::bud()}},
                           .materials = {{.name = "clay", .bsdf = synth::Lambert{0.6}}}};
  const synth::PhaseCamera camera{.camera = {160, 120, 320, 320, 79.5, 59.5}};
  const synth::Viewpoints around{.layout = synth::Dome{.count = 12, .radius_m = 0.4},
                                 .pose_noise = {.rotation_rad = 0.01, .translation_m = 0.002}};
  const synth::EffectSet effects{synth::Effect::shot_noise, synth::Effect::read_noise};

  const synth::RayCaster caster(scene);
  const std::vector<Pose> poses = true_poses(around);
  std::vector<PointCloud> clouds;  // each in its scanner's frame
  for (std::uint32_t i = 0; i < poses.size(); ++i)
    clouds.push_back(
        acquire(render(camera, caster, poses[i], {.seed = 1, .scan = i}, effects).frames).cloud);

  const MultiviewResult aligned = align_scans(clouds, guessed_poses(around, 1));
  PointCloud points;
  std::vector<Eigen::Vector3d> viewpoints;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const Pose& world_from_scan = aligned.scans[i].world_from_scan;
    append(points, transformed(world_from_scan, clouds[i]));
    viewpoints.resize(points.points.size(), world_from_scan.translation());
  }
  const SurfaceResult result = reconstruct(points, viewpoints);

  double sum_m = 0;
  for (const double sigma_m : points.sigma_m) sum_m += sigma_m;
  std::printf("sigma_of_a_point %.3f mm\n",
              1e3 * sum_m / static_cast<double>(points.points.size()));
  for (const Measurement& figure : surface_error(result.surface, true_surface(scene)))
    if (figure.name.starts_with("accuracy_"))
      std::printf("%s %.3f mm\n", figure.name.c_str(), 1e3 * figure.value);
}
