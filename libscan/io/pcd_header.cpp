// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/pcd_header.h"

#include <optional>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

class HeaderParser {
 public:
  HeaderParser(std::string_view content, const std::string& name)
      : content_(content), name_(name) {}

  PcdHeader parse() {
    while (parse_line(next_line())) {
    }
    if (header_.fields.empty()) fail("there is no FIELDS line");
    lay_out();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Trouble::input,
                name_ + ": PCD header line " + std::to_string(line_number_) + ": " + what);
  }

  std::string_view next_line() {
    ++line_number_;
    const std::size_t end = content_.find('\n', header_.size);
    if (end == std::string_view::npos) fail("the file ends before 'DATA'");
    const std::string_view line = content_.substr(header_.size, end - header_.size);
    header_.size = end + 1;
    return line.substr(0, line.find('#'));
  }

  bool parse_line(std::string_view words) {
    const std::string_view keyword = take_word(words);
    if (keyword == "FIELDS" || keyword == "COLUMNS") {
      for (auto name = take_word(words); !name.empty(); name = take_word(words))
        header_.fields.push_back({std::string(name)});
    } else if (keyword == "SIZE") {
      for (PcdField& field : header_.fields) field.bytes = number(take_word(words), "SIZE");
    } else if (keyword == "TYPE") {
      for (PcdField& field : header_.fields) field.type = letter(take_word(words));
    } else if (keyword == "COUNT") {
      for (PcdField& field : header_.fields) field.count = number(take_word(words), "COUNT");
    } else if (keyword == "WIDTH" || keyword == "HEIGHT") {
      (keyword == "WIDTH" ? width_ : height_) = number(take_word(words), "size");
    } else if (keyword == "POINTS") {
      points_ = number(take_word(words), "POINTS");
    } else if (keyword == "DATA") {
      header_.packing = packing(take_word(words));
      return false;
    } else if (!keyword.empty() && keyword != "VERSION" && keyword != "VIEWPOINT") {
      fail("unknown keyword '" + std::string(keyword.substr(0, 40)) + "'");
    }
    return true;
  }

  std::size_t number(std::string_view word, const char* what) const {
    const auto value = number_from<std::uint32_t>(word);
    if (!value)
      fail(std::string(what) + " '" + std::string(word.substr(0, 40)) + "' is no whole number");
    return *value;
  }

  char letter(std::string_view word) const {
    if (word != "F" && word != "I" && word != "U") fail("TYPE must be F, I or U for each field");
    return word[0];
  }

  PcdPacking packing(std::string_view word) const {
    if (word == "ascii") return PcdPacking::ascii;
    if (word == "binary") return PcdPacking::binary;
    if (word == "binary_compressed") return PcdPacking::compressed;
    fail("DATA must be ascii, binary or binary_compressed");
  }

  void lay_out() {
    for (PcdField& field : header_.fields) {
      const bool is_float = field.type == 'F' && (field.bytes == 4 || field.bytes == 8);
      const bool is_whole = field.type != 'F' && (field.bytes == 1 || field.bytes == 2 ||
                                                  field.bytes == 4 || field.bytes == 8);
      if (!is_float && !is_whole)
        fail("field '" + field.name + "': type " + field.type + " of " +
             std::to_string(field.bytes) + " bytes is unknown");
      field.offset = header_.record_bytes;
      field.column = header_.columns;
      header_.record_bytes += field.bytes * field.count;
      header_.columns += field.count;
    }
    const std::size_t grid = width_.value_or(0) * height_.value_or(1);
    header_.points = points_.value_or(grid);
    if (width_ && header_.points != grid)
      fail("POINTS is " + std::to_string(header_.points) + ", WIDTH x HEIGHT is " +
           std::to_string(grid));
    if (header_.columns == 0) fail("the fields have no entries");
  }

  std::string_view content_;
  const std::string& name_;
  std::size_t line_number_ = 0;
  std::optional<std::size_t> width_, height_, points_;
  PcdHeader header_;
};

}  // namespace

PcdHeader parse_pcd_header(std::string_view content, const std::string& name) {
  return HeaderParser(content, name).parse();
}

}  // namespace scan
