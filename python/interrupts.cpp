// SPDX-License-Identifier: MIT
#include "python/interrupts.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace framewatch::python {
namespace {

class SharedReports : public Reports {
 public:
  void tell(const std::string& what, double share) override {
    check();
    const std::lock_guard lock(mutex_);
    what_ = what;
    share_ = share;
  }
  void check() const override {
    if (stop_) throw Stopped();
  }

  void end(std::exception_ptr thrown) {
    const std::lock_guard lock(mutex_);
    thrown_ = std::move(thrown);
    ended_ = true;
    changed_.notify_all();
  }
  void stop() { stop_ = true; }

  /// Waits for the end, at most Interrupts::kEvery. Returns true at the end.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, Interrupts::kEvery, [&] { return ended_; });
  }
  void read(std::string& what, double& share) {
    const std::lock_guard lock(mutex_);
    what = what_;
    share = share_;
  }
  std::exception_ptr thrown() const { return thrown_; }

 private:
  std::mutex mutex_;  ///< guards the members below, but for stop_
  std::condition_variable changed_;
  std::string what_;
  double share_ = 0;
  bool ended_ = false;
  std::exception_ptr thrown_;
  std::atomic<bool> stop_ = false;
};

}  // namespace

void run_beside(Interrupts& interrupts, const std::function<void(Reports&)>& work) {
  SharedReports reports;
  std::exception_ptr python;
  {
    const pybind11::gil_scoped_release release;
    std::jthread thread([&] {
      try {
        work(reports);
        reports.end({});
      } catch (...) {
        reports.end(std::current_exception());
      }
    });
    std::string what;
    double share = 0;
    while (!python && !reports.wait()) {
      reports.read(what, share);
      const pybind11::gil_scoped_acquire gil;
      try {
        interrupts.look(what, share);
      } catch (...) {
        python = std::current_exception();
        reports.stop();
      }
    }
  }
  if (python) std::rethrow_exception(python);
  if (reports.thrown()) std::rethrow_exception(reports.thrown());
}

}  // namespace framewatch::python
