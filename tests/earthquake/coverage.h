// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <map>

namespace framewatch::earthquake {

/// Factor of a standard error that makes a two-sided 95 % interval of a normal error.
inline constexpr double kNormal95 = 1.96;

/// True if `value` +- 1.96 `std_error` contains `truth`. All three share one unit.
inline bool covers(double value, double std_error, double truth) {
  return std::abs(value - truth) <= kNormal95 * std_error;
}

/// Share of stated 95 % intervals that hold the truth. Values of one case share their motion and
/// noise, so they count as one cluster when the error of the share is computed.
class Coverage {
 public:
  /// Adds `count` values of a case, of which `held` lie within their interval. square_sum: of their
  /// errors over their stated standard errors.
  void add_values(int of_case, double count, double held, double square_sum) {
    Cluster& c = clusters_[of_case];
    c.count += count, c.held += held;
    count_ += count, held_ += held, squares_ += square_sum;
  }
  /// Adds one value with its standard error; both share the unit of `truth`.
  void add(int of_case, double value, double std_error, double truth) {
    const double z = (value - truth) / std_error;
    add_values(of_case, 1, covers(value, std_error, truth) ? 1 : 0, z * z);
  }
  void add(const Coverage& other) {
    for (const auto& [of_case, c] : other.clusters_)
      clusters_[of_case].count += c.count, clusters_[of_case].held += c.held;
    count_ += other.count_, held_ += other.held_, squares_ += other.squares_;
  }

  double count() const { return count_; }
  /// 0..1; NaN without values.
  double ratio() const { return count_ > 0 ? held_ / count_ : kNone; }
  /// Standard error of ratio() by clusters; NaN with fewer than two.
  double std_error() const {
    if (clusters_.size() < 2) return kNone;
    double sum = 0;
    for (const auto& [of_case, c] : clusters_)
      sum += (c.held - ratio() * c.count) * (c.held - ratio() * c.count);
    const auto n = static_cast<double>(clusters_.size());
    return std::sqrt(sum * n / (n - 1)) / count_;
  }
  /// Rms of error over stated standard error; 1 if the stated errors are right.
  double rms_of_errors() const { return count_ > 0 ? std::sqrt(squares_ / count_) : kNone; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  struct Cluster {
    double count = 0, held = 0;
  };
  std::map<int, Cluster> clusters_;
  double count_ = 0, held_ = 0, squares_ = 0;
};

}  // namespace framewatch::earthquake
