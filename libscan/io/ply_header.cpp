// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/ply_header.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

constexpr std::array<std::string_view, ply_type_count> names = {"char", "uchar", "short", "ushort",
                                                                "int",  "uint",  "float", "double"};
constexpr std::array<std::string_view, ply_type_count> sized_names = {
    "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
constexpr std::array<std::size_t, ply_type_count> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::size_t first_float_type = 6;

std::optional<std::size_t> type_from(std::string_view word) {
  for (std::size_t type = 0; type < ply_type_count; ++type)
    if (word == names[type] || word == sized_names[type]) return type;
  return std::nullopt;
}

template <std::size_t... I>
PlyProperty::Values empty_values(std::size_t type, std::index_sequence<I...>) {
  PlyProperty::Values values;
  ((type == I ? void(values.emplace<I>()) : void()), ...);
  return values;
}

// One pass over the header's lines; keeps what has been understood so far.
class HeaderParser {
 public:
  HeaderParser(std::string_view content, const std::string& name) : rest_(content), name_(name) {}

  PlyHeader parse() {
    find_line_end();
    if (next_line() != "ply") fail("must be 'ply'");
    parse_format(next_line());
    while (parse_line(next_line())) {
    }
    header_.size = consumed_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Trouble::input,
                name_ + ": PLY header line " + std::to_string(line_number_) + ": " + what);
  }

  // The first line fixes how lines end, so that a binary row that begins with 10 stays whole.
  void find_line_end() {
    const std::size_t first = rest_.find_first_of("\r\n");
    if (rest_.substr(0, 3) != "ply" || first == std::string_view::npos)
      throw Error(Trouble::input, name_ + ": is not a PLY file (its first line is not 'ply')");
    line_end_ = rest_[first] == '\n' ? "\n" : rest_.substr(first, 2) == "\r\n" ? "\r\n" : "\r";
  }

  std::string_view next_line() {
    ++line_number_;
    const std::size_t end = rest_.find(line_end_);
    if (end == std::string_view::npos) fail("the file ends before 'end_header'");
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + line_end_.size());
    consumed_ += end + line_end_.size();
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r'))
      line.remove_suffix(1);
    return line;
  }

  void parse_format(std::string_view line) {
    const std::string_view keyword = take_word(line), encoding = take_word(line);
    if (keyword != "format") fail("must be 'format ...', is '" + std::string(keyword) + "'");
    if (encoding == "ascii")
      header_.encoding = PlyEncoding::ascii;
    else if (encoding == "binary_little_endian")
      header_.encoding = PlyEncoding::binary_little_endian;
    else if (encoding == "binary_big_endian")
      header_.encoding = PlyEncoding::binary_big_endian;
    else
      fail("unknown format '" + std::string(encoding) +
           "' (ascii, binary_little_endian or binary_big_endian)");
    if (take_word(line) != "1.0") fail("version must be 1.0");
  }

  bool parse_line(std::string_view line) {
    std::string_view words = line;
    const std::string_view keyword = take_word(words);
    if (keyword == "end_header") return false;
    const std::string text(words.substr(std::min<std::size_t>(1, words.size())));
    if (keyword == "comment")
      header_.empty.comments.push_back(text);
    else if (keyword == "obj_info")
      header_.empty.obj_info.push_back(text);
    else if (keyword == "element")
      parse_element(words);
    else if (keyword == "property")
      parse_property(words);
    else if (!keyword.empty())
      fail("unknown keyword '" + std::string(keyword) + "'");
    return true;
  }

  void parse_element(std::string_view words) {
    PlyElement element;
    element.name = take_word(words);
    const std::string_view count = take_word(words);
    const auto number = number_from<std::size_t>(count);
    if (element.name.empty() || !number)
      fail("element '" + element.name + "': count is '" + std::string(count) +
           "', must be a whole number from 0");
    if (header_.empty.find(element.name)) fail("element '" + element.name + "' is there twice");
    element.count = *number;
    header_.empty.elements.push_back(std::move(element));
    header_.length_types.emplace_back();
  }

  std::size_t parse_type(std::string_view word) const {
    const auto type = type_from(word);
    if (!type) fail("unknown type '" + std::string(word) + "'");
    return *type;
  }

  void parse_property(std::string_view words) {
    if (header_.empty.elements.empty()) fail("property before any element");
    PlyElement& element = header_.empty.elements.back();
    PlyProperty property;
    std::size_t length_type = 0;
    std::string_view type = take_word(words);
    if (type == "list") {
      property.is_list = true;
      length_type = parse_type(take_word(words));
      if (length_type >= first_float_type)
        fail("the length of a list must be of a whole-number type");
      type = take_word(words);
    }
    property.values = empty_values(parse_type(type), std::make_index_sequence<ply_type_count>());
    property.name = take_word(words);
    if (property.name.empty()) fail("property of element '" + element.name + "' has no name");
    if (element.find(property.name))
      fail("element '" + element.name + "' has property '" + property.name + "' twice");
    element.properties.push_back(std::move(property));
    header_.length_types.back().push_back(length_type);
  }

  std::string_view rest_;
  const std::string& name_;
  std::string_view line_end_;
  std::size_t line_number_ = 0;
  std::size_t consumed_ = 0;
  PlyHeader header_;
};

bool is_one_word(const std::string& name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return c > ' ' && c != 127; });
}

void check_names(const Ply& ply) {
  for (const auto* lines : {&ply.comments, &ply.obj_info})
    for (const std::string& line : *lines)
      if (line.find_first_of("\r\n") != std::string::npos)
        throw Error(Trouble::input, "ply: a comment holds a line break");
  for (const PlyElement& element : ply.elements) {
    if (!is_one_word(element.name))
      throw Error(Trouble::input, "ply: element name '" + element.name + "' is not one word");
    for (const PlyProperty& property : element.properties)
      if (!is_one_word(property.name))
        throw Error(Trouble::input, "ply: element '" + element.name + "': property name '" +
                                        property.name + "' is not one word");
  }
}

}  // namespace

std::size_t ply_type_size(std::size_t type) {
  return sizes[type];
}

PlyHeader parse_ply_header(std::string_view content, const std::string& name) {
  return HeaderParser(content, name).parse();
}

std::string ply_header_text(const Ply& ply, PlyEncoding encoding,
                            const std::vector<std::vector<std::size_t>>& length_types) {
  check_names(ply);
  std::string text = "ply\nformat ";
  text += encoding == PlyEncoding::ascii                  ? "ascii"
          : encoding == PlyEncoding::binary_little_endian ? "binary_little_endian"
                                                          : "binary_big_endian";
  text += " 1.0\n";
  for (const std::string& line : ply.comments) text += "comment " + line + "\n";
  for (const std::string& line : ply.obj_info) text += "obj_info " + line + "\n";
  for (std::size_t e = 0; e < ply.elements.size(); ++e) {
    const PlyElement& element = ply.elements[e];
    text += "element " + element.name + " " + std::to_string(element.count) + "\n";
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      text += "property ";
      if (property.is_list) text.append("list ").append(names[length_types[e][p]]).append(" ");
      text.append(names[property.values.index()]).append(" ").append(property.name).append("\n");
    }
  }
  return text + "end_header\n";
}

}  // namespace scan
