// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The rows of a PLY file, from text or bytes.
#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/ply.h"
#include "libscan/io/ply_header.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

// Where the reader stands, for messages.
struct Place {
  const std::string& file;
  const PlyElement* element = nullptr;
  const PlyProperty* property = nullptr;
  std::size_t row = 0;

  [[noreturn]] void fail(const std::string& what) const {
    std::string text = file;
    if (element) text += ": element '" + element->name + "'";
    if (property) text += ", property '" + property->name + "'";
    if (element) text += ", row " + std::to_string(row);
    throw Error(Trouble::input, text + ": " + what);
  }
};

// Fewest bytes that a row can take: a number and its separator in text, the type's size in binary.
std::size_t least_row_bytes(const PlyHeader& header, std::size_t e) {
  const PlyElement& element = header.empty.elements[e];
  if (header.encoding == PlyEncoding::ascii) return 2 * element.properties.size();
  std::size_t bytes = 0;
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    bytes += ply_type_size(property.is_list ? header.length_types[e][p] : property.values.index());
  }
  return bytes;
}

// Refuses a header that promises more rows than the bytes behind it can hold.
void check_counts(const PlyHeader& header, std::size_t data_bytes, const std::string& name) {
  std::size_t left = data_bytes + 1;  // the last line of a text may lack its end
  for (std::size_t e = 0; e < header.empty.elements.size(); ++e) {
    const PlyElement& element = header.empty.elements[e];
    const std::size_t least = least_row_bytes(header, e);
    if (element.count == 0) continue;
    if (least == 0)
      throw Error(Trouble::input, name + ": element '" + element.name + "' has " +
                                      std::to_string(element.count) + " rows but no property");
    if (element.count > left / least)
      throw Error(Trouble::input, name + ": element '" + element.name + "': the header promises " +
                                      std::to_string(element.count) + " rows of at least " +
                                      std::to_string(least) + " bytes, the file has " +
                                      std::to_string(data_bytes) + " bytes of data");
    left -= element.count * least;
  }
}

void reserve_scalars(PlyElement& element) {
  for (PlyProperty& property : element.properties) {
    if (property.is_list)
      property.lengths.reserve(element.count);
    else
      std::visit([&](auto& values) { values.reserve(element.count); }, property.values);
  }
}

// Rows as bytes.
class BinaryRows {
 public:
  BinaryRows(std::string_view data, std::endian order) : data_(data), order_(order) {}

  void begin_row(Place&) {}
  void end_row(Place&) {}

  template <class Number>
  Number number(const Place& place) {
    if (data_.size() - at_ < sizeof(Number)) place.fail("the file ends here");
    const Number number = load<Number>(data_.data() + at_, order_);
    at_ += sizeof(Number);
    return number;
  }

  // Refuses a list that is longer than the rest of the file before anything is allocated for it.
  void expect_list(const Place& place, std::size_t length, std::size_t entry_bytes) const {
    if (length > (data_.size() - at_) / entry_bytes)
      place.fail("a list of " + std::to_string(length) + " entries, the file ends before");
  }

  std::string_view rest() const { return data_.substr(at_); }

 private:
  std::string_view data_;
  std::size_t at_ = 0;
  std::endian order_;
};

// Rows as lines of text; empty lines do not count.
class TextRows {
 public:
  explicit TextRows(std::string_view data) : data_(data), lines_(data) {}

  void begin_row(Place& place) {
    do {
      const auto line = lines_.next();
      if (!line) place.fail("the file ends here");
      line_ = *line;
    } while (is_blank(line_));
  }

  void end_row(Place& place) {
    place.property = nullptr;
    if (!is_blank(line_))
      place.fail("more values than properties: '" + shown(take_word(line_)) + "'");
  }

