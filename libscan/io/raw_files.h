// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Raw frames and calibrations on disk.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "libscan/core/raw_frames.h"

namespace scan {

// The device kinds by the command line's words: "laser-line", "stereo", "phase", "waveform".
std::string_view kind_of(const RawFrames& frames);

// Writes calibration.json, images as 16-bit PNG (stereo: left.png, right.png), waveforms as npy, all
// into an existing folder.
void write_raw_frames(const std::filesystem::path& folder, const RawFrames& frames);

// Reads what write_raw_frames wrote, or a real device's files: `inputs` in order (laser-line: one image
// per step; stereo: left, right; phase: four taps per frequency; waveform: samples.npy and
// directions.npy), or one folder that holds them under the names that write_raw_frames uses.
// `calibration` is JSON with `"device": kind` (unit-carrying keys as in a recipe; `scan acquire --help`
// lists them), or Middlebury's calib.txt for stereo. scan::Error (input) names file and field.
RawFrames read_raw_frames(std::string_view kind, const std::vector<std::filesystem::path>& inputs,
                          const std::filesystem::path& calibration);

}  // namespace scan
