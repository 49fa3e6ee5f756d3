// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Published refractive indices of metals and clear bodies between 0.4 and 1.6 um.
#include <array>
#include <cmath>
#include <span>

#include "synth/bsdf/fresnel.h"

namespace scan::synth {
namespace {

struct Row {
  double wavelength_um, eta, k;
};

// Rakic 1995, Appl. Opt. 34:4755.
constexpr Row aluminium[] = {
    {0.36466, 0.39877, 4.3957}, {0.41328, 0.52135, 5.0008}, {0.4428, 0.6079, 5.3676},
    {0.47687, 0.7278, 5.7781},  {0.5166, 0.8734, 6.2418},   {0.56357, 1.0728, 6.7839},
    {0.61993, 1.366, 7.4052},   {0.65225, 1.5724, 7.7354},  {0.68881, 1.8301, 8.0601},
    {0.72932, 2.1606, 8.3565},  {0.77491, 2.6154, 8.4914},  {0.79478, 2.7675, 8.3866},
    {0.81569, 2.7668, 8.2573},  {0.83774, 2.6945, 8.1878},  {0.88561, 2.2802, 8.1134},
    {0.91166, 1.9739, 8.3058},  {0.93928, 1.6784, 8.597},   {0.96863, 1.4867, 9.0655},
    {0.99988, 1.4359, 9.4939},  {1.0332, 1.3998, 9.8914},   {1.1271, 1.3281, 10.969},
    {1.2399, 1.3157, 12.245},   {1.3776, 1.3899, 13.784},   {1.5498, 1.5782, 15.656},
    {1.7712, 1.9205, 17.991}};
// Johnson and Christy 1974, Phys. Rev. B 9:5056.
constexpr Row chromium[] = {
    {0.3974, 2, 2.83},    {0.4133, 2.08, 2.93}, {0.4305, 2.19, 3.04}, {0.4509, 2.33, 3.14},
    {0.4714, 2.51, 3.24}, {0.4959, 2.75, 3.3},  {0.5209, 2.94, 3.33}, {0.5486, 3.18, 3.33},
    {0.5821, 3.22, 3.3},  {0.6168, 3.17, 3.3},  {0.6595, 3.09, 3.34}, {0.7045, 3.05, 3.39},
    {0.756, 3.08, 3.42},  {0.8211, 3.2, 3.48},  {0.892, 3.3, 3.52},   {0.984, 3.41, 3.57},
    {1.088, 3.58, 3.58},  {1.216, 3.67, 3.6},   {1.393, 3.69, 3.84},  {1.61, 3.66, 4.31}};
// Johnson and Christy 1972, Phys. Rev. B 6:4370.
constexpr Row copper[] = {
    {0.3974, 1.32, 2.116}, {0.4133, 1.28, 2.207}, {0.4305, 1.25, 2.305}, {0.4509, 1.24, 2.397},
    {0.4714, 1.25, 2.483}, {0.4959, 1.22, 2.564}, {0.5209, 1.18, 2.608}, {0.5486, 1.02, 2.577},
    {0.5821, 0.7, 2.704},  {0.6168, 0.3, 3.205},  {0.6595, 0.22, 3.747}, {0.7045, 0.21, 4.205},
    {0.756, 0.24, 4.665},  {0.8211, 0.26, 5.18},  {0.892, 0.3, 5.768},   {0.984, 0.32, 6.421},
    {1.088, 0.36, 7.217},  {1.216, 0.48, 8.245},  {1.393, 0.6, 9.439},   {1.61, 0.76, 11.12}};
// As copper.
constexpr Row gold[] = {
    {0.3974, 1.47, 1.952}, {0.4133, 1.46, 1.958}, {0.4305, 1.45, 1.948}, {0.4509, 1.38, 1.914},
    {0.4714, 1.31, 1.849}, {0.4959, 1.04, 1.833}, {0.5209, 0.62, 2.081}, {0.5486, 0.43, 2.455},
    {0.5821, 0.29, 2.863}, {0.6168, 0.21, 3.272}, {0.6595, 0.14, 3.697}, {0.7045, 0.13, 4.103},
    {0.756, 0.14, 4.542},  {0.8211, 0.16, 5.083}, {0.892, 0.17, 5.663},  {0.984, 0.22, 6.35},
    {1.088, 0.27, 7.15},   {1.216, 0.35, 8.145},  {1.393, 0.43, 9.519},  {1.61, 0.56, 11.21}};
// As chromium.
constexpr Row iron[] = {
    {0.3974, 2.24, 2.58}, {0.4133, 2.35, 2.65}, {0.4305, 2.48, 2.71}, {0.4509, 2.59, 2.77},
    {0.4714, 2.67, 2.82}, {0.4959, 2.74, 2.88}, {0.5209, 2.86, 2.91}, {0.5486, 2.95, 2.93},
    {0.5821, 2.94, 2.99}, {0.6168, 2.88, 3.05}, {0.6595, 2.92, 3.1},  {0.7045, 2.86, 3.19},
    {0.756, 2.87, 3.28},  {0.8211, 2.94, 3.39}, {0.892, 2.96, 3.56},  {0.984, 2.92, 3.79},
    {1.088, 2.97, 4.06},  {1.216, 3.03, 4.39},  {1.393, 3.09, 4.83},  {1.61, 3.11, 5.39}};
// As copper.
constexpr Row silver[] = {
    {0.3974, 0.05, 2.07},  {0.4133, 0.05, 2.275}, {0.4305, 0.04, 2.462}, {0.4509, 0.04, 2.657},
    {0.4714, 0.05, 2.869}, {0.4959, 0.05, 3.093}, {0.5209, 0.05, 3.324}, {0.5486, 0.06, 3.586},
    {0.5821, 0.05, 3.858}, {0.6168, 0.06, 4.152}, {0.6595, 0.05, 4.483}, {0.7045, 0.04, 4.838},
    {0.756, 0.03, 5.242},  {0.8211, 0.04, 5.727}, {0.892, 0.04, 6.312},  {0.984, 0.04, 6.992},
    {1.088, 0.04, 7.795},  {1.216, 0.09, 8.828},  {1.393, 0.13, 10.1},   {1.61, 0.15, 11.85}};
// At 25 degrees C, Hale and Querry 1973, Appl. Opt. 12:555.
constexpr Row water[] = {{0.4, 1.339, 0}, {0.425, 1.338, 0}, {0.45, 1.337, 0}, {0.475, 1.336, 0},
                         {0.5, 1.335, 0}, {0.525, 1.334, 0}, {0.55, 1.333, 0}, {0.575, 1.333, 0},
                         {0.6, 1.332, 0}, {0.625, 1.332, 0}, {0.65, 1.331, 0}, {0.675, 1.331, 0},
                         {0.7, 1.331, 0}, {0.725, 1.33, 0},  {0.75, 1.33, 0},  {0.775, 1.33, 0},
                         {0.8, 1.329, 0}, {0.825, 1.329, 0}, {0.85, 1.329, 0}, {0.875, 1.328, 0},
                         {0.9, 1.328, 0}, {0.925, 1.328, 0}, {0.95, 1.327, 0}, {0.975, 1.327, 0},
                         {1, 1.327, 0},   {1.2, 1.324, 0},   {1.4, 1.321, 0},  {1.6, 1.317, 0}};

std::optional<RefractiveIndex> between_rows(std::span<const Row> rows, double wavelength_um) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Row &low = rows[i - 1], &high = rows[i];
    if (!(wavelength_um >= low.wavelength_um && wavelength_um <= high.wavelength_um)) continue;
    const double t = (wavelength_um - low.wavelength_um) / (high.wavelength_um - low.wavelength_um);
    return RefractiveIndex{(1 - t) * low.eta + t * high.eta, (1 - t) * low.k + t * high.k};
  }
  return std::nullopt;
}

