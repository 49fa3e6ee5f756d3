// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Other programs' alignment of a pair, for comparison.
#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "tests/benchmarks/split_pairs.h"

namespace scan::test {

// Of one thread the processor's time, which says the same on a busy machine; of more the clock's.
class PairWatch {
 public:
  static inline bool of_processor = true;
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec time;
    clock_gettime(of_processor ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double start_ = now();
};

// `prepare_s`: thinning, and what else the method needs once per cloud, where it can be done apart.
struct Outcome {
  double prepare_s = 0, align_s = 0;
  Pose pose = Pose::Identity();  // target_from_source
  std::string stop;

  double total_s() const { return prepare_s + align_s; }
};

struct AlignPeer {
  std::string name;
  Outcome (*align)(const PairCase&);
};

// PCL's ICP, ICP with normals, NDT and GICP, which have one thread.
std::vector<AlignPeer> pcl_align_peers();

// Open3D's point-to-point, point-to-plane and generalised ICP; none if built without Open3D.
std::vector<AlignPeer> open3d_align_peers(int threads);

}  // namespace scan::test
