// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>  // in every source, so that all convert alike

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/replayed_estimates.h"
#include "python/building.h"

namespace framewatch::python {

/// Returns the arrays of Estimates as a dict of numpy arrays, without a copy.
pybind11::dict dict_of(daemon::EstimateArrays arrays, std::size_t parameters);

/// Samples in, estimates out, as the daemon computes them. Threads may share it: calls wait for
/// each other.
class Estimator : private daemon::EstimationListener {
 public:
  explicit Estimator(const Building& building);

  /// Takes instants and returns the estimates of the windows that ended. See framewatch.Estimator.
  pybind11::dict push(const pybind11::array& time, const pybind11::array& accel);
  /// Ends the input and returns the last estimates.
  pybind11::dict finish();
  /// Returns the time of the newest instant taken, us; None before the first.
  pybind11::object newest_us();

 private:
  void on_estimate(const estimator::WindowEstimate& e) override { arrays_.add(e); }

  const daemon::Config config_;
  std::size_t parameters_;
  std::mutex mutex_;  ///< guards the members below; never waited for with the GIL
  daemon::EstimateArrays arrays_;
  daemon::Estimation estimation_;
  std::int64_t newest_us_ = std::numeric_limits<std::int64_t>::min();
  bool finished_ = false;
};

}  // namespace framewatch::python
