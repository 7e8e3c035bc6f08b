// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/window_estimate_t.hpp>

namespace framewatch::daemon {

/// A message field that differs between two logs.
struct FieldDifference {
  std::string channel, field;
  std::int64_t end_us = 0;  ///< end of the window
  double a = 0, b = 0;
  /// Returns |a - b| divided by the larger of |a| and |b|; infinite if only one of them is a
  /// number.
  double ratio() const;
};

/// The first and the worst difference of one field, of one parameter or of the window as a whole.
struct DifferenceSpan {
  std::int64_t count = 0;
  FieldDifference first, worst;
};

/// Compares estimates window by window and field by field.
class EstimateDiff {
 public:
  /// `names` are the names of the parameters.
  explicit EstimateDiff(std::vector<std::string> names) : names_(std::move(names)) {}

  /// Compares two messages of the same channel and window.
  void compare(const std::string& channel, const framewatch::window_estimate_t& a,
               const framewatch::window_estimate_t& b);

  std::int64_t compared() const { return compared_; }
  std::int64_t different() const { return different_; }
  /// Returns the differences by subject (the name of a parameter, or "window"), then by field.
  const std::map<std::string, std::map<std::string, DifferenceSpan>>& spans() const {
    return spans_;
  }

 private:
  void note(const std::string& subject, const std::string& field, double a, double b);
  template <typename Value>
  void columns(const char* field, const std::vector<Value>& a, const std::vector<Value>& b);

  std::vector<std::string> names_;
  std::string channel_;
  std::int64_t end_us_ = 0;
  bool same_ = true;
  std::int64_t compared_ = 0, different_ = 0;
  std::map<std::string, std::map<std::string, DifferenceSpan>> spans_;
};

}  // namespace framewatch::daemon
