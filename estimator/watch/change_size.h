#pragma once

namespace framewatch::estimator {

/// How large a lasting change is, from windows that lie wholly behind it and do not overlap: the
/// mean of their deviations from the baseline, weighted with 1 / error^2 (docs/equations.md (43)).
/// The windows' scatter says more of the error of the mean than their own errors do, which are
/// careful: it makes it larger, or smaller down to a bound. A window alone that lies kFar errors
/// from the mean is left out; two in a row on the same side begin it anew, because the element has
/// changed further.
class ChangeSize {
 public:
  static constexpr double kFar = 5;
  /// The scatter of a few windows says little of their errors: the errors count as so many windows
  /// that scatter as they say.
  static constexpr double kPriorWindows = 4;
  static constexpr double kMinExcess = 0.5;

  /// Deviation of a window that overlaps none before, relative to the baseline, and its standard
  /// error > 0. common_error >= 0: of what all windows have in common, which no mean makes smaller.
  /// True when the mean was begun anew.
  bool push(double ratio, double std_error, double common_error = 0);
  /// Adds to the mean whatever it is.
  void add(double ratio, double std_error, double common_error = 0);

  bool known() const { return mean_.weight > 0; }
  int count() const { return mean_.count; }
  /// Only while known(); the standard error is without that of the baseline.
  double ratio() const { return mean_.sum / mean_.weight; }
  double std_error() const;
  /// Variance of the windows over what their errors say, >= kMinExcess.
  double excess() const;

  template <typename Archive>
  void archive(Archive& a) {
    for (Mean* m : {&mean_, &aside_}) {
      a.within(m->count, 0, a.kMaxCount / 1e7);
      a.finite(m->weight, m->sum, m->square, m->common);
    }
  }

 private:
  struct Mean {
    int count = 0;
    double weight = 0, sum = 0, square = 0, common = 0;
    void add(double ratio, double std_error, double common_error);
  };
  Mean mean_, aside_;  ///< aside_: a window that was far off
};

}  // namespace framewatch::estimator
