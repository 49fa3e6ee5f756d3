// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Members of a zip archive (APPNOTE 6.3), stored or deflated, below 4 GiB: what numpy.savez writes.
#include <zlib.h>

#include <bit>

#include "libscan/core/error.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/image_codecs.h"

namespace scan {
namespace {

constexpr std::uint32_t end_signature = 0x06054b50, entry_signature = 0x02014b50,
                        local_signature = 0x04034b50;
constexpr std::size_t end_bytes = 22, entry_bytes = 46, local_bytes = 30;
constexpr std::uint64_t deflate_limit = 1032;  // unpacked over packed bytes, at most (zlib)

std::uint32_t u32(std::string_view bytes, std::size_t at) {
  return load<std::uint32_t>(bytes.data() + at, std::endian::little);
}
std::uint16_t u16(std::string_view bytes, std::size_t at) {
  return load<std::uint16_t>(bytes.data() + at, std::endian::little);
}

struct Member {
  std::uint16_t method;
  std::uint32_t crc, packed_bytes, unpacked_bytes;
  std::size_t local_at;
};

class Archive {
 public:
  Archive(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Member find(std::string_view ending) const {
    const std::size_t end = end_record();
    std::size_t at = u32(bytes_, end + 16);
    for (int left = u16(bytes_, end + 10); left > 0; --left) {
      require(at, entry_bytes);
      if (u32(bytes_, at) != entry_signature) fail("its directory is broken");
      const std::size_t name_bytes = u16(bytes_, at + 28);
      require(at + entry_bytes, name_bytes);
      if (bytes_.substr(at + entry_bytes, name_bytes).ends_with(ending))
        return {u16(bytes_, at + 10), u32(bytes_, at + 16), u32(bytes_, at + 20),
                u32(bytes_, at + 24), u32(bytes_, at + 42)};
      at += entry_bytes + name_bytes + u16(bytes_, at + 30) + u16(bytes_, at + 32);
    }
    fail("holds no " + std::string(ending));
  }

  std::string unpack(const Member& member) const {
    require(member.local_at, local_bytes);
    if (u32(bytes_, member.local_at) != local_signature) fail("a member's header is broken");
    const std::size_t data_at = member.local_at + local_bytes + u16(bytes_, member.local_at + 26) +
                                u16(bytes_, member.local_at + 28);
    require(data_at, member.packed_bytes);
    const std::string_view packed = bytes_.substr(data_at, member.packed_bytes);
    std::string unpacked = member.method == 0 ? std::string(packed) : inflated(packed, member);
    const auto* data = reinterpret_cast<const Bytef*>(unpacked.data());
    if (unpacked.size() != member.unpacked_bytes || crc32_z(0, data, unpacked.size()) != member.crc)
      fail("a member is damaged (size or checksum)");
    return unpacked;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Trouble::input, name_ + ": zip archive: " + what);
  }

  void require(std::size_t at, std::size_t count) const {
    if (at > bytes_.size() || count > bytes_.size() - at) fail("the file ends early");
  }

  // The end record is the last thing in the file but for a comment of at most 65535 bytes.
  std::size_t end_record() const {
    if (bytes_.size() < end_bytes) fail("the file ends early");
    for (std::size_t at = bytes_.size() - end_bytes; at + 65535 + end_bytes >= bytes_.size();
         --at) {
      if (u32(bytes_, at) == end_signature) return at;
      if (at == 0) break;
    }
    fail("has no directory");
  }

  std::string inflated(std::string_view packed, const Member& member) const {
    if (member.method != 8) fail("packing method " + std::to_string(member.method) + " is unknown");
    if (member.unpacked_bytes > deflate_limit * member.packed_bytes)
      fail("promises more than its bytes can hold");
    std::string unpacked(member.unpacked_bytes, '\0');
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = member.packed_bytes;
    stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
    stream.avail_out = member.unpacked_bytes;
    const int result = inflate(&stream, Z_FINISH);
    const bool is_whole = result == Z_STREAM_END && stream.avail_out == 0;
    inflateEnd(&stream);
    if (!is_whole) fail("a member's packed data is damaged");
    return unpacked;
  }

  std::string_view bytes_;
  const std::string& name_;
};

}  // namespace

std::string first_zip_member(std::string_view bytes, std::string_view ending,
                             const std::string& name) {
  const Archive archive(bytes, name);
  return archive.unpack(archive.find(ending));
}

}  // namespace scan
