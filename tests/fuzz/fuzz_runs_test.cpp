// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Broken copies of what a run folder holds.
#include <gtest/gtest.h>

#include "libscan/io/raw_files.h"
#include "libscan/io/run_folder.h"
#include "libscan/io/truth_file.h"
#include "tests/fuzz/fuzz.h"
#include "tools/run_files.h"

namespace scan::test {
namespace {

TEST(Fuzz, RunFolder) {
  const TemporaryFolder folder;
  RunFolder run = open_run_folder(folder.path(), RunStart::fresh);
  write_file(folder / "surface.ply", "a surface");
  record_stage(run, "reconstruct", "0123456789abcdef", {"surface.ply"});
  fuzz(folder / "stages.json", [](const auto& path) {
    (void)is_done(open_run_folder(path.parent_path(), RunStart::resume), "reconstruct", "0");
  });
  write_file(folder / "alignment.json", R"({
      "scans": [{"file": "000.ply", "world_from_scan":
          [[1, 0, 0, 0.5], [0, 1, 0, 0.25], [0, 0, 1, 2], [0, 0, 0, 1]],
          "covariance": [[1,0,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],
          [0,0,0,0,1,0],[0,0,0,0,0,1]], "covariance_centre_m": [0, 0, 0]},
        {"file": "001.ply", "world_from_scan":
          [[1, 0, 0, 1.5], [0, 1, 0, 0.25], [0, 0, 1, 2], [0, 0, 0, 1]],
          "covariance": null, "covariance_centre_m": null}],
      "covariances_between": [{"scans": [0, 1], "covariance": [[1,0,0,0,0,0],[0,1,0,0,0,0],
          [0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]}]})");
  fuzz(folder / "alignment.json", [](const auto& path) {
    const StatedPoses poses = read_run_stated_poses(path.parent_path());
    for (const auto& pose : poses.scans)
      if (pose) expect_finite("a covariance", pose->covariance);
    for (const CommonCovariance& couple : poses.between) {
      expect_finite("a covariance between scans", couple.covariance);
      if (couple.first >= couple.second || couple.second >= poses.scans.size())
        throw std::logic_error("a covariance between scans that are not there");
    }
  });
}

TEST(Fuzz, Truth) {
  const TemporaryFolder folder;
  TrueSurface surface;
  surface.shapes.push_back({Pose::Identity(), SphereShape{1.0 / 3}});
  surface.shapes.push_back({Pose::Identity(), BoxShape{.size_m = {1, 1, 1}}});
  surface.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  std::vector<RayTruth> rays(3);
  rays[1] = {{0, 0, 1}, {0, 0, -1}, 1};
  write_true_rays(folder.path(), 0, rays);
  write_true_scene(folder.path(), surface, {Pose::Identity()});
  for (const char* name : {"surface.json", "000.ply", "poses.tum"})
    fuzz(folder / name, [](const auto& path) { (void)read_truth(path.parent_path()); });
  fuzz(folder / "surface.json", [](const auto& path) { (void)read_true_surface(path); });
}

TEST(Fuzz, RawFramesOfALidar) {
  const TemporaryFolder folder;
  Waveforms frames;
  frames.samples_per_ray = 6;
  for (int i = 0; i < 4; ++i) {
    frames.directions.emplace_back(0, 0, 1);
    frames.first_sample.push_back(static_cast<std::uint32_t>(i));
    frames.scanner_from_ray.push_back(Pose::Identity());
  }
  frames.samples.assign(24, 77);
  write_raw_frames(folder.path(), frames);
  for (const char* name :
       {"samples.npy", "directions.npy", "first_samples.npy", "poses.npy", "calibration.json"})
    fuzz(folder / name, [](const auto& path) {
      const auto run = path.parent_path();
      const RawFrames read = read_raw_frames("waveform", {run}, run / "calibration.json");
      for (const Eigen::Vector3d& ray : std::get<Waveforms>(read).directions)
        expect_finite("a direction", ray);
    });
}

}  // namespace
}  // namespace scan::test
