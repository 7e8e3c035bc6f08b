#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/watch/separate_windows.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Reference parameters that changes are judged against: theta order, SI; NaN where there is none.
struct Baseline {
  Baseline() = default;
  explicit Baseline(std::size_t parameters);
  std::vector<double> value, std_error;
  std::vector<double> degc;  ///< mean temperature at which it was learned; NaN: not known

  bool knows(std::size_t parameter) const;
  /// Number of parameters it knows.
  int known() const;
  /// Whether it knows what `other` knows, by the same values.
  bool holds(const Baseline& other) const;
  /// Whether it is one of so many parameters.
  bool is_of(std::size_t parameters) const {
    return value.size() == parameters && std_error.size() == parameters &&
           degc.size() == parameters;
  }

  template <typename Archive>
  void archive(Archive& a) {
    for (std::vector<double>* of : {&value, &std_error, &degc}) a.any_size(*of);
  }
};

/// Learns a baseline while the building is intact: the mean of the main windows that count and do
/// not overlap, weighted by 1 / std_error^2. Its error follows from the weights, or from the
/// scatter of the windows if that is larger. Every parameter is learned for itself, until the error
/// of its baseline is small beside the least relevant change; in weak motion that takes longer.
class BaselineLearner {
 public:
  /// Standard error of a baseline, over the least relevant change, at which it is learned.
  static constexpr double kExact = 0.1;

  /// watched: theta order. learn_s: sum of the windows that every parameter takes at least.
  BaselineLearner(const std::vector<Watched>& watched, double learn_s);

  /// degc: the window's temperature; NaN: unknown. True when this window completed a parameter.
  bool push(const WindowEstimate& estimate, double degc = std::numeric_limits<double>::quiet_NaN());
  /// Total length of the windows so far, whatever they show.
  double seconds() const { return windows_.seconds(); }
  /// Parameters that are learned.
  Baseline baseline() const;
  /// Parameters of which at least half of the windows had a value that counts, however exact.
  Baseline so_far() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(windows_, sums_);
  }

 private:
  struct Sum {
    bool complete = false;
    int count = 0;
    double learned_s = 0;
    double weight = 0, value = 0, square = 0;  ///< of values over the first one
    double first = 0;
    double degc_weight = 0, degc = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a(complete);
      a.within(count, 0, a.kMostCount);
      a.finite(learned_s, weight, value, square, first, degc_weight, degc);
    }
  };
  struct Mean {
    double value, std_error, degc;
  };
  static Mean mean(const Sum& sum);
  static void put(const Sum& sum, std::size_t parameter, Baseline& out);
  bool enough(std::size_t parameter) const;

  std::vector<Watched> watched_;
  double learn_s_;
  SeparateWindows windows_;
  std::vector<Sum> sums_;
};

}  // namespace framewatch::estimator
