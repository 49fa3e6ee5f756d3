// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A whole scan as PLY.
//
// Beside what ply.h knows of clouds: vertex property `ray`, and comments
//   libscan grid ROWS COLUMNS
//   libscan miss COUNT REASON
//   libscan world_from_scanner_guess (16 numbers, row by row)
#pragma once

#include <filesystem>

#include "libscan/core/scan.h"
#include "libscan/io/ply.h"

namespace scan {

Ply ply_from(const Scan& scan);

// Reads a `range_grid` element too (Stanford): lists of no or one vertex, row by row; rows and
// columns from the obj_info lines num_rows and num_cols. Its empty cells count as misses["not
// recorded"]. A vertex that the grid does not name leaves `ray` empty.
Scan scan_from(const Ply& ply, const std::filesystem::path& path);

}  // namespace scan
