#pragma once

#include <functional>

namespace framewatch::estimator {

/// Calls work(0) .. work(count - 1), each once, in any order, perhaps at once; returns when all are
/// done. Results must not depend on the order. Empty: one after the other.
using Parallel = std::function<void(int count, const std::function<void(int)>& work)>;

inline void run_all(const Parallel& parallel, int count, const std::function<void(int)>& work) {
  if (parallel)
    parallel(count, work);
  else
    for (int i = 0; i < count; ++i) work(i);
}

}  // namespace framewatch::estimator
