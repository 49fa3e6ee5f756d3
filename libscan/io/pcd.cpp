// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PCD v0.7 by a reader of our own: linking PCL's would load VTK and some sixty more libraries at
// each start of the program, and it trusts the header's counts.
#include "libscan/io/pcd.h"

#include <array>
#include <bit>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/lzf.h"
#include "libscan/io/pcd_header.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

double stored_number(const char* at, const PcdField& field) {
  constexpr auto little = std::endian::little;
  const auto whole = [&]<class Number>(Number) {
    return static_cast<double>(load<Number>(at, little));
  };
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
  BinaryData(std::string_view bytes, const PcdHeader& header, const std::string& name)
      : bytes_(bytes), header_(header) {
    if (header.points > bytes.size() / header.record_bytes)
      throw Error(Trouble::input, name + ": PCD promises " + std::to_string(header.points) +
                                      " points of " + std::to_string(header.record_bytes) +
                                      " bytes, it has " + std::to_string(bytes.size()));
  }
  Column column(const PcdField& field) const {
    const bool by_field = header_.packing == PcdPacking::compressed;
    const char* at = bytes_.data() + field.offset * (by_field ? header_.points : 1);
    const std::size_t step = by_field ? field.bytes * field.count : header_.record_bytes;
    Column values(header_.points);
    for (std::size_t i = 0; i < header_.points; ++i)
      values[i] = stored_number(at + i * step, field);
    return values;
  }

 private:
  std::string_view bytes_;
  const PcdHeader& header_;
};

// A number in text: in the field's own precision, so that ascii and binary give the same.
std::optional<double> text_number(std::string_view word, const PcdField& field) {
  if (field.type != 'F' || field.bytes == 8) return number_from<double>(word);
  if (const auto number = number_from<float>(word)) return *number;
  return std::nullopt;
}

class TextData {
 public:
  TextData(std::string_view text, const PcdHeader& header, const std::string& name)
      : header_(header) {
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
  Column column(const PcdField& field) const {
    Column values(header_.points);
    for (std::size_t i = 0; i < header_.points; ++i)
      values[i] = numbers_[i * header_.columns + field.column];
    return values;
  }

 private:
  void add(std::string_view line, const std::string& name) {
    std::string_view rest = line;
    if (take_word(rest).empty()) return;
    for (const PcdField& field : header_.fields)
      for (std::size_t entry = 0; entry < field.count; ++entry) {
        const std::string_view word = take_word(line);
        const auto number = text_number(word, field);
        if (!number)
          throw Error(Trouble::input, name + ": PCD point " + std::to_string(points_) +
                                          ", field '" + field.name + "': '" +
                                          std::string(word.substr(0, 40)) + "' is not a number");
        numbers_.push_back(*number);
      }
    ++points_;
  }

  const PcdHeader& header_;
  std::size_t points_ = 0;
  std::vector<double> numbers_;
};

const PcdField* find(const PcdHeader& header, std::string_view name) {
  for (const PcdField& field : header.fields)
    if (field.name == name && field.count > 0) return &field;
  return nullptr;
}

template <class Data>
std::vector<Eigen::Vector3d> vectors_of(const Data& data, const PcdHeader& header,
                                        const std::array<const char*, 3>& names) {
  std::vector<Eigen::Vector3d> vectors(header.points);
  for (int axis = 0; axis < 3; ++axis) {
    const PcdField* field = find(header, names[static_cast<std::size_t>(axis)]);
    if (!field) return {};
    const Column column = data.column(*field);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i][axis] = column[i];
  }
  return vectors;
}

template <class Data>
PointCloud cloud_of(const Data& data, const PcdHeader& header, const std::string& name) {
  for (const char* axis : {"x", "y", "z"})
    if (!find(header, axis))
      throw Error(Trouble::input, name + ": PCD has no field '" + axis + "'");
  PointCloud cloud;
  cloud.points = vectors_of(data, header, {"x", "y", "z"});
  cloud.normals = vectors_of(data, header, {"normal_x", "normal_y", "normal_z"});
  if (const PcdField* intensity = find(header, "intensity"))
    cloud.intensity = data.column(*intensity);
  return cloud;
}

// A compressed block: its packed and unpacked size, then LZF data.
std::string unpacked_block(std::string_view data, const std::string& name) {
  if (data.size() < 8) throw Error(Trouble::input, name + ": PCD ends before its compressed block");
  const std::size_t packed = load<std::uint32_t>(data.data(), std::endian::little);
  const std::size_t unpacked = load<std::uint32_t>(data.data() + 4, std::endian::little);
  if (packed > data.size() - 8)
    throw Error(Trouble::input, name + ": PCD ends inside its compressed block");
  const auto bytes = lzf_decompressed(data.substr(8, packed), unpacked);
  if (!bytes) throw Error(Trouble::input, name + ": PCD: the compressed block is damaged");
  return *bytes;
}

}  // namespace

PointCloud read_pcd(const std::filesystem::path& path) {
  const std::string content = read_file(path), name = path.string();
  const PcdHeader header = parse_pcd_header(content, name);
  const std::string_view data = std::string_view(content).substr(header.size);
  if (header.packing == PcdPacking::ascii)
    return cloud_of(TextData(data, header, name), header, name);
  if (header.packing == PcdPacking::binary)
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
                      "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " +
                      count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count +
                      "\nDATA binary\n";
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const double x : cloud.points[i]) store(bytes, x, std::endian::little);
    if (!cloud.normals.empty())
      for (const double n : cloud.normals[i]) store(bytes, n, std::endian::little);
    if (!cloud.intensity.empty()) store(bytes, cloud.intensity[i], std::endian::little);
  }
  write_file(path, bytes);
}

}  // namespace scan
