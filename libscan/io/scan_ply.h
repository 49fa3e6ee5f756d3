// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A whole scan as PLY.
//
// Beside what ply.h knows of clouds: vertex property `ray`, and comments
//   libscan grid ROWS COLUMNS
//   libscan noise_window ROWS COLUMNS (of rays that share noise, see Scan)
//   libscan miss COUNT REASON
//   libscan viewpoint X Y Z
//   libscan world_from_scanner_guess (16 numbers, row by row)
//   libscan guess_sigma RAD M (how far off it is, see GuessSigma)
#pragma once

#include <filesystem>

#include "libscan/core/scan.h"
#include "libscan/io/ply.h"

namespace scan {

Ply ply_from(const Scan& scan);

// Reads a `range_grid` element too (Stanford): lists of no or one vertex, row by row; rows and
// columns from the obj_info lines num_rows and num_cols. Its empty cells count as misses["not
// recorded"]. A vertex that the grid does not name leaves `ray` empty. The viewpoint becomes
// (0, 0, 100) m: those scanners look along -z of the scan's frame, from a place that the file does
// not tell; seen from 100 m on, all rays over an object of 0.1 m are parallel to 1 mrad.
Scan scan_from(const Ply& ply, const std::filesystem::path& path);

}  // namespace scan
