// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A picture of each hard case through each method, to be looked at.
//
//   hard_case_sheet OUT.png [TILE_PX]
//
// Rows: the cases that may end in a surface; columns: the methods, in the order printed. Red is as
// far off the truth as the case allows, grey has no data near.
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/reconstruct/reconstruct.h"
#include "tests/hard_cases/reconstruct_cases.h"
#include "tools/report/picture.h"

namespace scan {
namespace {

std::optional<SurfaceResult> answer_of(const HardCase& hard, ReconstructMethod method) {
  try {
    return reconstruct(hard.cloud, scanners_of(hard.cloud),
                       {.method = method, .ssd = {.depth = 6}});
  } catch (const Error& error) {
    std::printf("  no surface by %s: %s\n", std::string(name_of(method)).c_str(), error.what());
    return std::nullopt;
  }
}

// How far off each vertex is; unknown where no data are near.
std::vector<double> deviations(const HardCase& hard, const SurfaceResult& result) {
  std::vector<double> values;
  for (std::size_t v = 0; v < result.support_m.size(); ++v)
    values.push_back(result.support_m[v] > supported_within_spacings * result.data_spacing_m[v]
                         ? std::numeric_limits<double>::quiet_NaN()
                         : hard.distance_m(result.surface.vertices[v]));
  return values;
}

void put(const Image<Colour>& tile, int left, int top, Image<Colour>& sheet) {
  for (int row = 0; row < tile.height; ++row)
    for (int column = 0; column < tile.width; ++column)
      sheet(left + column, top + row) = tile(column, row);
}

int draw(const std::string& png, int tile_px) {
  std::vector<HardCase> cases = hard_cases();
  std::erase_if(cases, [](const HardCase& hard) { return hard.answer == Answer::error; });
  const auto& methods = reconstruct_method_names();
  const auto columns = static_cast<int>(methods.size()) - 1;  // "auto" is one of the others
  for (int column = 0; column < columns; ++column)
    std::printf("column %d: %s\n", column + 1, methods[column + 1].c_str());
  Image<Colour> sheet(columns * tile_px, static_cast<int>(cases.size()) * tile_px, {255, 255, 255});
  for (int row = 0; row < static_cast<int>(cases.size()); ++row) {
    const HardCase& hard = cases[row];
    std::printf("row %d: %s\n", row + 1, hard.name);
    for (int column = 0; column < columns; ++column) {
      const auto result = answer_of(hard, static_cast<ReconstructMethod>(column + 1));
      if (!result) continue;
      const std::vector<double> values = deviations(hard, *result);
      const Portrait portrait(result->surface, values, hard.tolerance_m);
      put(portrait.oblique_view(tile_px, tile_px).image, column * tile_px, row * tile_px, sheet);
    }
  }
  write_png(png, sheet);
  return 0;
}

}  // namespace
}  // namespace scan

int main(int argc, char** argv) {
  if (argc < 2) return std::fputs("usage: hard_case_sheet OUT.png [TILE_PX]\n", stderr), 2;
  return scan::draw(argv[1], argc > 2 ? std::atoi(argv[2]) : 150);
}
