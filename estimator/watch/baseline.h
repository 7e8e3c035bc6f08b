#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/watch/amplitude_curve.h"
#include "estimator/watch/separate_windows.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Reference parameters that changes are judged against: theta order, SI; NaN where there is none.
struct Baseline {
  Baseline() = default;
  explicit Baseline(std::size_t parameters);
  std::vector<double> value, std_error;
  std::vector<double> degc;  ///< mean temperature at which it was learned; NaN: not known
  /// Its values by the amplitude of the element, that of RecentAmplitude, ascending, at most
  /// AmplitudeBins::kBins; empty: not known.
  std::vector<std::vector<AmplitudePoint>> by_amplitude;

  bool knows(std::size_t parameter) const;
  /// Number of parameters it knows.
  int known() const;
  /// Whether it knows what `other` knows, by the same values.
  bool holds(const Baseline& other) const;
  /// Whether it is one of so many parameters.
  bool is_of(std::size_t parameters) const {
    return value.size() == parameters && std_error.size() == parameters &&
           degc.size() == parameters && by_amplitude.size() == parameters;
  }

  /// by_amplitude as numbers: of every parameter how many points, then those.
  std::vector<double> flat_points() const;
  /// The same read; false: they are none.
  [[nodiscard]] bool take_points(const std::vector<double>& numbers);

  template <typename Archive>
  void archive(Archive& a) {
    for (std::vector<double>* of : {&value, &std_error, &degc}) a.any_size(*of);
    std::vector<double> points = flat_points();
    a.any_size(points);
    if constexpr (Archive::kReading)
      if (!take_points(points)) a.refuse();
  }
};

/// Learns a baseline while the building is intact: the mean of the main windows that count and do
/// not overlap, weighted by 1 / std_error^2, in all and by amplitude. Its error follows from the
/// weights, or from the scatter of the windows, about what amplitude explains, if that is larger.
/// Every parameter is learned for itself, until the error of its baseline is small beside the least
/// relevant change; in weak motion that takes longer.
class BaselineLearner {
 public:
  /// Standard error of a baseline, over the least relevant change, at which it is learned.
  static constexpr double kExact = 0.1;

  /// watched: theta order. learn_s: sum of the windows that every parameter takes at least.
  /// amplitude: values by it are learned too.
  BaselineLearner(const std::vector<Watched>& watched, double learn_s, bool amplitude = true);

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
    a(windows_, sums_, recent_);
  }

 private:
  struct Sum {
    bool complete = false;
    int count = 0;
    double learned_s = 0;
    double weight = 0, value = 0, square = 0;  ///< of values over the first one
    double first = 0;
    double degc_weight = 0, degc = 0;
    int with_amplitude = 0;  ///< of count
    AmplitudeBins bins;

    template <typename Archive>
    void archive(Archive& a) {
      a(complete);
      a.within(count, 0, a.kMaxCount);
      a.within(with_amplitude, 0, count);
      a(bins);
      a.finite(learned_s, weight, value, square, first, degc_weight, degc);
    }
  };
  struct Mean {
    double value, std_error, degc;
  };
  static Mean mean(const Sum& sum);
  static void put(const Sum& sum, std::size_t parameter, Baseline& out);
  void remember(const WindowEstimate& estimate);
  bool enough(std::size_t parameter) const;

  std::vector<Watched> watched_;
  double learn_s_;
  bool amplitude_;
  SeparateWindows windows_;
  std::vector<Sum> sums_;
  std::vector<RecentAmplitude> recent_;  ///< of main windows
};

}  // namespace framewatch::estimator
