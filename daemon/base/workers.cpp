#include "daemon/base/workers.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace framewatch::daemon {

Workers::Workers(int threads, Progress progress)
    : threads_(std::max(1, threads)), progress_(std::move(progress)) {}

void Workers::run(const std::string& what, int count, const std::function<void(int)>& work) const {
  std::atomic<int> next = 0;
  std::mutex said;
  int done = 0;
  const auto take_pieces = [&] {
    for (int i = next++; i < count; i = next++) {
      work(i);
      const std::lock_guard lock(said);
      ++done;
      if (progress_) progress_(what, done, count);
    }
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < std::min(threads_, count); ++t) others.emplace_back(take_pieces);
  take_pieces();
}

}  // namespace framewatch::daemon
