// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far one sees, as an extinction per metre. Two definitions are in use and differ by a factor
// 1.3: the meteorological optical range (5 % contrast, or light) and visibility (2 % contrast).
#pragma once

namespace scan::synth {

// Meteorological optical range (WMO, CIMO guide): where 5 % of the light is left, ln(20) / MOR. Of
// any wavelength, as it holds in fog.
double extinction_by_optical_range(double optical_range_m);

// Visibility at 550 nm where 2 % contrast is left, 3.91 / V (Koschmieder 1924), carried over to
// another wavelength by (wavelength / 550 nm)^-q.
// Kruse et al. 1962: q = 1.6 beyond 50 km, 1.3 down to 6 km, 0.585 (V / km)^(1/3) below: haze.
double extinction_by_kruse(double visibility_m, double wavelength_m);
// Kim, McArthur, Korevaar 2001: as Kruse from 6 km, then 0.16 V / km + 0.34 down to 1 km, V / km -
// 1/2 down to 500 m, and 0 (no colour) in fog.
double extinction_by_kim(double visibility_m, double wavelength_m);

}  // namespace scan::synth
