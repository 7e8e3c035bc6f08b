// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>  // in every source, so that all convert alike

#include <chrono>
#include <exception>
#include <functional>
#include <string>

namespace framewatch::python {

/// Lets a computation without the GIL be interrupted: takes the GIL at most every kEvery, handles
/// signals such as Ctrl-C, and calls the progress function. Python's exceptions leave as C++
/// exceptions, which end the computation.
class Interrupts {
 public:
  /// progress: called with (what: str, share: float), or None. Needs the GIL.
  explicit Interrupts(pybind11::object progress) : progress_(std::move(progress)) {}

  /// Call it without the GIL, often. what, share: see the progress function.
  void operator()(const char* what, double share) {
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + kEvery;
    const pybind11::gil_scoped_acquire gil;
    look(what, share);
  }

  /// Does the same at once. Needs the GIL.
  void look(const std::string& what, double share) {
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    if (!progress_.is_none()) progress_(what, share);
  }

  static constexpr auto kEvery = std::chrono::milliseconds(50);

 private:
  using Clock = std::chrono::steady_clock;
  pybind11::object progress_;
  Clock::time_point next_ = Clock::now() + kEvery;
};

/// Thrown into a computation to end it.
struct Stopped : std::exception {};

/// Carries reports from a computation to the thread that waits for it.
class Reports {
 public:
  virtual ~Reports() = default;
  /// Sets the current work and the share that is done. May be called by any thread.
  virtual void tell(const std::string& what, double share) = 0;
  /// Throws Stopped once the computation is to end. May be called by any thread.
  virtual void check() const = 0;
};

/// Runs `work` in another thread while this one handles signals and calls the progress function,
/// so that Python code runs in the caller's thread alone. Needs the GIL, which it releases. Throws
/// what `work` or Python's code throws; before that, `work` has ended.
void run_beside(Interrupts& interrupts, const std::function<void(Reports&)>& work);

}  // namespace framewatch::python
