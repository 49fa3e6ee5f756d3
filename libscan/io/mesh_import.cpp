// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/mesh_import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <exception>

#include "libscan/core/error.h"
#include "libscan/io/gltf_check.h"

namespace scan {
namespace {

void append(Mesh& mesh, const aiMesh& part, const std::string& name) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    mesh.vertices.emplace_back(v.x, v.y, v.z);
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    Triangle triangle;
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= part.mNumVertices)
        throw Error(Trouble::input, name + ": a triangle names vertex " +
                                        std::to_string(face.mIndices[k]) + " of " +
                                        std::to_string(part.mNumVertices));
      triangle[k] = first + face.mIndices[k];
    }
    mesh.triangles.push_back(triangle);
  }
}

Mesh import(const std::filesystem::path& path) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,  // so that vertices weld by position alone
      aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  const aiScene* scene = importer.ReadFile(
      path.string(), aiProcess_RemoveComponent | aiProcess_Triangulate |
                         aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
  if (!scene) throw Error(Trouble::input, path.string() + ": " + importer.GetErrorString());
  Mesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(mesh, *scene->mMeshes[i], path.string());
  return mesh;
}

}  // namespace

Mesh read_gltf(const std::filesystem::path& path) {
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
