// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// pairs.json: the pairs of scans that `scan align` has aligned, for --resume.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libscan/align/multiview.h"

namespace scan {

// `inputs`: fingerprint of all that decides the pairs. Numbers read back to the bit.
void write_pairs(const std::filesystem::path& path, const std::string& inputs,
                 const std::vector<ScanEdge>& edges);

// None if the file is not there. scan::Error (input) if it is broken or of other inputs.
std::vector<ScanEdge> read_pairs(const std::filesystem::path& path, const std::string& inputs);

}  // namespace scan
