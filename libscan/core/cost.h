// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a result cost.
#pragma once

#include <chrono>

namespace scan {

// `seconds` of wall time. Peak memory belongs to the process: see peak_memory_mib().
struct Cost {
  double seconds = 0;
};

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Seconds that processors have worked for this process, on all threads: what else the machine does
// hardly changes them.
double processor_seconds();

// Largest resident memory of this process, MiB (1 MiB = 2^20 bytes), since it began or since the
// last restart.
double peak_memory_mib();

// Gives what is free back to the system and begins the peak anew, where the system lets us; else
// the peak stays that of the whole process.
void restart_peak_memory();

}  // namespace scan
