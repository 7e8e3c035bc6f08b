#pragma once

#include <cstddef>
#include <vector>

#include "estimator/identify/estimate.h"

namespace framewatch {

/// Reference parameters that changes are judged against: theta order, SI; NaN where there is none.
struct Baseline {
  Baseline() = default;
  explicit Baseline(std::size_t parameters);
  std::vector<double> value, std_error;

  template <typename Archive>
  void archive(Archive& a) {
    a(value, std_error);
  }
};

/// Takes a baseline from a while in which the building is what it should be: the mean of main
/// windows that do not overlap, weighted by 1 / std_error^2. Its error is what the weights say, or
/// what the windows' scatter says if that is more.
class BaselineLearner {
 public:
  /// learn_s: sum of the windows it takes.
  BaselineLearner(int parameters, double learn_s);

  /// Other windows than the main one do not count. True when this one completed the baseline.
  bool push(const WindowEstimate& estimate);
  bool complete() const { return learned_s_ >= learn_s_; }
  /// Parameters that at least half of the windows showed; the others have none.
  Baseline baseline() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(learned_s_, windows_, end_, sums_);
  }

 private:
  struct Sum {
    int count = 0;
    double weight = 0, value = 0, square = 0;  ///< of values over the first one
    double first = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a(count, weight, value, square, first);
    }
  };
  double learn_s_, learned_s_ = 0;
  int windows_ = 0;
  Time end_{};
  std::vector<Sum> sums_;
};

}  // namespace framewatch
