#pragma once

#include <array>
#include <vector>

#include "estimator/identify/estimate.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/watched.h"

namespace framewatch {

/// What the windows since a time say about a parameter.
struct Change {
  double ratio = 0;  ///< of the baseline: -0.05 has lost a twentieth
  double std_error = 0;
  Time since{};  ///< start of the first window that points that way

  template <typename Archive>
  void archive(Archive& a) {
    a(ratio, std_error, since);
  }
};

/// Looks for lasting changes of parameters in the windows of one length: cumulative sums of
/// log-likelihood ratios between "changed by at least the smallest change that matters" and "as the
/// baseline, but for a spare" (docs/equations.md 39, 40). Windows of one sum do not overlap, so
/// their errors are nearly independent; kPhases sums, staggered, let no change wait for a window's
/// end. The likelihood is Student's, because standard errors come from 20 blocks, and a window that
/// claims less error than usual is not believed. A value that prior and noise pull far toward the
/// design does not count: that error is the same in every window.
class ChangeDetector {
 public:
  static constexpr int kPhases = 5;

  /// watched: theta order; what has no baseline is not. threshold: sum at which a change is
  /// believed; a false one has probability exp(-threshold) per window and direction.
  ChangeDetector(const Baseline& baseline, const std::vector<Watched>& watched, double threshold);

  /// What windows are judged against from now on; evidence stays.
  void set_baseline(const Baseline& baseline) { baseline_ = baseline; }

  /// Windows closer than a kPhases-th of their length are left out.
  void push(const WindowEstimate& estimate);

  /// The parameter is believed to have changed, and not yet to be back.
  bool changed(int parameter) const { return of(parameter).sign != 0; }
  /// Only while changed().
  Change change(int parameter) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(parameters_, used_until_);
  }

 private:
  struct Track {
    double sum = 0;
    double weight = 0, off = 0;  ///< of the windows since the sum was zero
    Time since{};

    template <typename Archive>
    void archive(Archive& a) {
      a(sum, weight, off, since);
    }
  };
  struct Parameter {
    Watched watched;
    double usual_error = 0;                          ///< running mean
    int sign = 0;                                    ///< of the change; 0: none
    int phase = 0;                                   ///< whose track found it
    std::array<std::array<Track, kPhases>, 2> away;  ///< downward, upward
    std::array<double, kPhases> back{};              ///< evidence that a change has gone

    template <typename Archive>
    void archive(Archive& a) {
      a(usual_error, sign, phase, away, back);
    }
  };
  const Parameter& of(int parameter) const {
    return parameters_[static_cast<std::size_t>(parameter)];
  }
  void judge(std::size_t p, int phase, const WindowEstimate& estimate);

  Baseline baseline_;
  double threshold_;
  std::vector<Parameter> parameters_;
  std::array<Time, kPhases> used_until_;
};

}  // namespace framewatch
