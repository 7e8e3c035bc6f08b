#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/change_record.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Looks for lasting changes of parameters in the windows of one length: cumulative sums of
/// log-likelihood ratios between "changed by 1, 2, 4 or 16 times the least relevant change" and
/// "equal to the baseline within the tolerance" (docs/equations.md 39, 40). Windows of one sum do
/// not overlap, so their errors are nearly independent; kPhases staggered sums find a change before
/// a whole further window has passed. The likelihood is Student's, because standard errors come
/// from 20 blocks; a standard error below the usual one is replaced by that. A value that prior and
/// noise bias far does not count: that error is the same in every window. A gain needs kGain times
/// the evidence of a loss: what an earthquake does to a building is a loss, and what seems to be a
/// gain is mostly an error of the model or a recovery. Windows that come late, older than those
/// before, have a sum of their own.
class ChangeDetector {
 public:
  static constexpr int kPhases = 5;
  static constexpr int kSizes = 4;
  /// A sum that crosses the threshold has crossed it by so much that false ones are at least
  /// exp(kOvershoot) times rarer than Wald's bound (docs/equations.md 41).
  static constexpr double kOvershoot = 1.5;
  static constexpr double kGain = 2;

  /// watched: theta order; parameters without a baseline are not watched. threshold: sum at which a
  /// change is accepted; a false one has a probability below exp(-threshold - kOvershoot) per
  /// window, direction and size.
  ChangeDetector(const Baseline& baseline, const std::vector<Watched>& watched, double threshold);

  /// The baseline from now on; the sums stay.
  void set_baseline(const Baseline& baseline) { baseline_ = baseline; }
  const Baseline& baseline() const { return baseline_; }

  /// Whether push() judges this one: windows closer than a kPhases-th of their length are left out.
  bool takes(const WindowEstimate& estimate) const { return free_phase(estimate) >= 0; }
  /// held: by parameter, 1: the window says nothing of it; empty: it is of all.
  void push(const WindowEstimate& estimate, const std::vector<std::uint8_t>& held = {});
  /// Forgets the evidence of a parameter, and its change.
  void forget(std::size_t parameter);
  /// A lasting deviation of the parameter, relative, that is no change, beside Watched::tolerance.
  void tolerate(std::size_t parameter, double ratio) { parameters_[parameter].tolerated = ratio; }

  /// A change of the parameter has been accepted, and its end not yet.
  bool changed(int parameter) const { return of(parameter).sign != 0; }
  /// Only while changed().
  Change change(int parameter) const;
  /// The direction of the change: -1 a loss, 1 a gain, 0 none.
  int sign(int parameter) const { return of(parameter).sign; }
  /// The largest sum that points to a loss (-1) or a gain (1), over what is asked for that.
  double evidence(int parameter, int sign) const;
  /// Running mean of the standard errors of the parameter's values, relative to the baseline; 0:
  /// there was none.
  double usual_error(int parameter) const { return of(parameter).usual_error; }

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
      a.finite(sum, weight, off);
      a(since);
    }
  };
  static constexpr int kSeries = kPhases + 1;  ///< the last one of late windows
  using Tracks = std::array<Track, kSizes>;
  struct Parameter {
    Watched watched;
    double usual_error = 0;                           ///< running mean
    std::int64_t errors = 0;                          ///< in it
    int sign = 0;                                     ///< of the change; 0: none
    int phase = 0, size = 0;                          ///< whose track found it
    double tolerated = 0;                             ///< set again before every window
    std::array<std::array<Tracks, kSeries>, 2> away;  ///< downward, upward
    std::array<double, kSeries> back{};               ///< evidence that a change has gone

    template <typename Archive>
    void archive(Archive& a) {
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
