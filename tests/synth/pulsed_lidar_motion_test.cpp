// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A lidar whose platform moves between its pulses.
#include <cmath>

#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

PulsedLidar moving_lidar() {
  PulsedLidar lidar = small_lidar();
  lidar.motion = {.interval_s = 1e-3,
                  .velocity_m_s = {3, -2, 20},
                  .angular_velocity_rad_s = {0.4, 1.5, -0.2},
                  .is_measured = true};
  return lidar;
}

const EffectSet with_motion = {Effect::quantisation, Effect::footprint, Effect::motion};

Waveforms frames_of(const PulsedLidar& lidar, const Scene& scene, const EffectSet& effects) {
  return std::get<Waveforms>(render(lidar, RayCaster(scene), Pose::Identity(), {}, effects).frames);
}

// 48 pulses of 1 ms: the first at -23.5 ms, the last at +23.5 ms; a turn by w t about w.
TEST(PulsedLidarMotion, IsStraightAndTurnsSteadily) {
  const PulsedLidar lidar = moving_lidar();
  for (const std::size_t ray : {std::size_t{0}, std::size_t{30}, std::size_t{47}}) {
    const double time_s = (static_cast<double>(ray) - 23.5) * 1e-3;
    const Pose pose = scan_from_scanner(lidar, ray);
    EXPECT_LT((pose.translation() - time_s * lidar.motion.velocity_m_s).norm(), 1e-15);
    const Eigen::Vector3d& turn = lidar.motion.angular_velocity_rad_s;
    EXPECT_NEAR(rotation_angle_rad(pose.linear()), std::abs(time_s) * turn.norm(), 1e-14);
    EXPECT_LT((pose.linear() * turn - turn).norm(), 1e-15);
  }
}

// A fan of 5 beams over 16 columns fires column by column.
TEST(PulsedLidarMotion, FiresAFanColumnByColumn) {
  PulsedLidar lidar = moving_lidar();
  lidar.pattern = SpinningPattern{.rows = 5, .columns = 16};
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 16; ++column) {
      const double time_s = (column * 5 + row - 39.5) * 1e-3;
      const Pose pose = scan_from_scanner(lidar, row * 16 + column);
      EXPECT_LT((pose.translation() - time_s * lidar.motion.velocity_m_s).norm(), 1e-15);
    }
}

// The echo of ray r comes from where the plane z = 12 is met from the scanner's place at t_r; by
// the closed form |p + s R d| = 12 in z, s = (12 - p_z) / (R d)_z.
TEST(PulsedLidarMotion, ShiftsTheEchoesAndTheTruth) {
  const PulsedLidar lidar = moving_lidar();
  const Scene scene = scene_of(plane_at(12), 0.5);
  const Waveforms frames = frames_of(lidar, scene, with_motion);
  const auto truth = true_rays(lidar, RayCaster(scene), Pose::Identity());
  ASSERT_EQ(frames.scanner_from_ray.size(), 48u);
  for (std::size_t ray = 0; ray < 48; ++ray) {
    const Pose& pose = frames.scanner_from_ray[ray];
    EXPECT_EQ(pose.matrix(), scan_from_scanner(lidar, ray).matrix());
    const Eigen::Vector3d along = pose.linear() * frames.directions[ray];
    const double range_m = (12 - pose.translation().z()) / along.z();
    EXPECT_LT((truth[ray].point_in_scanner - pose.translation() - range_m * along).norm(), 1e-12);
    std::vector<double> samples(frames.samples.begin() + ray * frames.samples_per_ray,
                                frames.samples.begin() + (ray + 1) * frames.samples_per_ray);
    // Rounding by 1/2 in some 20 samples within 10 ns, of 1700 e: 0.06 ns; the ranges of rays and
    // poses differ by 0.5 m = 3 ns and more.
    EXPECT_NEAR(moments_of(lidar, samples).time_s, 2 * range_m / c, 0.06e-9) << ray;
  }
}

// Not measured: the frames do not tell. Off: as if it stood still, and nothing to tell.
TEST(PulsedLidarMotion, IsToldOnlyIfMeasuredAndSimulated) {
  PulsedLidar lidar = moving_lidar();
  const Scene scene = scene_of(plane_at(12), 0.5);
  const Waveforms measured = frames_of(lidar, scene, with_motion);
  const Waveforms off = frames_of(lidar, scene, with_motion.without(Effect::motion));
  lidar.motion.is_measured = false;
  const Waveforms untold = frames_of(lidar, scene, with_motion);
  EXPECT_TRUE(untold.scanner_from_ray.empty());
  EXPECT_EQ(untold.samples, measured.samples);
  EXPECT_TRUE(off.scanner_from_ray.empty());
  lidar.motion = {};
  EXPECT_EQ(off.samples, frames_of(lidar, scene, with_motion).samples);
  EXPECT_NE(off.samples, measured.samples);
}

TEST(PulsedLidarMotion, NamesTheFieldThatIsWrong) {
  PulsedLidar lidar = moving_lidar();
  lidar.motion.interval_s = -1;
  EXPECT_EQ(complaint(lidar), "pulsed_lidar/motion.interval_s: -1, must be from 0 to 1000");
  lidar = moving_lidar();
  lidar.motion.velocity_m_s.x() = std::nan("");
  EXPECT_NE(complaint(lidar).find("motion.velocity_m_s: nan"), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
