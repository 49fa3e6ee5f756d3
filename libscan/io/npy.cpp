// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// NumPy's array files (NEP 1, format versions 1 to 3).
#include <bit>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/image_codecs.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

// IEEE 754 binary16: 1 sign, 5 exponent, 10 fraction bits.
double from_half(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double size = exponent == 0    ? std::ldexp(fraction, -24)
                      : exponent == 31 ? (fraction ? std::nan("") : HUGE_VAL)
                                       : std::ldexp(1024 + fraction, exponent - 25);
  return bits & 0x8000 ? -size : size;
}

// What stands behind 'key': in the header's dictionary.
std::string_view entry(std::string_view header, std::string_view key, const std::string& name) {
  const std::size_t at = header.find("'" + std::string(key) + "'");
  const std::size_t colon = header.find(':', at);
  if (at == std::string_view::npos || colon == std::string_view::npos)
    throw Error(Trouble::input, name + ": npy header has no '" + std::string(key) + "'");
  header.remove_prefix(colon + 1);
  header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
  return header;
}

std::vector<std::size_t> parse_shape(std::string_view text, const std::string& name) {
  const std::size_t end = text.find(')');
  if (text.empty() || text[0] != '(' || end == std::string_view::npos)
    throw Error(Trouble::input, name + ": npy header: 'shape' is no tuple");
  text = text.substr(1, end - 1);
  std::vector<std::size_t> shape;
  for (auto word = take_word(text, ","); !word.empty(); word = take_word(text, ",")) {
    const auto extent = number_from<std::size_t>(word);
    if (!extent)
      throw Error(Trouble::input, name + ": npy header: 'shape' holds '" + std::string(word) + "'");
    shape.push_back(*extent);
  }
  return shape;
}

// Entries of the shape, refused if they do not make up exactly the bytes that are there.
std::size_t checked_count(const std::vector<std::size_t>& shape, std::size_t entry_bytes,
                          std::size_t data_bytes, const std::string& name) {
  std::size_t count = 1;
  bool fits = true;
  for (const std::size_t extent : shape) {
    if (extent != 0 && count > data_bytes / extent) fits = false;
    count = fits ? count * extent : count;
  }
  if (!fits || count * entry_bytes != data_bytes)
    throw Error(Trouble::input, name + ": npy array has " + std::to_string(data_bytes) +
                                    " bytes of data, its shape needs another number");
  return count;
}

template <class Stored, class Convert>
std::vector<double> convert_all(std::string_view data, std::size_t count, std::endian order,
                                Convert convert) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] = convert(load<Stored>(data.data() + i * sizeof(Stored), order));
  return values;
}

struct Type {
  std::endian order = std::endian::little;
  std::string code;  // kind and bytes: "f4", "u2"
  std::size_t bytes = 0;
};

Type parse_type(std::string_view text, const std::string& name) {
  const std::string word(text.substr(0, text.find_first_of(",}")));
  const std::string known = " f2 f4 f8 i1 i2 i4 i8 u1 u2 u4 u8 b1 ";
  const bool is_quoted = word.size() == 5 && word[0] == '\'' && word[4] == '\'';
  if (!is_quoted || known.find(" " + word.substr(2, 2) + " ") == std::string::npos)
    throw Error(Trouble::input,
                name + ": npy type " + word.substr(0, 40) + " is not one of" + known);
  return {word[1] == '>' ? std::endian::big : std::endian::little, word.substr(2, 2),
          static_cast<std::size_t>(word[3] - '0')};
}

std::vector<double> parse_values(std::string_view data, std::size_t count, const Type& type) {
  const auto plain = [](auto value) { return static_cast<double>(value); };
  const std::string& code = type.code;
  if (code == "f2") return convert_all<std::uint16_t>(data, count, type.order, from_half);
  if (code == "f4") return convert_all<float>(data, count, type.order, plain);
  if (code == "f8") return convert_all<double>(data, count, type.order, plain);
  if (code == "i1") return convert_all<std::int8_t>(data, count, type.order, plain);
  if (code == "i2") return convert_all<std::int16_t>(data, count, type.order, plain);
  if (code == "i4") return convert_all<std::int32_t>(data, count, type.order, plain);
  if (code == "i8") return convert_all<std::int64_t>(data, count, type.order, plain);
  if (code == "u2") return convert_all<std::uint16_t>(data, count, type.order, plain);
  if (code == "u4") return convert_all<std::uint32_t>(data, count, type.order, plain);
  if (code == "u8") return convert_all<std::uint64_t>(data, count, type.order, plain);
  return convert_all<std::uint8_t>(data, count, type.order, plain);  // u1, b1
}

std::string npy_header(std::string_view type, const std::vector<std::size_t>& shape,
                       std::size_t entries) {
  std::size_t count = 1;
  std::string extents;
  for (const std::size_t extent : shape) {
    count *= extent;
    extents += std::to_string(extent) + ", ";
  }
  if (count != entries)
    throw Error(Trouble::input, "npy: " + std::to_string(entries) + " values for a shape of " +
                                    std::to_string(count));
  if (shape.size() > 1) extents.resize(extents.size() - 2);
  if (shape.size() == 1) extents.pop_back();  // (5,) as Python writes it
  std::string text = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                     extents + "), }";
  const std::size_t fixed = magic.size() + 4;  // version and length
  text.resize((fixed + text.size() + 1 + 63) / 64 * 64 - fixed - 1,
              ' ');  // data aligned to 64 bytes
  text += '\n';
  std::string header(magic);
  header += '\x01';
  header += '\0';
  store(header, static_cast<std::uint16_t>(text.size()), std::endian::little);
  return header + text;
}

template <class Number>
void write_array(const std::filesystem::path& path, std::string_view type,
                 const std::vector<std::size_t>& shape, const std::vector<Number>& values) {
  std::string bytes = npy_header(type, shape, values.size());
  for (const Number value : values) store(bytes, value, std::endian::little);
  write_file(path, bytes);
}

}  // namespace

NumberArray decode_npy(std::string_view bytes, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw Error(Trouble::input, name + ": " + what);
  };
  if (bytes.substr(0, magic.size()) != magic || bytes.size() < 12)
    fail("is not a NumPy array file");
  const int version = static_cast<unsigned char>(bytes[6]);
  if (version < 1 || version > 3) fail("npy version " + std::to_string(version) + " is unknown");
  const std::size_t length = version == 1
                                 ? load<std::uint16_t>(bytes.data() + 8, std::endian::little)
                                 : load<std::uint32_t>(bytes.data() + 8, std::endian::little);
  bytes.remove_prefix(version == 1 ? 10 : 12);
  if (length > bytes.size()) fail("the file ends inside the npy header");
  const std::string_view header = bytes.substr(0, length);
  bytes.remove_prefix(length);
  const Type type = parse_type(entry(header, "descr", name), name);
  if (entry(header, "fortran_order", name).substr(0, 5) != "False")
    fail("npy array is in Fortran order; C order is needed (numpy.ascontiguousarray)");
  NumberArray array;
  array.shape = parse_shape(entry(header, "shape", name), name);
  const std::size_t count = checked_count(array.shape, type.bytes, bytes.size(), name);
  array.values = parse_values(bytes, count, type);
  return array;
}

NumberArray read_npy(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (bytes.substr(0, 2) == "PK")
    return decode_npy(first_zip_member(bytes, ".npy", path.string()), path.string());
  return decode_npy(bytes, path.string());
}

void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               const std::vector<std::uint16_t>& values) {
  write_array(path, "<u2", shape, values);
}

void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               const std::vector<double>& values) {
  write_array(path, "<f8", shape, values);
}

}  // namespace scan
