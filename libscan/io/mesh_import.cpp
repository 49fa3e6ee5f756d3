// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/mesh_import.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <exception>

#include "libscan/core/error.h"
#include "libscan/io/gltf_check.h"
#include "libscan/io/welder.h"

namespace scan {
namespace {

Eigen::Vector3d vertex_of(const aiMesh& part, unsigned index, const std::string& name) {
  if (index >= part.mNumVertices)
    throw Error(Trouble::input, name + ": a triangle names vertex " + std::to_string(index) +
                                    " of " + std::to_string(part.mNumVertices));
  const aiVector3D& v = part.mVertices[index];
  const Eigen::Vector3d vertex(v.x, v.y, v.z);
  if (!vertex.allFinite())
    throw Error(Trouble::input, name + ": vertex " + std::to_string(index) + " is not finite");
  return vertex;
}

// assimp turns glTF's places on a picture upside down.
Eigen::Vector2d place_of(const aiMesh& part, unsigned index, const std::string& name) {
  const aiVector3D& place = part.mTextureCoords[0][index];
  if (!std::isfinite(place.x) || !std::isfinite(place.y))
    throw Error(Trouble::input, name + ": the place of vertex " + std::to_string(index) +
                                    " on the picture is not finite");
  return {place.x, 1 - place.y};
}

void append(const aiMesh& part, const std::string& name, Welder& welder,
            std::vector<TextureCorners>& places) {
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    std::array<Eigen::Vector3d, 3> corners;
    for (unsigned k = 0; k < 3; ++k) corners[k] = vertex_of(part, face.mIndices[k], name);
    if (!welder.add(corners) || !part.HasTextureCoords(0)) continue;
    places.emplace_back();
    for (unsigned k = 0; k < 3; ++k) places.back()[k] = place_of(part, face.mIndices[k], name);
  }
}

TexturedMesh import(const std::filesystem::path& path) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (!scene) throw Error(Trouble::input, path.string() + ": " + importer.GetErrorString());
  Welder welder;
  TexturedMesh result;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
    append(*scene->mMeshes[i], path.string(), welder, result.corners);
  result.mesh = welder.take();
  if (result.corners.size() != result.mesh.triangles.size()) result.corners.clear();
  return result;
}

}  // namespace

TexturedMesh read_gltf(const std::filesystem::path& path) {
  check_gltf(path);
  try {
    return import(path);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(Trouble::input, path.string() + ": " + error.what());
  } catch (...) {
    throw Error(Trouble::input, path.string() + ": cannot be imported");
  }
}

}  // namespace scan
