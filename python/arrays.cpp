// SPDX-License-Identifier: MIT
#include "python/arrays.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "python/errors.h"

namespace framewatch::python {
namespace {

namespace py = pybind11;

constexpr double kLargest_us = 0x1p62;

template <typename T>
T read(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

std::string shape_text(const py::array& array) {
  std::string text;
  for (py::ssize_t d = 0; d < array.ndim(); ++d)
    text += fmt::format("{}{}", d > 0 ? ", " : "", array.shape(d));
  return fmt::format("({}{})", text, array.ndim() == 1 ? "," : "");
}

std::string type_text(const py::array& array) {
  return py::str(array.dtype());
}

}  // namespace

Times::Times(py::array array, const std::string& name) : array_(std::move(array)) {
  if (array_.ndim() != 1)
    throw Error(fmt::format("{}: has shape {}, needs (n,)", name, shape_text(array_)));
  is_integer_ = py::isinstance<py::array_t<std::int64_t>>(array_);
  if (!is_integer_ && !py::isinstance<py::array_t<double>>(array_))
    throw Error(fmt::format("{}: has dtype {}, needs float64 (seconds) or int64 (microseconds)",
                            name, type_text(array_)));
  data_ = static_cast<const char*>(array_.data());
  stride_ = array_.strides(0);
  size_ = static_cast<std::size_t>(array_.shape(0));
}

bool Times::microseconds(std::size_t i, std::int64_t& time_us) const {
  const char* at = data_ + static_cast<py::ssize_t>(i) * stride_;
  if (is_integer_) {
    time_us = read<std::int64_t>(at);
    return std::abs(static_cast<double>(time_us)) < kLargest_us;
  }
  const double us = read<double>(at) * 1e6;
  if (!(std::abs(us) < kLargest_us)) return false;
  time_us = std::llround(us);
  return true;
}

std::string Times::text(std::size_t i) const {
  const char* at = data_ + static_cast<py::ssize_t>(i) * stride_;
  return is_integer_ ? fmt::format("{} us", read<std::int64_t>(at))
                     : fmt::format("{} s", read<double>(at));
}

Values::Values(py::array array, const std::string& name, std::size_t rows, std::size_t columns)
    : array_(std::move(array)) {
  if (array_.ndim() != 2 || array_.shape(0) != static_cast<py::ssize_t>(rows) ||
      array_.shape(1) != static_cast<py::ssize_t>(columns))
    throw Error(
        fmt::format("{}: has shape {}, needs ({}, {}): a row per time, a column per channel", name,
                    shape_text(array_), rows, columns));
  is_double_ = py::isinstance<py::array_t<double>>(array_);
  if (!is_double_ && !py::isinstance<py::array_t<float>>(array_))
    throw Error(fmt::format("{}: has dtype {}, needs float64 or float32", name, type_text(array_)));
  data_ = static_cast<const char*>(array_.data());
  row_stride_ = array_.strides(0);
  column_stride_ = array_.strides(1);
}

double Values::operator()(std::size_t row, std::size_t column) const {
  const char* at = data_ + static_cast<py::ssize_t>(row) * row_stride_ +
                   static_cast<py::ssize_t>(column) * column_stride_;
  return is_double_ ? read<double>(at) : static_cast<double>(read<float>(at));
}

py::dict dict_of(drivers::Record record) {
  const std::size_t channels = record.names.size(), rows = record.time_s.size();
  std::vector<double> values(rows * channels);
  std::vector<std::string> units;
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < rows; ++i) values[i * channels + c] = record.accel_mps2[c][i];
    const bool is_force = c < record.headers.size() && record.headers[c].unit == "N";
    units.emplace_back(is_force ? "N" : "m/s^2");
  }
  py::dict out;
  out["names"] = record.names;
  out["units"] = units;
  out["time_s"] = owned(std::move(record.time_s));
  out["accel"] = owned(std::move(values), channels);
  out["rate_hz"] = record.rate_hz;
  out["notes"] = record.notes;
  return out;
}

drivers::Record record_of(const std::vector<std::string>& names,
                          const std::vector<std::string>& units, py::array time_s, py::array accel,
                          double rate_hz) {
  if (!py::isinstance<py::array_t<double>>(time_s) || time_s.ndim() != 1)
    throw Error(fmt::format("Record.time_s: has shape {} and dtype {}, needs (n,) and float64",
                            shape_text(time_s), type_text(time_s)));
  if (names.empty() || units.size() != names.size())
    throw Error(fmt::format("Record: {} names and {} units, needs one of each per channel",
                            names.size(), units.size()));
  const auto times = time_s.cast<py::array_t<double>>();
  const auto rows = static_cast<std::size_t>(time_s.shape(0));
  if (rows < 2) throw Error(fmt::format("Record.time_s: has {} instants, needs 2 or more", rows));
  const Values values(std::move(accel), "Record.accel", rows, names.size());
  drivers::Record out;
  out.names = names;
  out.time_s.resize(rows);
  std::vector<double> steps;
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = out.time_s[i] = times.at(static_cast<py::ssize_t>(i));
    if (!(std::abs(t) * 1e6 < kLargest_us))
      throw Error(fmt::format("Record.time_s: entry {} is {}, not a time", i, t));
    if (i > 0 && !(t > out.time_s[i - 1]))
      throw Error(fmt::format("Record.time_s: entry {}, {} s, is not after the one before, {} s", i,
                              t, out.time_s[i - 1]));
    if (i > 0) steps.push_back(t - out.time_s[i - 1]);
  }
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::vector<double>& column = out.accel_mps2.emplace_back(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      column[i] = values(i, c);
      if (std::isinf(column[i]))
        throw Error(fmt::format("Record.accel: row {} of channel {} is infinite", i, names[c]));
    }
    out.headers.push_back({});
    out.headers.back().unit = units[c] == "N" ? "N" : "";
  }
  out.rate_hz = rate_hz > 0 ? rate_hz : 1 / daemon::median(std::move(steps));
  return out;
}

}  // namespace framewatch::python
