// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PCD v0.7 by a reader of our own: linking PCL's would load VTK and some sixty more libraries at each
// start of the program, and it trusts the header's counts.
#include "libscan/io/pcd.h"

#include <array>
#include <bit>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/lzf.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

struct Field {
  std::string name;
  char type = 'F';         // F, I or U
  std::size_t bytes = 4;   // 1, 2, 4 or 8
  std::size_t count = 1;   // entries per point
  std::size_t offset = 0;  // in a point's record, bytes
  std::size_t column = 0;  // of the first entry, in a line of text
};

enum class Packing { ascii, binary, compressed };

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0;
  std::size_t record_bytes = 0;
  std::size_t columns = 0;
  Packing packing = Packing::ascii;
  std::size_t size = 0;  // bytes, up to the data
};

class HeaderParser {
 public:
  HeaderParser(std::string_view content, const std::string& name) : content_(content), name_(name) {}

  Header parse() {
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
      for (Field& field : header_.fields) field.bytes = number(take_word(words), "SIZE");
    } else if (keyword == "TYPE") {
      for (Field& field : header_.fields) field.type = letter(take_word(words));
    } else if (keyword == "COUNT") {
      for (Field& field : header_.fields) field.count = number(take_word(words), "COUNT");
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
    if (!value) fail(std::string(what) + " '" + std::string(word.substr(0, 40)) + "' is no whole number");
    return *value;
  }

  char letter(std::string_view word) const {
    if (word != "F" && word != "I" && word != "U") fail("TYPE must be F, I or U for each field");
    return word[0];
  }

  Packing packing(std::string_view word) const {
    if (word == "ascii") return Packing::ascii;
    if (word == "binary") return Packing::binary;
    if (word == "binary_compressed") return Packing::compressed;
    fail("DATA must be ascii, binary or binary_compressed");
  }

  void lay_out() {
    for (Field& field : header_.fields) {
      const bool is_float = field.type == 'F' && (field.bytes == 4 || field.bytes == 8);
      const bool is_whole = field.type != 'F' && (field.bytes == 1 || field.bytes == 2 ||
                                                  field.bytes == 4 || field.bytes == 8);
      if (!is_float && !is_whole)
        fail("field '" + field.name + "': type " + field.type + " of " + std::to_string(field.bytes) +
             " bytes is unknown");
      field.offset = header_.record_bytes;
      field.column = header_.columns;
      header_.record_bytes += field.bytes * field.count;
      header_.columns += field.count;
    }
    const std::size_t grid = width_.value_or(0) * height_.value_or(1);
    header_.points = points_.value_or(grid);
    if (width_ && header_.points != grid)
      fail("POINTS is " + std::to_string(header_.points) + ", WIDTH x HEIGHT is " + std::to_string(grid));
    if (header_.columns == 0) fail("the fields have no entries");
  }

  std::string_view content_;
  const std::string& name_;
  std::size_t line_number_ = 0;
  std::optional<std::size_t> width_, height_, points_;
  Header header_;
};

double stored_number(const char* at, const Field& field) {
  constexpr auto little = std::endian::little;
  const auto whole = [&]<class Number>(Number) { return static_cast<double>(load<Number>(at, little)); };
  if (field.type == 'F') return field.bytes == 4 ? whole(float{}) : whole(double{});
  if (field.type == 'I')
    return field.bytes == 1   ? whole(std::int8_t{})
           : field.bytes == 2 ? whole(std::int16_t{})
           : field.bytes == 4 ? whole(std::int32_t{})
                              : whole(std::int64_t{});
  return field.bytes == 1   ? whole(std::uint8_t{})
         : field.bytes == 2 ? whole(std::uint16_t{})
         : field.bytes == 4 ? whole(std::uint32_t{})
                            : whole(std::uint64_t{});
}

// The entries of one field, one per point.
using Column = std::vector<double>;

// Numbers in place: point by point, or field by field in a compressed block.
class BinaryData {
 public:
  BinaryData(std::string_view bytes, const Header& header, const std::string& name)
      : bytes_(bytes), header_(header) {
    if (header.points > bytes.size() / header.record_bytes)
      throw Error(Trouble::input, name + ": PCD promises " + std::to_string(header.points) +
                                      " points of " + std::to_string(header.record_bytes) +
                                      " bytes, it has " + std::to_string(bytes.size()));
  }
  Column column(const Field& field) const {
    const bool by_field = header_.packing == Packing::compressed;
    const char* at = bytes_.data() + field.offset * (by_field ? header_.points : 1);
    const std::size_t step = by_field ? field.bytes * field.count : header_.record_bytes;
    Column values(header_.points);
    for (std::size_t i = 0; i < header_.points; ++i) values[i] = stored_number(at + i * step, field);
    return values;
  }

 private:
  std::string_view bytes_;
  const Header& header_;
};

// A number in text: in the field's own precision, so that ascii and binary give the same.
std::optional<double> text_number(std::string_view word, const Field& field) {
  if (field.type != 'F' || field.bytes == 8) return number_from<double>(word);
  if (const auto number = number_from<float>(word)) return *number;
  return std::nullopt;
}

