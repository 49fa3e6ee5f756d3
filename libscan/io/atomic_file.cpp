// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "libscan/core/error.h"

namespace scan {

void write_file(const std::filesystem::path& path, std::string_view content) {
  const std::filesystem::path temporary = path.string() + ".part" + std::to_string(::getpid());
  const auto give_up = [&] {
    const std::string why = std::strerror(errno);
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw Error(Trouble::output, path.string() + ": cannot be written: " + why);
  };
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (!file) give_up();
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed) give_up();
  if (std::rename(temporary.c_str(), path.c_str()) != 0) give_up();
}

std::string read_file(const std::filesystem::path& path, std::size_t limit_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw Error(Trouble::input, path.string() + ": no such file");
  if (std::filesystem::is_directory(status))
    throw Error(Trouble::input, path.string() + ": is a folder, not a file");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file)
    throw Error(Trouble::input, path.string() + ": cannot be read: " + std::strerror(errno));
  const auto bytes = static_cast<std::size_t>(file.tellg());
  if (bytes > limit_bytes)
    throw Error(Trouble::resource, path.string() + ": has " + std::to_string(bytes) +
                                       " bytes, over the limit of " + std::to_string(limit_bytes));
  std::string content(bytes, '\0');
  file.seekg(0);
  if (!file.read(content.data(), static_cast<std::streamsize>(bytes)))
    throw Error(Trouble::input, path.string() + ": cannot be read to its end");
  return content;
}

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return;
  throw Error(Trouble::output, path.string() + ": " +
                                   (std::filesystem::exists(path, ignored)
                                        ? "is a file, a folder is needed"
                                        : "cannot be created: " + error.message()));
}

std::string numbered(std::size_t index, std::string_view ending) {
  const std::string digits = std::to_string(index);
  return std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits + std::string(ending);
}

std::string fingerprint(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ull;
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace scan
