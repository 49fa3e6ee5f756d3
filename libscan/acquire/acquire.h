// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From raw frames to a scan, whatever the device.
#pragma once

#include "libscan/acquire/laser_line.h"
#include "libscan/acquire/normals.h"
#include "libscan/acquire/phase.h"
#include "libscan/acquire/stereo.h"
#include "libscan/acquire/waveform.h"
#include "libscan/core/raw_frames.h"
#include "libscan/core/scan.h"

namespace scan {

struct AcquireOptions {
  LaserLineOptions laser_line;
  StereoOptions stereo;
  PhaseOptions phase;
  WaveformOptions waveform;
  NormalOptions normals;
};

// Decodes by the kind of the frames, then estimates normals. Every ray ends as a point with sigma
// or under one reason in `misses`: points + misses = rays.
Scan acquire(const RawFrames& frames, const AcquireOptions& options = {});

}  // namespace scan
