// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <numeric>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/ply.h"
#include "libscan/io/ply_header.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

std::size_t entries_of(const PlyProperty& property) {
  return std::visit([](const auto& values) { return values.size(); }, property.values);
}

void check_lengths(const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    const std::size_t rows = property.is_list ? property.lengths.size() : entries_of(property);
    const std::string place =
        "ply: element '" + element.name + "', property '" + property.name + "'";
    if (rows != element.count)
      throw Error(Trouble::input, place + ": " + std::to_string(rows) + " rows, the element has " +
                                      std::to_string(element.count));
    const auto total =
        std::accumulate(property.lengths.begin(), property.lengths.end(), std::size_t{0});
    if (property.is_list && total != entries_of(property))
      throw Error(Trouble::input, place + ": its lengths add up to " + std::to_string(total) +
                                      ", it has " + std::to_string(entries_of(property)) +
                                      " values");
  }
}

// uchar where every list is short enough, as other programs expect for faces; uint otherwise.
std::size_t length_type_of(const PlyProperty& property) {
  const auto longest = std::max_element(property.lengths.begin(), property.lengths.end());
  return longest == property.lengths.end() || *longest <= 255 ? 1 : 5;
}

// Writes numbers one behind the other, as bytes or as words of a line.
struct Sink {
  std::string& bytes;
  PlyEncoding encoding;

  template <class Number>
  void put(Number number) {
    if (encoding == PlyEncoding::ascii) {
      if (!bytes.empty() && bytes.back() != '\n') bytes += ' ';
      if constexpr (sizeof(Number) == 1)
        append_number(bytes, static_cast<int>(number));
      else
        append_number(bytes, number);
    } else {
      store(bytes, number,
            encoding == PlyEncoding::binary_little_endian ? std::endian::little : std::endian::big);
    }
  }

  void end_row() {
    if (encoding == PlyEncoding::ascii) bytes += '\n';
  }
};

void put_length(Sink& sink, std::uint32_t length, std::size_t length_type) {
  if (length_type == 1)
    sink.put(static_cast<std::uint8_t>(length));
  else
    sink.put(length);
}

void put_rows(Sink& sink, const PlyElement& element, const std::vector<std::size_t>& length_types) {
  std::vector<std::size_t> next(element.properties.size(), 0);
  for (std::size_t row = 0; row < element.count; ++row) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const std::size_t entries = property.is_list ? property.lengths[row] : 1;
      if (property.is_list) put_length(sink, property.lengths[row], length_types[p]);
      std::visit(
          [&](const auto& values) {
            for (std::size_t i = 0; i < entries; ++i) sink.put(values[next[p] + i]);
          },
          property.values);
      next[p] += entries;
    }
    sink.end_row();
  }
}

}  // namespace

std::string ply_bytes(const Ply& ply, PlyEncoding encoding) {
  std::vector<std::vector<std::size_t>> length_types;
  for (const PlyElement& element : ply.elements) {
    check_lengths(element);
    auto& types = length_types.emplace_back();
    for (const PlyProperty& property : element.properties)
      types.push_back(length_type_of(property));
  }
  std::string bytes = ply_header_text(ply, encoding, length_types);
  Sink sink{bytes, encoding};
  for (std::size_t e = 0; e < ply.elements.size(); ++e)
    put_rows(sink, ply.elements[e], length_types[e]);
  return bytes;
}

void write_ply(const std::filesystem::path& path, const Ply& ply, PlyEncoding encoding) {
  write_file(path, ply_bytes(ply, encoding));
}

}  // namespace scan
