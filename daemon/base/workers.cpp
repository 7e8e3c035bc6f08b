#include "daemon/base/workers.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
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
  std::exception_ptr thrown;
  const auto take_pieces = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(said);
        thrown = std::current_exception();
        next = count;
        return;
      }
      const std::lock_guard lock(said);
      ++done;
      if (progress_) progress_(what, done, count);
    }
  };
  std::vector<std::jthread> others;
  try {
    for (int t = 1; t < std::min(threads_, count); ++t) others.emplace_back(take_pieces);
  } catch (const std::system_error&) {  // no more threads: those there are do it
  }
  take_pieces();
  others.clear();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace framewatch::daemon
