// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Photographs of a red laser line on a wall and on a box: on a flat face it must come out straight.
//
// The red channel is clipped in most rows, grey (0.3 red) only in some on the wall: the line needs
// no channel of its own. On the box all three channels are clipped.
#include <cmath>

#include "libscan/io/image_file.h"
#include "libscan/io/scan_file.h"
#include "tests/real_data/real_data.h"

namespace scan::test {
namespace {

const fs::path folder = data_folder("laser-stripe-photos");

constexpr double focal_px = 1000, centre_px = -1000;

// A camera and a light plane x = 1 m from which each point tells its column: centre + focal x / z.
nlohmann::json calibration(double full_well) {
  return {{"device", "laser-line"},
          {"camera",
           {{"width_px", 480},
            {"height_px", 360},
            {"fx_px", focal_px},
            {"fy_px", focal_px},
            {"cx_px", centre_px},
            {"cy_px", 180}}},
          {"sensor",
           {{"gain_e_per_dn", 1}, {"read_noise_e", 2}, {"full_well_e", full_well}, {"bits", 8}}},
          {"light_plane", {{"normal", {1, 0, 0}}, {"offset_m", 1}}},
          {"scanner_from_camera", {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}}};
}

struct Peak {
  double row_px = 0;
  double column_px = 0;
};

std::vector<Peak> peaks_in(const std::string& photo, double full_well) {
  const Folder out;
  const Image<std::uint8_t> grey = read_grey8(folder / photo);
  write_png(out / "grey.png", grey);
  spill(out / "calibration.json", calibration(full_well).dump());
  const Answer acquired =
      ask_scan({"acquire", "laser-line", (out / "grey.png").string(), (out / "points.ply").string(),
                "--calibration", (out / "calibration.json").string()});
  EXPECT_EQ(acquired.exit_code, 0) << acquired.err;
  const Scan scan = read_scan(out / "points.ply");
  std::vector<Peak> peaks;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const Eigen::Vector3d& x = scan.cloud.points[i];
    peaks.push_back({double(scan.ray[i]), centre_px + focal_px * x.x() / x.z()});
  }
  return peaks;
}

std::vector<Peak> between_rows(const std::vector<Peak>& peaks, double first, double last) {
  std::vector<Peak> kept;
  for (const Peak& peak : peaks)
    if (peak.row_px >= first && peak.row_px <= last) kept.push_back(peak);
  return kept;
}

// Root mean square distance in columns from the line of least squares.
double rms_from_line_px(const std::vector<Peak>& peaks) {
  const double n = double(peaks.size());
  double row = 0, column = 0, rows2 = 0, product = 0, sum2 = 0;
  for (const Peak& peak : peaks) row += peak.row_px / n, column += peak.column_px / n;
  for (const Peak& peak : peaks) {
    rows2 += (peak.row_px - row) * (peak.row_px - row);
    product += (peak.row_px - row) * (peak.column_px - column);
  }
  for (const Peak& peak : peaks)
    sum2 += std::pow(peak.column_px - column - product / rows2 * (peak.row_px - row), 2);
  return std::sqrt(sum2 / n);
}

struct Photo {
  std::string name;
  double wall_end_row;  // the line on the wall runs from row 5 to here
  double box_first_row, box_last_row;
};
const Photo photos[] = {{"cube.jpg", 136, 175, 292}, {"train2.jpg", 152, 180, 288}};

// Speckle moves the stripe (sigma 1.7 px) at random from row to row. Whole pixels would add
// 1 / sqrt(12) = 0.29 px by rounding alone: the rows must scatter by less. Rows in which the line
// is clipped are refused; most are not.
TEST(LaserPhoto, LineOnTheWallIsStraight) {
  SKIP_WITHOUT(folder);
  for (const Photo& photo : photos) {
    const auto wall = between_rows(peaks_in(photo.name, 255), 5, photo.wall_end_row);
    const double rms_px = rms_from_line_px(wall);
    std::cout << "  " << photo.name << ": " << wall.size() << " of " << photo.wall_end_row - 4
              << " rows, rms " << rms_px << " px\n";
    EXPECT_GE(double(wall.size()), 0.6 * (photo.wall_end_row - 4)) << photo.name;
    EXPECT_LE(rms_px, 0.29) << photo.name;
  }
}

// JPEG spreads clipped values over 243 to 255: a calibration that says so. A clipped stripe has no
// centre to a fraction of a pixel, so there must be no point.
TEST(LaserPhoto, OverexposedLineOnTheBoxIsRefused) {
  SKIP_WITHOUT(folder);
  for (const Photo& photo : photos)
    EXPECT_TRUE(
        between_rows(peaks_in(photo.name, 240), photo.box_first_row, photo.box_last_row).empty())
        << photo.name;
}

}  // namespace
}  // namespace scan::test