  template <class Number>
  Number number(const Place& place) {
    const std::string_view word = take_word(line_);
    if (word.empty()) place.fail("the line ends before this value");
    if constexpr (sizeof(Number) == 1) {  // from_chars takes a char type for an integer
      const auto wide = number_from<int>(word);
      if (wide && std::in_range<Number>(*wide)) return static_cast<Number>(*wide);
    } else if (const auto number = number_from<Number>(word)) {
      return *number;
    }
    place.fail("'" + shown(word) + "' is no value of its type");
  }

  void expect_list(const Place& place, std::size_t length, std::size_t) const {
    if (length > line_.size() / 2 + 1)
      place.fail("a list of " + std::to_string(length) + " entries, the line ends before");
  }

  std::string_view rest() {
    std::string_view last = line_;
    while (is_blank(last)) {
      const auto line = lines_.next();
      if (!line) return {};
      last = *line;
    }
    return last;
  }

 private:
  static bool is_blank(std::string_view line) { return take_word(line).empty(); }
  static std::string shown(std::string_view word) { return std::string(word.substr(0, 40)); }

  std::string_view data_;
  Lines lines_;
  std::string_view line_;
};

template <class Rows>
std::uint32_t list_length(Rows& rows, const Place& place, std::size_t length_type) {
  const auto whole = [&]<class Number>(Number) -> std::uint32_t {
    const Number length = rows.template number<Number>(place);
    if (!std::in_range<std::uint32_t>(length))
      place.fail("the length of a list is " + std::to_string(length));
    return static_cast<std::uint32_t>(length);
  };
  switch (length_type) {
    case 0:
      return whole(std::int8_t{});
    case 1:
      return whole(std::uint8_t{});
    case 2:
      return whole(std::int16_t{});
    case 3:
      return whole(std::uint16_t{});
    case 4:
      return whole(std::int32_t{});
    default:
      return whole(std::uint32_t{});
  }
}

template <class Rows>
void read_value(Rows& rows, const Place& place, PlyProperty& property, std::size_t length_type) {
  std::visit(
      [&]<class Number>(std::vector<Number>& values) {
        std::uint32_t entries = 1;
        if (property.is_list) {
          entries = list_length(rows, place, length_type);
          rows.expect_list(place, entries, sizeof(Number));
          property.lengths.push_back(entries);
        }
        for (std::uint32_t i = 0; i < entries; ++i)
          values.push_back(rows.template number<Number>(place));
      },
      property.values);
}

template <class Rows>
void read_rows(Rows& rows, PlyHeader& header, const std::string& name) {
  for (std::size_t e = 0; e < header.empty.elements.size(); ++e) {
    PlyElement& element = header.empty.elements[e];
    reserve_scalars(element);
    Place place{name, &element};
    for (place.row = 0; place.row < element.count; ++place.row) {
      place.property = nullptr;
      rows.begin_row(place);
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        place.property = &element.properties[p];
        read_value(rows, place, element.properties[p], header.length_types[e][p]);
      }
      rows.end_row(place);
    }
  }
  const std::string_view rest = rows.rest();
  const bool is_padding = std::all_of(rest.begin(), rest.end(), [](char c) {
    return c == '\n' || c == '\r' || c == ' ' || c == '\t' || c == '\0';
  });
  if (!is_padding)
    throw Error(Trouble::input, name + ": data behind the last row that the header promises");
}

}  // namespace

Ply parse_ply(std::string_view content, const std::string& name) {
  PlyHeader header = parse_ply_header(content, name);
  const std::string_view data = content.substr(header.size);
  check_counts(header, data.size(), name);
  if (header.encoding == PlyEncoding::ascii) {
    TextRows rows(data);
    read_rows(rows, header, name);
  } else {
    BinaryRows rows(data, header.encoding == PlyEncoding::binary_little_endian ? std::endian::little
                                                                               : std::endian::big);
    read_rows(rows, header, name);
  }
  return std::move(header.empty);
}

Ply read_ply(const std::filesystem::path& path) {
  return parse_ply(read_file(path), path.string());
}

}  // namespace scan
