// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/truth.h"

namespace scan {

Bounds bounds_of(const TrueSurface& surface) {
  Bounds bounds;
  for (const PlacedShape& shape : surface.shapes) bounds.extend(bounds_of(shape));
  for (const Mesh& mesh : surface.meshes) bounds.extend(bounds_of(mesh.vertices));
  return bounds;
}

}  // namespace scan
