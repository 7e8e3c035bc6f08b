// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/watch/amplitude_curve.h"

namespace framewatch::estimator {

/// A window behind strong motion: the difference of an element's stiffness from that of the intact
/// element at the same amplitude. Ratios are relative to the baseline.
struct RecoveryWindow {
  Time start{}, end{};
  double off = 0;        ///< value over the intact one at this amplitude, less 1
  double std_error = 0;  ///< > 0: differs from window to window
  /// Standard error of the baseline, which all windows of a source share; >= 0.
  double baseline_error = 0;
  /// Standard error of the intact value that the amplitude curve causes. It is > 0 above the
  /// amplitudes of the baseline and < 0 below: a curve that is too steep makes `off` wrong in
  /// opposite directions.
  double amplitude_error = 0;
  std::size_t source =
      0;  ///< 0: ordinary windows, 1: long windows, which have a different baseline
};

/// Returns the window of a value (SI) with its standard error and the rms deformation amplitude_m.
/// baseline, baseline_error: SI, of the intact element. curve: of the intact element; one that is
/// not known counts as AmplitudeCurve::kUsualPerLog about usual_amplitude_m > 0. Precondition:
/// value, std_error, baseline and amplitude_m are > 0.
RecoveryWindow recovery_window(Time start, Time end, double value, double std_error,
                               double amplitude_m, double baseline, double baseline_error,
                               const AmplitudeCurve& curve, double usual_amplitude_m);

enum class RecoveryVerdict {
  not_known,   ///< RecoveryLaw::reason says why
  recovering,  ///< the stiffness comes back, perhaps completely
  lasting,     ///< some of the loss remains: complete recovery within a year is excluded
  recovered    ///< less than the least relevant change is left
};

/// The reason for a verdict of not_known.
enum class RecoveryReason {
  none,
  few_windows,  ///< fewer than Recovery::kFewest
  short_time,   ///< windows cover too little of the logarithm of time
  inexact,      ///< windows scatter too much
  amplitude,    ///< the effect of the amplitude on the intact element is not known well enough
  baseline      ///< the stiffness before is not known well enough
};

/// The loss after strong motion: loss(t) = loss(t_ref) - slope log10(t / t_ref). Losses are
/// fractions of the intact stiffness, positive; errors are standard errors.
struct RecoveryLaw {
  double time_s = 0;                       ///< end of the newest window, s after the strong motion
  double loss = 0, std_error = 0;          ///< at time_s
  double slope = 0, slope_error = 0;       ///< per decade of time; > 0: it recovers
  double first_s = 0;                      ///< time of the first windows
  double first_loss = 0, first_error = 0;  ///< by the windows at first_s alone
  double later_s = 0;                      ///< a day, then a month, then a year
  double later_loss = 0, later_error = 0;  ///< expected at later_s, if the law continues to hold
  double later_low = 0, later_high = 0;    ///< Recovery::kErrors errors to either side, low >= 0
  double stays = 0;  ///< for a lasting loss: at least this much remains after a year
  RecoveryVerdict verdict = RecoveryVerdict::not_known;
  RecoveryReason reason = RecoveryReason::few_windows;
};

/// Decides whether a loss of stiffness after strong motion is lasting, or recovers with the
/// logarithm of time ("slow dynamics"). Sources: TenCate, Smith, Guyer, Phys. Rev. Lett. 85 (2000),
/// 1020; Snieder, Sens-Schoenfelder, Wu, Geophys. J. Int. 208 (2017), 1.
///
/// Windows are summed by the logarithm of the time since the motion, so the state is bounded. The
/// law is fitted to these means by weighted least squares, with the errors of baseline and
/// amplitude curve as unknowns that all windows share. Only the newest part of the record that one
/// law fits is used, so a recovery that has stopped is not extrapolated. docs/equations.md,
/// recovery.
class Recovery {
 public:
  static constexpr double kErrors = 3;       ///< standard errors at which something is excluded
  static constexpr std::size_t kFewest = 4;  ///< windows that a law needs
  static constexpr double kMinSpan = 0.5;    ///< decades of time that a law needs
  static constexpr double kYear_s = 31'557'600;
  static constexpr double kMotion_s = 900;  ///< the longest strong motion
  /// Times after the strong motion at which the finding is renewed, s.
  static constexpr std::array<double, 3> kRenew_s{600, 3600, 86400};

  /// least_change > 0: the least relevant loss, a fraction of the stiffness.
  explicit Recovery(double least_change = 0.03) : least_change_(least_change) {}

  /// Starts at the end of strong motion and forgets everything before.
  void begin(Time end_of_motion);
  bool active() const { return active_; }
  Time began() const { return began_; }
  /// Returns true if a change seen at `since` may come from this strong motion: from kMotion_s
  /// before its end to the first renewal. Later changes have another cause and no law.
  bool is_of(Time since) const;
  /// Returns the number of windows that the law is fitted to.
  int windows() const;
  /// Adds a window. Ignores windows that begin before the end of the strong motion or overlap the
  /// last one of their source.
  void push(const RecoveryWindow& window);
  /// Returns the law as of the newest window.
  RecoveryLaw law() const;
  /// The loss at a time since the strong motion's end that windows cover, by the windows within a
  /// factor 2 of it; count 0: no window covers it.
  struct Loss {
    double loss = 0, std_error = 0;
    int count = 0;
  };
  Loss loss_at(double time_s) const;
  /// Returns true once for each of kRenew_s, when `now` is beyond it and a window has come since.
  bool renewal_due(Time now);

  void archive(auto& a) {
    a(active_, began_, last_end_, bins_);
    a.within(renewed_, 0, static_cast<double>(kRenew_s.size()));
    a.finite(newest_s_);
  }

 private:
  static constexpr std::size_t kSources = 2, kBins = 32;  ///< of each source
  static constexpr double kBinsPerDecade = 4, kFirst_s = 1;

  /// Weighted sums of the windows of one source in a quarter of a decade.
  struct Bin {
    int count = 0;
    double weight = 0, log = 0, off = 0, amplitude = 0, baseline = 0;
    double log_square = 0, log_off = 0, off_square = 0;

    void archive(auto& a) {
      a.within(count, 0, a.kMaxCount);
      a.finite(weight, log, off, amplitude, baseline, log_square, log_off, off_square);
    }
  };
  /// The means of a bin.
  struct Point {
    std::size_t source;
    int count;
    double weight, log, off, amplitude, baseline;
    double log_log, log_off, off_off;  ///< within the bin, about its means
  };
  struct Fit;
  std::vector<Point> points() const;
  static Fit fit(const std::vector<Point>& points, std::size_t from, double excess);
  static double excess(const std::vector<Point>& points, const Fit& fit);
  static Fit fit_newest(const std::vector<Point>& points);
  void judge(const Fit& fit, RecoveryLaw& law) const;

  double least_change_;
  bool active_ = false;
  Time began_{};
  std::array<Time, kSources> last_end_{};
  std::array<Bin, kSources * kBins> bins_{};
  std::size_t renewed_ = 0;
  double newest_s_ = 0;
};

}  // namespace framewatch::estimator
