// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/acquire.h"

namespace scan {
namespace {

struct Decoder {
  const AcquireOptions& options;

  Scan operator()(const StripeImages& frames) const {
    Scan scan = acquire_laser_line(frames, options.laser_line);
    std::vector<Eigen::Vector3d> camera_origins;
    camera_origins.reserve(scan.ray.size());
    for (const std::uint32_t ray : scan.ray)
      camera_origins.push_back(frames.scanner_from_camera[ray / scan.grid.columns].translation());
    estimate_normals(scan, options.normals, camera_origins);
    return scan;
  }
  Scan operator()(const ImagePair& frames) const {
    return with_normals(acquire_stereo(frames, options.stereo));
  }
  Scan operator()(const PhaseTaps& frames) const {
    return with_normals(acquire_phase(frames, options.phase));
  }
  Scan operator()(const Waveforms& frames) const {
    Scan scan = acquire_waveform(frames, options.waveform);
    std::vector<Eigen::Vector3d> origins;
    if (!frames.scanner_from_ray.empty())
      for (const std::uint32_t ray : scan.ray)
        origins.push_back(frames.scanner_from_ray[ray].translation());
    estimate_normals(scan, options.normals, origins);
    return scan;
  }

 private:
  Scan with_normals(Scan scan) const {
    estimate_normals(scan, options.normals);
    return scan;
  }
};

}  // namespace

Scan acquire(const RawFrames& frames, const AcquireOptions& options) {
  return std::visit(Decoder{options}, frames);
}

}  // namespace scan