// Squared index at a squared wavelength in um^2, within the range that was measured.
struct Dispersion {
  double least_um, most_um;
  double (*index2)(double);
};

// Schott's data sheet of N-BK7 (Sellmeier).
constexpr Dispersion bk7 = {0.3, 2.5, [](double l2) {
                              return 1 + 1.03961212 * l2 / (l2 - 0.00600069867) +
                                     0.231792344 * l2 / (l2 - 0.0200179144) +
                                     1.01046945 * l2 / (l2 - 103.560653);
                            }};
// Poly(methyl methacrylate) at 20 degrees C, Beadie et al. 2015, Appl. Opt. 54:F139.
constexpr Dispersion acrylic = {
    0.42, 1.62, [](double l2) {
      const double i2 = 1 / l2;
      return 2.1778 + l2 * (6.1209e-3 - 1.5004e-3 * l2) +
             i2 * (2.3678e-2 + i2 * (-4.2137e-3 + i2 * (7.3417e-4 - 4.5042e-5 * i2)));
    }};
// At 20 degrees C, Sultanova, Kasarova, Nikolov 2009, Acta Phys. Pol. A 116:585, as a Sellmeier
// term.
constexpr Dispersion polycarbonate = {0.4368, 1.052,
                                      [](double l2) { return 1 + 1.4182 * l2 / (l2 - 0.021304); }};

struct Published {
  std::string_view name;
  std::span<const Row> rows;
  const Dispersion* dispersion = nullptr;
};
constexpr std::array<Published, 10> published = {{{"acrylic", {}, &acrylic},
                                                  {"aluminium", aluminium},
                                                  {"bk7", {}, &bk7},
                                                  {"chromium", chromium},
                                                  {"copper", copper},
                                                  {"gold", gold},
                                                  {"iron", iron},
                                                  {"polycarbonate", {}, &polycarbonate},
                                                  {"silver", silver},
                                                  {"water", water}}};

}  // namespace

std::optional<RefractiveIndex> refractive_index(std::string_view name, double wavelength_m) {
  const double um = wavelength_m * 1e6;
  for (const Published& entry : published) {
    if (entry.name != name) continue;
    if (!entry.dispersion) return between_rows(entry.rows, um);
    const Dispersion& dispersion = *entry.dispersion;
    if (!(um >= dispersion.least_um && um <= dispersion.most_um)) return std::nullopt;
    return RefractiveIndex{std::sqrt(dispersion.index2(um * um)), 0};
  }
  return std::nullopt;
}

std::vector<std::string_view> refractive_index_names() {
  std::vector<std::string_view> names;
  for (const Published& entry : published) names.push_back(entry.name);
  return names;
}

}  // namespace scan::synth
