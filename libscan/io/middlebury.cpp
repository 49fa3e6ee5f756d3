// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/middlebury.h"

#include <array>
#include <cmath>
#include <map>

#include "libscan/core/error.h"
#include "libscan/core/units.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

class Entries {
 public:
  explicit Entries(const std::filesystem::path& path)
      : name_(path.string()), text_(read_file(path)) {
    Lines lines(text_);
    while (const auto line = lines.next()) {
      const std::size_t equals = line->find('=');
      if (equals == std::string_view::npos) continue;
      std::string_view key = line->substr(0, equals);
      entries_[std::string(take_word(key))] = line->substr(equals + 1);
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw Error(Trouble::input, name_ + ": " + key + ": " + what);
  }

  double number(const std::string& key) const {
    std::string_view words = text_of(key);
    const std::string_view word = take_word(words);
    const auto number = number_from<double>(word);
    if (!number || !std::isfinite(*number))
      fail(key, "'" + std::string(word) + "' is not a number");
    return *number;
  }

  int positive_whole(const std::string& key) const {
    const double value = number(key);
    if (!(value >= 1 && value <= 1 << 20) || value != std::floor(value))
      fail(key, shortest(value) + " is no whole number from 1 to 2^20");
    return static_cast<int>(value);
  }

  std::array<double, 9> matrix(const std::string& key) const {
    std::string_view words = text_of(key);
    std::array<double, 9> entries;
    for (double& entry : entries) {
      const auto number = number_from<double>(take_word(words, "[];,"));
      if (!number || !std::isfinite(*number))
        fail(key, "must be a 3x3 matrix [f 0 cx; 0 f cy; 0 0 1]");
      entry = *number;
    }
    return entries;
  }

 private:
  std::string_view text_of(const std::string& key) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) fail(key, "is missing");
    return found->second;
  }

  std::string name_, text_;
  std::map<std::string, std::string_view> entries_;
};

}  // namespace

StereoCalibration read_middlebury_calibration(const std::filesystem::path& path) {
  const Entries entries(path);
  const auto left = entries.matrix("cam0"), right = entries.matrix("cam1");
  if (!(left[0] > 0))
    entries.fail("cam0", "focal length " + shortest(left[0]) + ", must be positive");
  if (left[0] != right[0] || left[0] != left[4])
    entries.fail("cam1", "a rectified pair has one focal length");
  StereoCalibration calibration;
  calibration.width_px = entries.positive_whole("width");
  calibration.height_px = entries.positive_whole("height");
  calibration.focal_px = left[0];
  calibration.cx_px = left[2];
  calibration.cy_px = left[5];
  calibration.doffs_px = entries.number("doffs");
  calibration.baseline_m = m_from_mm(entries.number("baseline"));
  if (!(calibration.baseline_m > 0)) entries.fail("baseline", "must be positive");
  calibration.disparities_px = entries.positive_whole("ndisp");
  return calibration;
}

}  // namespace scan