class TextData {
 public:
  TextData(std::string_view text, const Header& header, const std::string& name) : header_(header) {
    if (header.points > (text.size() + 1) / (2 * header.columns))
      throw Error(Trouble::input, name + ": PCD promises " + std::to_string(header.points) +
                                      " points, its " + std::to_string(text.size()) +
                                      " bytes cannot hold them");
    Lines lines(text);
    while (const auto line = lines.next()) add(*line, name);
    if (points_ != header.points)
      throw Error(Trouble::input, name + ": PCD promises " + std::to_string(header.points) +
                                      " points, it has " + std::to_string(points_));
  }
  Column column(const Field& field) const {
    Column values(header_.points);
    for (std::size_t i = 0; i < header_.points; ++i)
      values[i] = numbers_[i * header_.columns + field.column];
    return values;
  }

 private:
  void add(std::string_view line, const std::string& name) {
    std::string_view rest = line;
    if (take_word(rest).empty()) return;
    for (const Field& field : header_.fields)
      for (std::size_t entry = 0; entry < field.count; ++entry) {
        const std::string_view word = take_word(line);
        const auto number = text_number(word, field);
        if (!number)
          throw Error(Trouble::input, name + ": PCD point " + std::to_string(points_) + ", field '" +
                                          field.name + "': '" + std::string(word.substr(0, 40)) +
                                          "' is not a number");
        numbers_.push_back(*number);
      }
    ++points_;
  }

  const Header& header_;
  std::size_t points_ = 0;
  std::vector<double> numbers_;
};

const Field* find(const Header& header, std::string_view name) {
  for (const Field& field : header.fields)
    if (field.name == name && field.count > 0) return &field;
  return nullptr;
}

template <class Data>
std::vector<Eigen::Vector3d> vectors_of(const Data& data, const Header& header,
                                        const std::array<const char*, 3>& names) {
  std::vector<Eigen::Vector3d> vectors(header.points);
  for (int axis = 0; axis < 3; ++axis) {
    const Field* field = find(header, names[static_cast<std::size_t>(axis)]);
    if (!field) return {};
    const Column column = data.column(*field);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i][axis] = column[i];
  }
  return vectors;
}

template <class Data>
PointCloud cloud_of(const Data& data, const Header& header, const std::string& name) {
  for (const char* axis : {"x", "y", "z"})
    if (!find(header, axis)) throw Error(Trouble::input, name + ": PCD has no field '" + axis + "'");
  PointCloud cloud;
  cloud.points = vectors_of(data, header, {"x", "y", "z"});
  cloud.normals = vectors_of(data, header, {"normal_x", "normal_y", "normal_z"});
  if (const Field* intensity = find(header, "intensity")) cloud.intensity = data.column(*intensity);
  return cloud;
}

// A compressed block: its packed and unpacked size, then LZF data.
std::string unpacked_block(std::string_view data, const std::string& name) {
  if (data.size() < 8) throw Error(Trouble::input, name + ": PCD ends before its compressed block");
  const std::size_t packed = load<std::uint32_t>(data.data(), std::endian::little);
  const std::size_t unpacked = load<std::uint32_t>(data.data() + 4, std::endian::little);
  if (packed > data.size() - 8) throw Error(Trouble::input, name + ": PCD ends inside its compressed block");
  const auto bytes = lzf_decompressed(data.substr(8, packed), unpacked);
  if (!bytes) throw Error(Trouble::input, name + ": PCD: the compressed block is damaged");
  return *bytes;
}

}  // namespace

PointCloud read_pcd(const std::filesystem::path& path) {
  const std::string content = read_file(path), name = path.string();
  const Header header = HeaderParser(content, name).parse();
  const std::string_view data = std::string_view(content).substr(header.size);
  if (header.packing == Packing::ascii) return cloud_of(TextData(data, header, name), header, name);
  if (header.packing == Packing::binary)
    return cloud_of(BinaryData(data, header, name), header, name);
  const std::string block = unpacked_block(data, name);
  return cloud_of(BinaryData(block, header, name), header, name);
}

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud) {
  check(cloud);
  std::string fields = "x y z", sizes = "8 8 8", types = "F F F", counts = "1 1 1";
  const auto add_field = [&](const char* name) {
    fields.append(" ").append(name);
    sizes += " 8", types += " F", counts += " 1";
  };
  if (!cloud.normals.empty())
    for (const char* name : {"normal_x", "normal_y", "normal_z"}) add_field(name);
  if (!cloud.intensity.empty()) add_field("intensity");
  const std::string count = std::to_string(cloud.size());
  std::string bytes = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields +
                      "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + count +
                      "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const double x : cloud.points[i]) store(bytes, x, std::endian::little);
    if (!cloud.normals.empty())
      for (const double n : cloud.normals[i]) store(bytes, n, std::endian::little);
    if (!cloud.intensity.empty()) store(bytes, cloud.intensity[i], std::endian::little);
  }
  write_file(path, bytes);
}

}  // namespace scan
