// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Embree's tree over all bounded solids of a scene. It proposes blocks of triangles and shapes; who
// is hit where is decided in double precision, by probe.h.
#pragma once

#include <span>
#include <vector>

#include "synth/probe.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace scan::synth {

class EmbreeTree {
 public:
  static constexpr std::size_t packet = 16;  // rays that travel together

  EmbreeTree();
  ~EmbreeTree();
  EmbreeTree(const EmbreeTree&) = delete;
  EmbreeTree& operator=(const EmbreeTree&) = delete;

  // Once, for bounded solids. Throws scan::Error (resource, computation).
  void build(std::vector<Solid> solids);

  const Arena& arena() const { return arena_; }

  // Offers every hit that can matter, given the nearest so far, to the probe; more may be offered.
  void offer_hits(Probe& probe) const;
  // The same for up to `packet` probes of neighbouring rays; only those with `wanted` true.
  void offer_hits(std::span<Probe> probes, std::span<const bool> wanted) const;

  bool any_hit(Probe& probe) const;
  // Sets found[i] where something is hit; leaves it where nothing is or nothing is wanted.
  void any_hit(std::span<Probe> probes, std::span<const bool> wanted, std::span<bool> found) const;

 private:
  struct Part;  // a solid as Embree's callbacks see it
  friend struct Callbacks;
  void commit();

  Arena arena_;
  std::vector<Solid> solids_;
  std::vector<Part> parts_;
  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
};

}  // namespace scan::synth
