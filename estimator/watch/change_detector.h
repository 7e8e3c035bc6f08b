// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/change_record.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Finds lasting changes of parameters in the windows of one length. It keeps cumulative sums of
/// log-likelihood ratios between "changed by 1, 2, 4 or 16 times the least relevant change" and
/// "equal to the baseline within the tolerance" (docs/equations.md 39, 40).
///
/// Windows of one sum do
/// not overlap, so their errors are nearly independent. kPhases staggered sums find a change before
/// a whole further window has passed. The likelihood is Student's, because standard errors come
/// from 20 blocks; a standard error below the usual one is replaced by the usual one. Values with a
/// large bias by prior and noise do not count: every window has the same bias. A gain needs kGain
/// times the evidence of a loss, because an earthquake causes losses and an apparent gain is mostly
/// a model error or a recovery. Late windows, older than those before, have a separate sum.
class ChangeDetector {
 public:
  static constexpr int kPhases = 5;
  static constexpr int kSizes = 4;
  /// A sum overshoots the threshold by so much that false alarms are at least exp(kOvershoot) times
  /// rarer than Wald's bound (docs/equations.md 41).
  static constexpr double kOvershoot = 1.5;
  static constexpr double kGain = 2;

  /// watched: theta order; parameters without a baseline are not watched. threshold: the sum at
  /// which a change is accepted. A false one has a probability below exp(-threshold - kOvershoot)
  /// per window, direction and size.
  ChangeDetector(const Baseline& baseline, const std::vector<Watched>& watched, double threshold);

  /// Replaces the baseline and keeps the sums.
  void set_baseline(const Baseline& baseline) { baseline_ = baseline; }
  const Baseline& baseline() const { return baseline_; }

  /// Returns true if push() judges this window. It skips windows closer than a kPhases-th of their
  /// length.
  bool takes(const WindowEstimate& estimate) const { return free_phase(estimate) >= 0; }
  /// Judges a window. held: by parameter; 1: skip the parameter; empty: judge all.
  void push(const WindowEstimate& estimate, const std::vector<std::uint8_t>& held = {});
  /// Clears the evidence and the change of a parameter.
  void forget(std::size_t parameter);
  /// Tolerates a lasting deviation of the parameter, relative, in addition to Watched::tolerance.
  void tolerate(std::size_t parameter, double ratio) { parameters_[parameter].tolerated = ratio; }

  /// Returns true from the acceptance of a change of the parameter to its end.
  bool changed(int parameter) const { return of(parameter).sign != 0; }
  /// Precondition: changed().
  Change change(int parameter) const;
  /// Returns the direction of the change: -1 a loss, 1 a gain, 0 no change.
  int sign(int parameter) const { return of(parameter).sign; }
  /// Returns the largest sum for a loss (-1) or a gain (1), over its threshold.
  double evidence(int parameter, int sign) const;
  /// Returns the running mean of the standard errors of the parameter's values, relative to the
  /// baseline; 0: no values yet.
  double usual_error(int parameter) const { return of(parameter).usual_error; }

  void archive(auto& a) { a(parameters_, used_until_); }

 private:
  struct Track {
    double sum = 0;
    double weight = 0, off = 0;  ///< of the windows since the sum was zero
    Time since{};

    void archive(auto& a) {
      a.finite(sum, weight, off);
      a(since);
    }
  };
  static constexpr int kSeries = kPhases + 1;  ///< the last one is for late windows
  using Tracks = std::array<Track, kSizes>;
  struct Parameter {
    Watched watched;
    double usual_error = 0;                           ///< running mean
    std::int64_t errors = 0;                          ///< in it
    int sign = 0;                                     ///< of the change; 0: no change
    int phase = 0, size = 0;                          ///< whose track found it
    double tolerated = 0;                             ///< set before every window
    std::array<std::array<Tracks, kSeries>, 2> away;  ///< downward, upward
    std::array<double, kSeries> back{};               ///< evidence that a change has ended

    void archive(auto& a) {
      a.finite(usual_error, back);
      a.within(errors, 0, a.kMaxCount);
      a.within(sign, -1, 1);
      a.within(phase, 0, kSeries - 1);
      a.within(size, 0, kSizes - 1);
      a(away);
    }
  };
  const Parameter& of(int parameter) const {
    return parameters_[static_cast<std::size_t>(parameter)];
  }
  int free_phase(const WindowEstimate& estimate) const;
  void judge(std::size_t p, int phase, const WindowEstimate& estimate);

  Baseline baseline_;
  double threshold_;
  std::vector<Parameter> parameters_;
  std::array<Time, kSeries> used_until_;
};

}  // namespace framewatch::estimator
