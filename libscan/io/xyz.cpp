// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/xyz.h"

#include <array>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

std::string_view without_comment(std::string_view line) {
  return line.substr(0, std::min(line.find('#'), line.find("//")));
}

std::size_t append_line(std::string_view line, std::vector<double>& numbers,
                        const std::string& place) {
  std::size_t columns = 0;
  while (true) {
    const std::string_view word = take_word(line, ",;");
    if (word.empty()) return columns;
    ++columns;
    const auto number = number_from<double>(word);
    if (!number)
      throw Error(Trouble::input, place + ", column " + std::to_string(columns) + ": '" +
                                      std::string(word.substr(0, 40)) + "' is not a number");
    numbers.push_back(*number);
  }
}

}  // namespace

PointCloud cloud_from_rows(std::span<const double> numbers, std::size_t columns,
                           const std::string& name) {
  if (columns != 3 && columns != 4 && columns != 6 && columns != 7)
    throw Error(Trouble::input,
                name + ": has " + std::to_string(columns) +
                    " numbers a row; 3 (x y z), 4 (and intensity), 6 (and nx ny nz) "
                    "or 7 (normal and intensity) are understood");
  PointCloud cloud;
  for (std::size_t at = 0; at + columns <= numbers.size(); at += columns) {
    const double* row = numbers.data() + at;
    cloud.points.emplace_back(row[0], row[1], row[2]);
    if (columns >= 6) cloud.normals.emplace_back(row[3], row[4], row[5]);
    if (columns == 4 || columns == 7) cloud.intensity.push_back(row[columns - 1]);
  }
  return cloud;
}

PointCloud parse_xyz(std::string_view text, const std::string& name) {
  std::vector<double> numbers;
  std::size_t columns = 0;
  Lines lines(text);
  while (const auto line = lines.next()) {
    const std::string place = name + ": line " + std::to_string(lines.number());
    const std::size_t here = append_line(without_comment(*line), numbers, place);
    if (here == 0) continue;
    if (columns == 0) columns = here;
    if (here != columns)
      throw Error(Trouble::input, place + ": has " + std::to_string(here) +
                                      " numbers, the lines before have " + std::to_string(columns));
  }
  if (columns == 0) throw Error(Trouble::input, name + ": holds no point");
  return cloud_from_rows(numbers, columns, name);
}

PointCloud read_xyz(const std::filesystem::path& path) {
  return parse_xyz(read_file(path), path.string());
}

void write_xyz(const std::filesystem::path& path, const PointCloud& cloud) {
  check(cloud);
  std::string text;
  const auto put = [&](double number, char behind) {
    append_number(text, number);
    text += behind;
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const double x : cloud.points[i]) put(x, ' ');
    if (!cloud.normals.empty())
      for (const double n : cloud.normals[i]) put(n, ' ');
    if (!cloud.intensity.empty()) put(cloud.intensity[i], ' ');
    text.back() = '\n';
  }
  write_file(path, text);
}

}  // namespace scan
