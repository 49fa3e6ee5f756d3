// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A stereo pair as it was taken, turned into the pair that `stereo` matches: no distortion,
// corresponding points in one row.
#pragma once

#include "libscan/core/camera.h"
#include "libscan/core/image.h"
#include "libscan/core/pose.h"
#include "libscan/core/raw_frames.h"

namespace scan {

// Two cameras with pictures of one size.
struct StereoRig {
  Camera left;
  Camera right;
  Pose right_from_left = Pose::Identity();
};

// How the pair is rectified: both cameras are turned about their centres so that their rows follow
// the baseline and they look where they did in the mean. The scanner frame is the turned left
// camera.
struct Rectification {
  StereoRig rig;
  StereoCalibration calibration;
  Eigen::Matrix3d rectified_from_left = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d rectified_from_right = Eigen::Matrix3d::Identity();
};

// The middles of both pictures stay in the middle; the focal length is the mean of the four; the
// search range holds depths from `nearest_m` to `farthest_m`. Throws scan::Error (input) for
// pictures of two sizes, a right camera that is not to the right of the left one within 45 degrees,
// cameras that look more than 45 degrees past each other or along the baseline, and an empty depth
// range.
Rectification rectify(const StereoRig& rig, double nearest_m, double farthest_m);

// Both pictures resampled by cubic convolution (Keys 1981); black where the camera saw nothing.
ImagePair rectify(const Rectification& rectification, const Image<std::uint8_t>& left,
                  const Image<std::uint8_t>& right);

}  // namespace scan
