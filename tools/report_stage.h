// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A run folder's report: the page and, beside it, its twins for machines.
#pragma once

#include <filesystem>

namespace scan {

// `page` and the files of its name that end in .json and .csv. What the folder lacks the page names
// as missing. `artefacts` and `tradeoff` as in read_record(). Throws scan::Error (input) for a
// folder without recipe.json and for broken files; nothing is written then.
void write_report(const std::filesystem::path& run, const std::filesystem::path& page,
                  const std::filesystem::path& artefacts = {},
                  const std::filesystem::path& tradeoff = {});

}  // namespace scan
