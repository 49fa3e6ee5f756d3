// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "libscan/core/random.h"

namespace scan::test {
namespace {

using namespace std::string_view_literals;

constexpr std::array hostile_words = {"nan"sv,
                                      "inf"sv,
                                      "-inf"sv,
                                      "0"sv,
                                      "-1"sv,
                                      "1e308"sv,
                                      "-1e400"sv,
                                      "1e-320"sv,
                                      "2147483647"sv,
                                      "-2147483648"sv,
                                      "4294967295"sv,
                                      "4294967296"sv,
                                      "9223372036854775807"sv,
                                      "18446744073709551615"sv,
                                      "1e9"sv,
                                      "0x10"sv,
                                      "1.5"sv,
                                      "65536"sv,
                                      ""sv,
                                      "--3"sv,
                                      "99999999999999999999"sv};

// Little-endian: all ones, the largest and least whole numbers of 32 bits, NaN and infinity as
// float and double, the largest double, one.
constexpr std::array hostile_bytes = {"\xff\xff\xff\xff"sv,
                                      "\xff\xff\xff\x7f"sv,
                                      "\x00\x00\x00\x80"sv,
                                      "\x00\x00\x00\x00"sv,
                                      "\x00\x00\xc0\x7f"sv,
                                      "\x00\x00\x80\x7f"sv,
                                      "\x00\x00\x00\x01"sv,
                                      "\xff\xff\xff\xff\xff\xff\xff\xff"sv,
                                      "\x00\x00\x00\x00\x00\x00\xf8\x7f"sv,
                                      "\x00\x00\x00\x00\x00\x00\xf0\x7f"sv,
                                      "\xff\xff\xff\xff\xff\xff\xef\x7f"sv,
                                      "\x00\x00\x00\x00\x01\x00\x00\x00"sv};

std::size_t below(RandomStream& random, std::size_t limit) {
  return limit == 0 ? 0 : random.bits32() % limit;
}

bool is_of_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e';
}

// Replaces the written number that stands at or behind a place of chance.
void write_hostile_word(std::string& bytes, RandomStream& random) {
  std::size_t first = below(random, bytes.size());
  const std::string_view word = hostile_words[below(random, hostile_words.size())];
  while (first < bytes.size() && !(bytes[first] >= '0' && bytes[first] <= '9')) ++first;
  std::size_t last = first;
  while (first > 0 && is_of_number(bytes[first - 1])) --first;
  while (last < bytes.size() && is_of_number(bytes[last])) ++last;
  bytes.replace(first, last - first, word);
}

void write_hostile_bytes(std::string& bytes, RandomStream& random) {
  const std::string_view word = hostile_bytes[below(random, hostile_bytes.size())];
  const std::size_t at = below(random, bytes.size());
  bytes.replace(at, std::min(word.size(), bytes.size() - at), word);
}

// Half of the damage falls on the first 256 bytes, where the headers are.
std::size_t place(RandomStream& random, std::size_t size) {
  const bool in_head = random.bits32() % 2 == 0;
  return below(random, in_head ? std::min<std::size_t>(size, 256) : size);
}

void mutate_once(std::string& bytes, RandomStream& random) {
  const std::uint32_t kind = random.bits32() % 8;
  const std::size_t at = place(random, bytes.size());
  const std::size_t length = 1 + below(random, std::min<std::size_t>(bytes.size() - at, 64));
  if (bytes.empty()) return;
  switch (kind) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.bits32() % 8));
      break;
    case 1:
      bytes[at] = static_cast<char>(random.bits32());
      break;
    case 2:
      bytes.resize(below(random, bytes.size()));
      break;
    case 3:
      bytes.insert(at, bytes.substr(at, length));
      break;
    case 4:
      bytes.erase(at, length);
      break;
    case 5: {
      const std::string chunk = bytes.substr(at, length);
      bytes.erase(at, length);
      bytes.insert(below(random, bytes.size() + 1), chunk);
      break;
    }
    case 6:
      write_hostile_word(bytes, random);
      break;
    default:
      write_hostile_bytes(bytes, random);
  }
}

}  // namespace

std::string mutated(const std::string& good, std::uint64_t number) {
  RandomStream random(19, 0, number);
  std::string bytes = good;
  for (std::uint32_t left = 1 + random.bits32() % 3; left > 0; --left) mutate_once(bytes, random);
  return bytes;
}

}  // namespace scan::test
