#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/watch/amplitude_curve.h"

namespace framewatch::estimator {

/// A window behind strong motion: how far an element's stiffness is from that of the intact element
/// at the same amplitude. Ratios are relative to the baseline.
struct RecoveryWindow {
  Time start{}, end{};
  double off = 0;        ///< value over the intact one at this amplitude, less 1
  double std_error = 0;  ///< > 0: what differs from window to window
  /// Standard error of what all windows of a source have in common: that of the baseline. >= 0.
  double baseline_error = 0;
  /// Standard error of what the amplitude makes of the intact value; > 0 above the amplitudes of
  /// the baseline, < 0 below: where the curve is too steep, `off` is wrong the other way there.
  double amplitude_error = 0;
  std::size_t source = 0;  ///< 0: ordinary windows, 1: long windows, which have another baseline
};

/// Of a value (SI) with its standard error and the rms deformation of its window. baseline,
/// baseline_error: SI, of the intact element. curve: of its amplitudes; one that is not known
/// counts as AmplitudeCurve::kUsualPerLog about usual_amplitude_m > 0. Precondition: value,
/// std_error, baseline and amplitude_m are > 0.
RecoveryWindow recovery_window(Time start, Time end, double value, double std_error,
                               double amplitude_m, double baseline, double baseline_error,
                               const AmplitudeCurve& curve, double usual_amplitude_m);

enum class RecoveryVerdict {
  not_known,   ///< RecoveryLaw::reason says why
  recovering,  ///< the stiffness comes back, and may do so wholly
  lasting,     ///< some of the loss stays: that all comes back within a year is excluded
  recovered    ///< less than the least relevant change is left
};

/// Why nothing can be said yet.
enum class RecoveryReason {
  none,
  few_windows,  ///< fewer than Recovery::kFewest
  short_time,   ///< windows cover too little of the logarithm of time
  inexact,      ///< windows scatter too much
  amplitude,    ///< what the amplitude does to the intact element is not known well enough
  baseline      ///< the stiffness before is not known well enough
};

/// The loss after strong motion: loss(t) = loss(t_ref) - slope log10(t / t_ref). Losses are shares
/// of the intact stiffness, positive; errors are standard errors.
struct RecoveryLaw {
  double time_s = 0;                       ///< end of the newest window, since the strong motion's
  double loss = 0, std_error = 0;          ///< then
  double slope = 0, slope_error = 0;       ///< per decade of time; > 0: it recovers
  double first_s = 0;                      ///< of the first windows
  double first_loss = 0, first_error = 0;  ///< by the windows then alone
  double later_s = 0;                      ///< a day; later a month, then a year
  double later_loss = 0, later_error = 0;  ///< expected then, if the law holds on
  double later_low = 0, later_high = 0;    ///< Recovery::kErrors errors to either side, low >= 0
  double stays = 0;                        ///< of a lasting loss: at least so much after a year
  RecoveryVerdict verdict = RecoveryVerdict::not_known;
  RecoveryReason reason = RecoveryReason::few_windows;
};

/// Tells whether a loss of stiffness after strong motion is lasting, or only the fatigue that
/// frames and rock recover from with the logarithm of time ("slow dynamics": TenCate, Smith, Guyer,
/// Phys. Rev. Lett. 85, 2000, 1020; Snieder, Sens-Schoenfelder, Wu, Geophys. J. Int. 208, 2017, 1).
/// Windows are summed by the logarithm of the time since the motion, so that the state is bounded,
/// and the law is fitted to these means by weighted least squares, with the errors of baseline and
/// amplitude curve as unknowns that all windows have in common. Only the newest part of the record
/// that one law fits is used: a recovery that has stopped is not carried on. docs/equations.md,
/// recovery.
class Recovery {
 public:
  static constexpr double kErrors = 3;       ///< standard errors at which something is excluded
  static constexpr std::size_t kFewest = 4;  ///< windows that a law needs
  static constexpr double kMinSpan = 0.5;    ///< decades of time that a law needs
  static constexpr double kYear_s = 31'557'600;
  static constexpr double kMotion_s = 900;  ///< no strong motion is longer
  /// The finding is renewed so long after the strong motion, s.
  static constexpr std::array<double, 3> kRenew_s{600, 3600, 86400};

  /// least_change > 0: the least relevant loss, a share of the stiffness.
  explicit Recovery(double least_change = 0.03) : least_change_(least_change) {}

  /// Strong motion has ended; what was before is forgotten.
  void begin(Time end_of_motion);
  bool active() const { return active_; }
  Time began() const { return began_; }
  /// Whether a change that is seen since then may be of this strong motion: from kMotion_s before
  /// its end to the first renewal. Later ones have another cause, and no law.
  bool is_of(Time since) const;
  /// Windows that the law is made of.
  int windows() const;
  /// Windows that begin before the end of the strong motion, or overlap the last one of their
  /// source, are left out.
  void push(const RecoveryWindow& window);
  /// As of the newest window.
  RecoveryLaw law() const;
  /// The loss at a time since the strong motion's end that windows cover, by those within a factor
  /// 2 of it; count 0: there are none.
  struct Loss {
    double loss = 0, std_error = 0;
    int count = 0;
  };
  Loss loss_at(double time_s) const;
  /// True once for each of kRenew_s, when `now` is beyond it and a window has come since.
  bool renewal_due(Time now);

  template <typename Archive>
  void archive(Archive& a) {
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

    template <typename Archive>
    void archive(Archive& a) {
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
