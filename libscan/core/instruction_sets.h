// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Kernels on raw arrays, compiled for several instruction sets and chosen when the program starts.
//
// Write the kernel once as an SCAN_INLINE function of loops without branches, call it from three
// functions marked SCAN_PLAIN, SCAN_AVX2 and SCAN_AVX512, and hand these to `versions`. Its file
// must be compiled by scan_kernel_source (cmake/targets.cmake), so that every product is rounded by
// itself: then all versions give the same bytes. No type of Eigen, whose layout depends on the
// instruction set, may come near.
#pragma once

#include <array>
#include <span>

#if defined(__x86_64__)
#define SCAN_AVX2 [[gnu::target("avx2")]]
#if defined(__clang__)
#define SCAN_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw")]]
#else
#define SCAN_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]]
#endif
#else
#define SCAN_AVX2
#define SCAN_AVX512
#endif
#define SCAN_INLINE [[gnu::always_inline]] inline

namespace scan {

// The versions of a kernel that this processor can run, the fastest last.
template <class Kernel>
class Versions {
 public:
  Versions(Kernel* plain, Kernel* avx2, Kernel* avx512) : all_{plain, avx2, avx512} {
#if defined(__x86_64__)
    if (!__builtin_cpu_supports("avx2")) return;
    count_ = 2;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
      count_ = 3;
#endif
  }
  std::span<Kernel* const> all() const {
    return {all_.data(), count_};
  }
  Kernel* fastest() const {
    return all_[count_ - 1];
  }

 private:
  std::array<Kernel*, 3> all_;
  std::size_t count_ = 1;
};

}  // namespace scan
