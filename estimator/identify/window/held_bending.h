#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/window/long_window.h"
#include "estimator/setup/options.h"

namespace framewatch::estimator {

/// The bending stiffness of a building of groups (krx, kry): a property of the whole building that
/// moves slowly and that a window of seconds hardly shows. Identified free over windows of
/// kWindow_s, one after the other, each weighted by its error, and held in the sliding windows at
/// what they and the design say together. docs/equations.md, groups of stories.
class HeldBending {
 public:
  static constexpr double kWindow_s = 10;
  /// Relative: of the least error, and of what it may move from one such window to the next.
  static constexpr double kMin = 0.02, kDrift = 0.01;

  /// design: theta order, SI.
  HeldBending(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
              const EstimatorOptions& options, int block_rows, bool noise_configured,
              const Eigen::VectorXd& design);

  /// What was gathered is of other samples.
  void restart() { window_.retuned(); }
  /// LongWindow::rescale(): gathered over retunings, or strong motion would never last long enough.
  void retuned(const std::vector<double>& factor) { window_.rescale(factor); }
  void block_closed(SlidingGram& sums, const std::vector<std::uint8_t>& known, Time time) {
    window_.block_closed(sums, known, time);
  }
  /// One instant's share of the work; true when what is held has changed.
  bool advance(const LongWindow::Context& context);

  struct Held {
    int parameter;
    int unknown;
    double value;      ///< N*m/rad
    double std_error;  ///< relative
  };
  const std::vector<Held>& held() const { return held_; }

  template <typename Archive>
  void archive(Archive& a, TunedRegression& regression) {
    window_.archive(a, regression);
    for (Held& h : held_) {
      a.within(h.value, std::numeric_limits<double>::min(), a.kMax);
      a.within(h.std_error, kMin, 1);
    }
  }

 private:
  /// How far, relative, the stiffnesses are from where the equations were made linear.
  double detuning(const WindowSolution& solution) const;

  LongWindow window_;
  std::vector<int> stiffnesses_;  ///< unknowns
  std::vector<Held> held_;
};

}  // namespace framewatch::estimator
