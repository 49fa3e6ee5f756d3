// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Laser triangulation: the stripe's place in each image row, then the light plane's intersection.
#pragma once

#include "libscan/core/raw_frames.h"
#include "libscan/core/scan.h"

namespace scan {

enum class PeakMethod { centroid, gaussian, parabola };

struct LaserLineOptions {
  PeakMethod peak = PeakMethod::gaussian;
  double threshold_sigmas = 6;  // a peak must stand so far above the row's background noise
  // Largest rms deviation of the stripe from its Gaussian, beyond noise, as a share of its height.
  // A stripe cut by an edge has lost its shape and shifts by up to a beam's width (Curless and
  // Levoy 1995); texture and speckle spoil the shape of good ones too.
  double max_shape_error = 0.15;
};

// Scanner frame, sigma along the camera's ray, covariance from the triangulation's Jacobian: of
// rank one, since an image row is a choice and only the column is measured. A stripe that form and
// brightness of the body have moved is moved back as far as other rows tell, and both count,
// besides noise, how far it may be off still (stripe_bias.h). One peak per row: the strongest if no
// other is half as high (else ambiguous); clipped: saturated; cut by an edge, or seen at one step
// alone of several (stripe_bias.h): inconsistent; its +-3 sigma cut by the image: border; parallel
// to the light plane within three sigma, or behind: undetermined. Throws scan::Error (input) for
// frames that do not fit their calibration.
Scan acquire_laser_line(const StripeImages& frames, const LaserLineOptions& options = {});

}  // namespace scan
