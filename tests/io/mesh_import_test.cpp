// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/mesh_import.h"

#include <gtest/gtest.h>

#include <bit>

#include "libscan/io/byte_order.h"
#include "tests/io/gltf_tetrahedron.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

void expect_tetrahedron(const Mesh& mesh) {
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_TRUE(edge_census(mesh).watertight);
  EXPECT_NEAR(volume_m3(mesh), 1.0 / 6, 1e-6);  // floats: 2^-24 of 10 m is 6e-7
  EXPECT_EQ(bounds_of(mesh.vertices).min(), Eigen::Vector3d(10, 0, 0));
}

TEST(Gltf, ReadsBinaryAndTextWithNodesAndWelds) {
  const TemporaryFolder folder;
  write_file(folder / "a.glb", glb());
  expect_tetrahedron(read_gltf(folder / "a.glb").mesh);
  write_file(folder / "a.bin", gltf_buffer());
  write_file(folder / "a.gltf", gltf_document(R"("uri":"a.bin",)"));
  expect_tetrahedron(read_gltf(folder / "a.gltf").mesh);
  EXPECT_TRUE(read_gltf(folder / "a.gltf").corners.empty());
}

// Each corner's place on the picture is (x, y) of its position here.
TEST(Gltf, ReadsTextureCoordinates) {
  const TemporaryFolder folder;
  const int corners[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  std::string bytes;
  for (const auto& [x, y] : corners)
    for (const int value : {x, y, 0}) store(bytes, static_cast<float>(value), std::endian::little);
  for (const auto& [x, y] : corners)
    for (const int value : {x, y}) store(bytes, static_cast<float>(value), std::endian::little);
  write_file(folder / "a.bin", bytes);
  write_file(
      folder / "a.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
      R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],)"
      R"("buffers":[{"uri":"a.bin","byteLength":60}]})");
  const TexturedMesh textured = read_gltf(folder / "a.gltf");
  ASSERT_EQ(textured.corners.size(), 1u);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t vertex = textured.mesh.triangles[0][k];
    EXPECT_EQ(textured.corners[0][k], textured.mesh.vertices[vertex].head<2>());
  }
}

TEST(Gltf, RefusesVerticesThatAreNotFinite) {
  const TemporaryFolder folder;
  std::string bytes = gltf_buffer();
  bytes.replace(0, 4, std::string("\x00\x00\xc0\x7f", 4));  // NaN
  write_file(folder / "a.bin", bytes);
  write_file(folder / "a.gltf", gltf_document(R"("uri":"a.bin",)"));
  EXPECT_NE(error_of([&] { read_gltf(folder / "a.gltf"); }).find("vertex 0 is not finite"),
            std::string::npos);
}

TEST(Gltf, RefusesPromisesThatDoNotHold) {
  const TemporaryFolder folder;
  write_file(folder / "a.bin", gltf_buffer());
  const auto said = [&](const std::string& from, const std::string& to) {
    std::string text = gltf_document(R"("uri":"a.bin",)");
    text.replace(text.find(from), from.size(), to);
    write_file(folder / "a.gltf", text);
    return error_of([&] { read_gltf(folder / "a.gltf"); });
  };
  EXPECT_NE(said(R"("byteLength":168)", R"("byteLength":169)")
                .find("a buffer of 169 bytes, there are 168"),
            std::string::npos);
  EXPECT_NE(said(R"("byteLength":24)", R"("byteLength":25)").find("ends behind its buffer"),
            std::string::npos);
  EXPECT_NE(said(R"("count":12,"type":"SCALAR")", R"("count":4000000000,"type":"SCALAR")")
                .find("4000000000 entries"),
            std::string::npos);
  EXPECT_NE(said(R"("indices":1)", R"("indices":7)").find("indices is 7, there are 2"),
            std::string::npos);
  EXPECT_NE(said(R"("children":[1])", R"("children":[0])").find("ancestor"), std::string::npos);
  EXPECT_NE(said("a.bin", "b.bin").find("'b.bin' cannot be read"), std::string::npos);
  EXPECT_NE(said("{\"asset\"", "[\"asset\"").find("not valid JSON"), std::string::npos);
}

TEST(Gltf, ReadsOrRefusesAnyDamage) {
  const TemporaryFolder folder;
  const std::string good = glb();
  const auto read = [&](const std::string& bytes) {
    write_file(folder / "d.glb", bytes);
    read_gltf(folder / "d.glb");
  };
  for (int flip = 0; flip < 1000; ++flip) {
    RandomStream random(10, 0, static_cast<std::uint64_t>(flip));
    std::string bytes = good;
    bytes[random.bits32() % bytes.size()] = static_cast<char>(random.bits32());
    try {
      read(bytes);
    } catch (const Error&) {
    }
  }
  for (std::size_t size = 0; size < good.size(); size += 13)
    error_of([&] { read(good.substr(0, size)); });
}

}  // namespace
}  // namespace scan
