// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/colour_map.h"

#include <algorithm>
#include <cmath>

namespace scan {
namespace {

double linear_from_srgb(double v) {
  v /= 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::uint8_t srgb_from_linear(double v) {
  const double coded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(coded, 0.0, 1.0)));
}

}  // namespace

Colour diverging_colour(double t) {
  if (std::isnan(t)) return {150, 150, 150};
  const double share = std::min(1.0, std::abs(t));
  const Colour white = {247, 247, 247};
  const Colour end = t < 0 ? Colour{33, 102, 172} : Colour{178, 24, 43};
  Colour colour;
  for (int channel = 0; channel < 3; ++channel)
    colour[channel] = srgb_from_linear((1 - share) * linear_from_srgb(white[channel]) +
                                       share * linear_from_srgb(end[channel]));
  return colour;
}

}  // namespace scan
