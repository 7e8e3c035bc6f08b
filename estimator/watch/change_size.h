#pragma once

namespace framewatch::estimator {

/// How large a lasting change is, from the windows that lie wholly behind it: the mean of their
/// deviations from the baseline, weighted with 1 / error^2, so that its error shrinks while windows
/// come (docs/equations.md (40)). A window alone that lies kFar errors from that mean is
/// left out; two in a row on the same side begin it anew, because the element has changed further.
class ChangeSize {
 public:
  static constexpr double kFar = 5;

  /// Deviation of a window that overlaps none before, relative to the baseline, and its standard
  /// error > 0. common_error >= 0: of what all windows have in common, which no mean makes smaller.
  void push(double ratio, double std_error, double common_error = 0);

  bool known() const { return mean_.weight > 0; }
  /// Only while known(); the standard error is without that of the baseline.
  double ratio() const { return mean_.sum / mean_.weight; }
  double std_error() const;

  template <typename Archive>
  void archive(Archive& a) {
    for (Mean* m : {&mean_, &aside_}) a.finite(m->weight, m->sum, m->common);
  }

 private:
  struct Mean {
    double weight = 0, sum = 0, common = 0;
    void add(double ratio, double std_error, double common_error);
  };
  Mean mean_, aside_;  ///< aside_: a window that was far off
};

}  // namespace framewatch::estimator
