#pragma once

#include <cstddef>
#include <vector>

namespace framewatch::estimator {

/// Force of joints that slip a little at any motion: z = sgn(x) |x|^p at first loading. From every
/// reversal (x_r, z_r) on,
///
///   z = z_r + 2 sgn(x - x_r) |(x - x_r) / 2|^p
///
/// until its loop closes; then along the curve that the loop left. Sources: Masing 1926; Iwan, J.
/// Appl. Mech. 33 (1966); Segalman, J. Appl. Mech. 72 (2005).
class SlipCurve {
 public:
  /// Starts at rest. exponent: p, above 0.
  explicit SlipCurve(double exponent) : exponent_(exponent) {}

  /// Returns z after a step from the current position to x.
  double at(double x) const { return follow(x).z; }
  /// Ends the step at x.
  void move(double x);

 private:
  struct Point {
    double x, z;
  };
  /// End of a step. `open` counts the reversals whose loops are still open there, including one at
  /// the start of the step.
  struct End {
    std::size_t open;
    double z;
  };
  End follow(double x) const;

  double exponent_;
  std::vector<Point> reversals_;  ///< of the open loops, the outermost first
  Point now_{0, 0};
  double direction_ = 0;
};

}  // namespace framewatch::estimator
