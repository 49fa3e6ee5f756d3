// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Colours for signed deviations: blue below, white at zero, red above; safe for colour-blind
// readers.
#pragma once

#include "libscan/io/image_file.h"

namespace scan {

// `t` in [-1, 1], clamped; NaN is grey ("no data"). Blue (33, 102, 172) to white to red (178, 24,
// 43), the ends of ColorBrewer's RdBu scheme, blended in linear light.
Colour diverging_colour(double t);

}  // namespace scan
