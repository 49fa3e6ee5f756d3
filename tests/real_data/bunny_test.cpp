// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The ten raw range scans of the Stanford bunny: from disturbed poses back to the published ones,
// and to the published surface.
//
// The references were made from these same scans (registration, then zippering): they are worth 0.2
// to 0.3 mm. The scanner's samples lie 0.5 mm (columns) by 0.7 mm (rows) apart.
#include "libscan/core/point_cloud.h"
#include "libscan/core/random.h"
#include "libscan/core/units.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/verify/pose_error.h"
#include "tests/real_data/real_data.h"

namespace scan::test {
namespace {

const fs::path folder = data_folder("stanford-bunny");

struct Bunny {
  std::vector<NamedPose> published;  // the name is the scan's file
  std::vector<std::vector<Eigen::Vector3d>> points;
};

Bunny read_bunny() {
  Bunny bunny{read_poses(folder / "data/bun.conf"), {}};
  for (const NamedPose& scan : bunny.published)
    bunny.points.push_back(read_scan(folder / "data" / scan.name).cloud.points);
  return bunny;
}

// A turn by 5 degrees about the scan's own centre and a shift by 5 mm, both in random directions.
Pose disturbance(RandomStream random, const Eigen::Vector3d& centre) {
  const auto direction = [&] {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Eigen::Vector3d(x, y, z).normalized();
  };
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(rad_from_deg(5), direction()).toRotationMatrix();
  return make_pose(turn, centre - turn * centre + 5e-3 * direction());
}

// In the form of bun.conf, whose quaternion is the inverse rotation. The first scan keeps its
// published pose: it is the anchor, and so gives the frame in which poses and surface are compared.
void write_disturbed_poses(const fs::path& path, const Bunny& bunny) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < bunny.published.size(); ++i) {
    Pose pose = bunny.published[i].pose;
    const Eigen::Vector3d centre = pose * bounds_of(bunny.points[i]).center();
    if (i > 0) pose = disturbance(RandomStream(1, std::uint32_t(i), 0), centre) * pose;
    const Eigen::Quaterniond q(pose.linear().transpose());
    text << "bmesh " << bunny.published[i].name << " " << pose.translation().transpose() << " "
         << q.coeffs().transpose() << "\n";
  }
  spill(path, text.str());
}

Answer align(const Bunny& bunny, const fs::path& guesses, const fs::path& out) {
  std::vector<std::string> arguments{"align"};
  for (const NamedPose& scan : bunny.published)
    arguments.push_back((folder / "data" / scan.name).string());
  arguments.insert(arguments.end(), {out.string(), "--init", guesses.string()});
  return ask_scan(arguments);
}

// Half a millimetre is one sample spacing, and twice what the published poses are worth. The frame
// common to all scans is free in an alignment: `pose_errors` fits it first.
void expect_published_poses(const Bunny& bunny, const fs::path& alignment) {
  std::vector<Pose> found, published;
  for (const NamedPose& scan : read_poses(alignment)) found.push_back(scan.pose);
  for (const NamedPose& scan : bunny.published) published.push_back(scan.pose);
  ASSERT_EQ(found.size(), published.size());
  const auto errors = pose_errors(found, published, bunny.points);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::cout << "  " << bunny.published[i].name << ": " << 1e3 * errors[i].moved_points_rms_m
              << " mm rms, " << deg_from_rad(errors[i].rotation_rad) << " deg\n";
    EXPECT_LT(errors[i].moved_points_rms_m, 0.5e-3) << bunny.published[i].name;
  }
}

TEST(Bunny, ScansReturnToTheirPosesAndMakeThePublishedSurface) {
  SKIP_WITHOUT(folder);
  const Folder out;
  const Bunny bunny = read_bunny();
  ASSERT_EQ(bunny.published.size(), 10u);
  write_disturbed_poses(out / "disturbed.conf", bunny);

  const Answer aligned = align(bunny, out / "disturbed.conf", out / "aligned");
  ASSERT_EQ(aligned.exit_code, 0) << aligned.err;
  EXPECT_EQ(aligned.json.at("stop"), "converged");
  print_seconds(aligned);
  expect_published_poses(bunny, out / "aligned/alignment.json");

  // Depth 8: cells of about 0.7 mm, the scanner's spacing. 2 mm is four columns or three rows: the
  // surface may bridge a few samples that are missing, not the holes at the bunny's bottom.
  const Answer made = ask_scan({"reconstruct", (out / "aligned/aligned.ply").string(),
                                (out / "surface.ply").string(), "--depth", "8", "--trim", "2mm"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  print_seconds(made);

  const Answer verdict = ask_scan({"verify", (out / "surface.ply").string(), "--truth",
                                   (folder / "reconstruction/bun_zipper.ply").string(), "--poses",
                                   (out / "aligned/alignment.json").string(), "--true-poses",
                                   (folder / "data/bun.conf").string()});
  ASSERT_EQ(verdict.exit_code, 0) << verdict.err;
  // What the reference is worth (0.28 mm), and 0.2 mm beside it for the poses and our surface.
  EXPECT_LE(measured(verdict, "accuracy_rms"), 0.35e-3);
  EXPECT_LE(measured(verdict, "completeness_rms"), 0.35e-3);
  // Heights that are off by 0.14 mm over one cell tilt it by 0.2 rad; inside out it would be pi.
  EXPECT_LE(measured(verdict, "normal_error_mean"), 0.2);
  EXPECT_EQ(measured(verdict, "components"), 1);
  for (const char* name : {"accuracy_mean", "accuracy_p95", "accuracy_max", "completeness_mean",
                           "boundary_edges", "pose_error_rms", "rotation_error"})
    measured(verdict, name);
}

}  // namespace
}  // namespace scan::test
