// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>  // in every source, so that all convert alike

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/records/record.h"

namespace framewatch::python {

/// Returns an array that owns `values`, without a copy. `columns` is 0 for one dimension, else the
/// shape is (values / columns, columns).
template <typename T>
pybind11::array_t<T> owned(std::vector<T> values, std::size_t columns = 0) {
  auto held = std::make_unique<std::vector<T>>(std::move(values));
  const T* data = held->data();
  std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(held->size())};
  if (columns > 0)
    shape = {shape[0] / static_cast<pybind11::ssize_t>(columns),
             static_cast<pybind11::ssize_t>(columns)};
  const pybind11::capsule owner(held.release(),
                                [](void* v) { delete static_cast<std::vector<T>*>(v); });
  return pybind11::array_t<T>(shape, data, owner);
}

/// The times of an array of shape (n,): int64 in microseconds or float64 in seconds, of any stride.
/// Keeps the array; reading needs no GIL.
class Times {
 public:
  /// name: of the argument. Throws Error if the shape or type is another one.
  Times(pybind11::array array, const std::string& name);
  std::size_t size() const { return size_; }
  /// Returns false if the time is not finite or beyond +-2^62 us.
  bool microseconds(std::size_t i, std::int64_t& time_us) const;
  std::string text(std::size_t i) const;  ///< as a message shows it

 private:
  pybind11::array array_;
  const char* data_;
  pybind11::ssize_t stride_;
  std::size_t size_;
  bool is_integer_;
};

/// The values of an array of shape (n, channels), float64 or float32 of any strides. Keeps the
/// array; reading needs no GIL.
class Values {
 public:
  /// Throws Error if the shape or type is another one.
  Values(pybind11::array array, const std::string& name, std::size_t rows, std::size_t columns);
  double operator()(std::size_t row, std::size_t column) const;

 private:
  pybind11::array array_;
  const char* data_;
  pybind11::ssize_t row_stride_, column_stride_;
  bool is_double_;
};

/// Returns names, units, time_s (n,), accel (n, channels), rate_hz and notes of a record as a dict.
pybind11::dict dict_of(drivers::Record record);

/// Returns the record of such a dict's values. Throws Error if shapes or types do not fit, if times
/// do not increase or a value is infinite. rate_hz 0: from the median step.
drivers::Record record_of(const std::vector<std::string>& names,
                          const std::vector<std::string>& units, pybind11::array time_s,
                          pybind11::array accel, double rate_hz);

}  // namespace framewatch::python
