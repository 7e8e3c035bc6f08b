#pragma once

#include <cstddef>
#include <vector>

namespace framewatch::estimator {

/// What the deviations of many elements have in common. Temperature, mass, the scale or the clock
/// of the sensors change all of them alike, and so may an earthquake.
class CommonChange {
 public:
  /// Share of the elements that must agree with what they have in common.
  static constexpr double kAgree = 0.75;

  explicit CommonChange(std::size_t most);

  void clear() { elements_.clear(); }
  /// Deviation of an element from its baseline, relative, and its standard error > 0. Not more than
  /// `most` times.
  void add(double off, double std_error);

  struct Mean {
    double off = 0, std_error = 0;
    bool known = false;
  };
  /// The weighted mean of those within three errors of the weighted median. Not known when fewer
  /// than `least` elements were added, or fewer than kAgree of them agree.
  Mean mean(std::size_t least);

 private:
  struct Element {
    double off, std_error, weight;
  };
  std::size_t most_;
  std::vector<Element> elements_;
};

}  // namespace framewatch::estimator
