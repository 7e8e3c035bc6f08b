// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace framewatch::estimator {

/// A function that calls work(0) .. work(count - 1), each once, in any order, possibly in parallel,
/// and returns when all are done. Results must not depend on the order.
using Parallel = std::function<void(int count, const std::function<void(int)>& work)>;

inline void run_all(const Parallel& parallel, int count, const std::function<void(int)>& work) {
  if (parallel)
    parallel(count, work);
  else
    for (int i = 0; i < count; ++i) work(i);
}

}  // namespace framewatch::estimator
