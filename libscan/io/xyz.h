// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Clouds as plain text: x y z [nx ny nz] [intensity] on each line.
#pragma once

#include <filesystem>
#include <string_view>

#include "libscan/core/point_cloud.h"

namespace scan {

// Blanks, tabs, commas or semicolons between the numbers; # and // begin a comment. Every line has
// as many numbers as the first one: 3, 4, 6 or 7. scan::Error (input) names line, column and word.
PointCloud read_xyz(const std::filesystem::path& path);
PointCloud parse_xyz(std::string_view text, const std::string& name);

// Shortest digits that read back the same; sigma and covariances are left out.
void write_xyz(const std::filesystem::path& path, const PointCloud& cloud);

// A cloud from rows of 3, 4, 6 or 7 numbers as above; `numbers` has rows * columns of them.
// scan::Error (input) for other widths, naming `name`.
PointCloud cloud_from_rows(std::span<const double> numbers, std::size_t columns,
                           const std::string& name);

}  // namespace scan
