// SPDX-License-Identifier: MIT
#include "python/estimator.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "estimator/motion/sample.h"
#include "python/arrays.h"
#include "python/errors.h"
#include "python/interrupts.h"

namespace framewatch::python {
namespace {

namespace py = pybind11;

daemon::Config without_boxplots(daemon::Config config) {
  config.pipeline.options.boxplot_windows = 0;
  return config;
}

/// Throws Error if a time is not after the one before it, or a value is infinite.
void check_instants(const Times& times, const Values& values, std::size_t columns,
                    std::int64_t newest_us) {
  std::int64_t before_us = newest_us, time_us = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!times.microseconds(i, time_us))
      throw Error(fmt::format("time: entry {}, {}, is not a time", i, times.text(i)));
    if (time_us <= before_us)
      throw Error(fmt::format("time: entry {}, {}, is not after {} us, the time before it", i,
                              times.text(i), before_us));
    before_us = time_us;
    for (std::size_t c = 0; c < columns; ++c)
      if (std::isinf(values(i, c)))
        throw Error(
            fmt::format("accel: entry ({}, {}) is infinite; NaN stands for a lost sample", i, c));
  }
}

}  // namespace

py::dict dict_of(daemon::EstimateArrays a, std::size_t parameters) {
  py::dict out;
  out["window_start_us"] = owned(std::move(a.start_us));
  out["window_end_us"] = owned(std::move(a.end_us));
  out["sequence"] = owned(std::move(a.sequence));
  out["status"] = owned(std::move(a.status));
  out["rows"] = owned(std::move(a.rows));
  out["residual_ratio"] = owned(std::move(a.residual_ratio));
  out["value"] = owned(std::move(a.value), parameters);
  out["std_error"] = owned(std::move(a.std_error), parameters);
  out["reason"] = owned(std::move(a.reason), parameters);
  return out;
}

Estimator::Estimator(const Building& building)
    : config_(without_boxplots(building.config())),
      parameters_(static_cast<std::size_t>(building.table().size())),
      estimation_(config_, {}, this) {}

py::dict Estimator::push(const py::array& time, const py::array& accel) {
  const Times times(time, "time");
  const std::size_t columns = config_.pipeline.axes.size();
  const Values values(accel, "accel", times.size(), columns);
  Interrupts interrupts{py::none()};
  daemon::EstimateArrays out;
  {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    if (finished_) throw Error("push: the input was ended by finish(); make another Estimator");
    check_instants(times, values, columns, newest_us_);
    for (std::size_t i = 0; i < times.size(); ++i) {
      interrupts("push", 0);
      times.microseconds(i, newest_us_);
      const estimator::Time at = estimator::from_microseconds(newest_us_);
      for (std::size_t c = 0; c < columns; ++c)
        estimation_.sample({at, static_cast<int>(c), values(i, c)});
    }
    std::swap(out, arrays_);
  }
  return dict_of(std::move(out), parameters_);
}

py::dict Estimator::finish() {
  daemon::EstimateArrays out;
  {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    if (!finished_) estimation_.finish();
    finished_ = true;
    std::swap(out, arrays_);
  }
  return dict_of(std::move(out), parameters_);
}

py::object Estimator::newest_us() {
  std::int64_t us = 0;
  {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    us = newest_us_;
  }
  if (us == std::numeric_limits<std::int64_t>::min()) return py::none();
  return py::int_(us);
}

}  // namespace framewatch::python
