// SPDX-License-Identifier: MIT
#include "daemon/base/workers.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace framewatch::daemon {

/// The additional threads. They start with the first call that has work for them.
class Workers::Crew {
 public:
  explicit Crew(int threads) : threads_(std::max(1, threads)) {}

  ~Crew() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
  }

  void run(int count, const std::function<void(int)>& work) {
    if (threads_ == 1 || count <= 1) {
      for (int i = 0; i < count; ++i) work(i);
      return;
    }
    std::unique_lock lock(mutex_);
    if (others_.empty()) begin_threads();
    const auto at = batches_.emplace(batches_.end(), Batch{work, count});
    Batch& own = *at;
    changed_.notify_all();
    while (own.begun < own.count) take_piece(own, lock);
    // Unfinished pieces of other threads can start further pieces: help with those.
    while (own.running > 0)
      if (Batch* other = any_left(at))
        take_piece(*other, lock);
      else
        changed_.wait(lock);
    const std::exception_ptr thrown = own.thrown;
    batches_.erase(at);
    lock.unlock();
    if (thrown) std::rethrow_exception(thrown);
  }

 private:
  struct Batch {
    const std::function<void(int)>& work;
    int count;
    int begun = 0, running = 0;
    std::exception_ptr thrown = {};
  };

  void begin_threads() {
    try {
      for (int t = 1; t < threads_; ++t) others_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {  // no more threads available: work with those started
    }
  }

  void help() {
    std::unique_lock lock(mutex_);
    while (!ended_)
      if (Batch* batch = any_left(batches_.begin()))
        take_piece(*batch, lock);
      else
        changed_.wait(lock);
  }

  /// Returns the newest batch, not before `oldest`, with a piece that is not started. Older batches
  /// wait for it.
  Batch* any_left(std::list<Batch>::iterator oldest) {
    for (auto at = batches_.end(); at != oldest;)
      if (--at; at->begun < at->count) return &*at;
    return nullptr;
  }

  void take_piece(Batch& batch, std::unique_lock<std::mutex>& lock) {
    const int piece = batch.begun++;
    ++batch.running;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      batch.work(piece);
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    --batch.running;
    if (thrown) {
      batch.thrown = thrown;
      batch.begun = batch.count;
    }
    if (batch.running == 0 && batch.begun == batch.count) changed_.notify_all();
  }

  const int threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Batch> batches_;  ///< oldest first
  bool ended_ = false;
  std::vector<std::jthread> others_;
};

Workers::Workers(int threads, Progress progress)
    : crew_(std::make_unique<Crew>(threads)), progress_(std::move(progress)) {}

Workers::~Workers() = default;

void Workers::run(const std::string& what, int count, const std::function<void(int)>& work) const {
  std::mutex said;
  int done = 0;
  crew_->run(count, [&](int i) {
    work(i);
    const std::lock_guard lock(said);
    ++done;
    if (progress_) progress_(what, done, count);
  });
}

void Workers::run_within(int count, const std::function<void(int)>& work) const {
  crew_->run(count, work);
}

}  // namespace framewatch::daemon
