// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Files that commands take, read and made ready.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "libscan/acquire/normals.h"
#include "libscan/align/multiview.h"
#include "libscan/core/scan.h"
#include "libscan/verify/truth.h"
#include "tools/console.h"

namespace scan {

// Splits INPUT... OUT; scan::Error (usage) if there are not at least one input and the output, or
// the output is an input.
std::pair<std::vector<std::string>, std::string> split_output(std::vector<std::string> paths);

// scan::Error (output) if `path` is a folder or its folder does not exist, before long work starts.
void check_output(const std::string& path);

// Reads scans; those without normals get them by plane fits, facing their viewpoint.
std::vector<Scan> read_scans_with_normals(const std::vector<std::string>& paths, Console& console);

// Warns of points that were not finite and are not in the scan.
void warn_of_lost_points(const std::string& path, const Scan& scan, Console& console);

// Triangles without area, and a warning of them; scan::Error (input) if there are no others.
std::size_t flat_triangles(const Mesh& mesh);
void warn_of_flat_triangles(const std::string& path, const Mesh& mesh, Console& console);

// Warns of a measured surface or cloud whose box cannot be that of the truth: another unit (with
// the factor) or another frame (with the gap). Says nothing where the truth has no end.
void warn_of_other_frame(const std::string& path, const Bounds& measured, const Bounds& truth,
                         Console& console);

// Warns of a true surface with holes: nothing is inside it, and what lies behind a hole is measured
// to its rim.
void warn_of_holes(const std::string& path, const TrueSurface& truth, Console& console);

// Warns of scans so much larger or smaller than the others that their unit may be another one.
void warn_of_units(const std::vector<std::string>& paths, const std::vector<Scan>& scans,
                   Console& console);

// Warns of a pose that the data leave partly free or that still moved at the last round. False if
// the scan could not be aligned at all.
bool tell_of_pose(const std::string& scan, const ScanPose& pose, Console& console);

// The scans' points in one cloud, world frame.
PointCloud joined(const std::vector<Scan>& scans, const std::vector<Pose>& world_from_scan);

// Where the scanner of each of these points stood; empty unless every scan knows its rays.
std::vector<Eigen::Vector3d> joined_viewpoints(const std::vector<Scan>& scans,
                                               const std::vector<Pose>& world_from_scan);

}  // namespace scan
