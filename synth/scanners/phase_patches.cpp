// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_patches.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

// Of the line between neighbouring points over either's plane: a crease of at most 29 degrees.
constexpr double most_rise = 0.25;

using Seen = std::optional<SeenSurface>;

bool is_matt(const Scene& scene, int object) {
  const Material& material = scene.materials[scene.objects[object].material];
  return std::holds_alternative<PlainTexture>(material.texture) &&
         (std::holds_alternative<Lambert>(material.bsdf) ||
          std::holds_alternative<OrenNayar>(material.bsdf));
}

bool is_one_surface(const Seen& a, const Seen& b) {
  if (!a || !b || a->hit.object != b->hit.object) return false;
  const Eigen::Vector3d between = b->point - a->point;
  const double rise = std::max(std::abs(between.dot(a->normal)), std::abs(between.dot(b->normal)));
  return rise <= most_rise * between.norm();
}

// What the middles of a tile's pixels see, and whether their corners see the same.
class Tile {
 public:
  Tile(const PathView& view, const PixelPlace& first,
       const std::function<bool(const PixelPlace&)>& wanted)
      : view_(view), first_(first), seen_(side * side) {
    const Camera& camera = view.scanner.camera;
    for (int i = 0; i < side * side; ++i) {
      const PixelPlace place = place_of_code(i);
      if (place.column >= camera.width_px || place.row >= camera.height_px || !wanted(place))
        continue;
      Seen middle = look(place.column, place.row);
      if (middle && is_matt(view.transport.caster().scene(), middle->hit.object) &&
          is_whole(place, middle))
        seen_[at(place)] = std::move(middle);
    }
  }

  // In the order of their codes.
  std::vector<Patch> patches() {
    std::vector<Patch> all;
    for (int i = 0; i < side * side; ++i)
      if (seen_[at(place_of_code(i))]) all.push_back(gather(place_of_code(i)));
    return all;
  }

 private:
  static constexpr int side = patch_tile_px;

  // Bits of column and row in turn.
  static int spread(int bits) {
    int code = 0;
    for (int b = 0; b < 8; ++b) code |= (bits >> b & 1) << (2 * b);
    return code;
  }
  static int gathered(int code) {
    int bits = 0;
    for (int b = 0; b < 8; ++b) bits |= (code >> (2 * b) & 1) << b;
    return bits;
  }
  PixelPlace place_of_code(int code) const {
    return {first_.column + gathered(code), first_.row + gathered(code >> 1)};
  }
  int code_of(const PixelPlace& place) const {
    return spread(place.column - first_.column) | spread(place.row - first_.row) << 1;
  }
  std::size_t at(const PixelPlace& place) const { return static_cast<std::size_t>(code_of(place)); }

  Seen look(double column, double row) const {
    const auto ray = lens_ray(view_.scanner, Eigen::Vector2d(column, row), {0, 0});
    if (!ray) return std::nullopt;
    return first_surface(view_.transport.caster(), view_.world_from_scanner, ray->ray);
  }

  bool is_whole(const PixelPlace& place, const Seen& middle) const {
    if (view_.scanner.sub_rays == 1) return true;
    for (const double right : {-0.5, 0.5})
      for (const double down : {-0.5, 0.5})
        if (!is_one_surface(middle, look(place.column + right, place.row + down))) return false;
    return true;
  }

  // Takes what is joined to a pixel out of the tile.
  Patch gather(const PixelPlace& from) {
    Patch patch;
    std::vector<std::pair<PixelPlace, SeenSurface>> open;
    const auto take = [&](const PixelPlace& place) {
      Seen& seen = seen_[at(place)];
      patch.push_back({.place = place,
                       .normal = seen->hit.normal,
                       .distance_m = seen->hit.distance_m,
                       .code = code_of(place)});
      open.emplace_back(place, *seen);
      seen.reset();
    };
    take(from);
    while (!open.empty()) {
      const auto [place, here] = std::move(open.back());
      open.pop_back();
      for (const auto& [right, down] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
        const PixelPlace next{place.column + right, place.row + down};
        const bool is_in_tile = std::min(next.column - first_.column, next.row - first_.row) >= 0 &&
                                std::max(next.column - first_.column, next.row - first_.row) < side;
        if (is_in_tile && is_one_surface(here, seen_[at(next)])) take(next);
      }
    }
    std::sort(patch.begin(), patch.end(),
              [](const PatchPixel& a, const PatchPixel& b) { return a.code < b.code; });
    return patch;
  }

  const PathView& view_;
  PixelPlace first_;
  std::vector<Seen> seen_;  // by code; none where no patch may be
};

}  // namespace

std::vector<Patch> patches_of(const PathView& view, const PixelPlace& first,
                              const std::function<bool(const PixelPlace&)>& wanted) {
  return Tile(view, first, wanted).patches();
}

}  // namespace scan::synth
