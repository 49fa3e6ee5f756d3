// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz.h"

#include <cstdlib>
#include <fstream>

#include "tests/fuzz/allocation.h"
#include "tests/fuzz/mutate.h"

namespace scan::test {
namespace {

std::uint64_t mutations() {
  const char* text = std::getenv("LIBSCAN_FUZZ");
  return text == nullptr ? 200 : std::strtoull(text, nullptr, 10);
}

// What is wrong with how the reader took this file; empty if nothing is.
std::string fault_of(const std::filesystem::path& path, const Reader& read) {
  try {
    read(path);
  } catch (const Error& error) {
    const std::string message = error.what();
    // a reader of a folder may name another of its files
    if (message.find(path.filename().string()) == std::string::npos &&
        message.find(path.parent_path().string()) == std::string::npos)
      return "the message names no file: " + message;
    if (message.find('\n') != std::string::npos) return "two lines: " + message;
  } catch (const std::exception& error) {
    return std::string("not a scan::Error: ") + error.what();
  }
  return "";
}

}  // namespace

void fuzz(const std::filesystem::path& path, const Reader& read, const Allowance& allowance) {
  const std::string good = read_file(path);
  ASSERT_NO_THROW(read(path)) << path;
  int faults = 0;
  for (std::uint64_t number = 0; number < mutations() && faults < 5; ++number) {
    const std::string bytes = mutated(good, number);
    std::ofstream(path, std::ios::binary) << bytes;
    watch_allocations();
    std::string fault = fault_of(path, read);
    const std::size_t limit = allowance.fixed_bytes + allowance.per_byte * bytes.size();
    if (fault.empty() && peak_allocated_bytes() > limit)
      fault = "allocates " + std::to_string(peak_allocated_bytes()) + " bytes for " +
              std::to_string(bytes.size());
    if (fault.empty()) continue;
    ++faults;
    ADD_FAILURE() << path.filename() << ", copy " << number << ": " << fault;
  }
  std::ofstream(path, std::ios::binary) << good;
}

void expect_finite(const std::string& what, const Eigen::MatrixXd& numbers) {
  if (!numbers.allFinite()) throw std::logic_error(what + " is not finite");
}

void expect_sound(const Mesh& mesh) {
  for (const Eigen::Vector3d& vertex : mesh.vertices) expect_finite("a vertex", vertex);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      if (corner >= mesh.vertices.size()) throw std::logic_error("a corner is no vertex");
}

void expect_sound(const PointCloud& cloud) {
  for (const Eigen::Vector3d& point : cloud.points) expect_finite("a point", point);
  for (const std::size_t size : {cloud.normals.size(), cloud.sigma_m.size(),
                                 cloud.covariances.size(), cloud.intensity.size()})
    if (size != 0 && size != cloud.size()) throw std::logic_error("a list is of another length");
}

}  // namespace scan::test
