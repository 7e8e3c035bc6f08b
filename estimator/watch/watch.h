// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/structure/parameter_table.h"
#include "estimator/watch/amplitude_curve.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/change_book.h"
#include "estimator/watch/dependence.h"

namespace framewatch::estimator {

struct WatchOptions {
  double learn_s = 60;  ///< least total length of windows to learn a baseline from
  /// Least relevant changes of frame and panel stiffness, relative; 0: not watched.
  double least_change_k = 0.03, least_change_g = 0.2;
  double alarms_per_year = 1;  ///< accepted rate of false alarms, for the whole building
  /// Hours a year in which the building moves enough for windows to have values.
  double shaking_hours_per_year = 10;
  /// Length of the long windows, which watch weak motion, s; 0: no long windows.
  double quiet_window_s = 3600;
  /// Hours of long windows from which their baseline is learned.
  double quiet_learn_hours = 24;
  /// Conditions that baselines are corrected for: the temperature given by temperature(), and the
  /// amplitude of the motion.
  bool temperature = false, amplitude = true;
};

/// Returns the limits by which the parameters are watched: theta order.
std::vector<Watched> watched_parameters(const ParameterTable& table, const WatchOptions& options);

/// Watches frame and panel stiffness for changes against a baseline, in windows of every length at
/// once: short ones respond quickly, long ones detect small changes. The baseline is given or
/// learned first. The long windows of accumulated weak motion always learn a separate baseline,
/// because a building is stiffer when it hardly moves.
class Watch {
 public:
  /// baseline: parameters that it lacks are learned. windows_s: lengths by WindowEstimate::window;
  /// the next index is that of the long window, if there is one. model: see ChangeBook.
  Watch(const ParameterTable& table, const WatchOptions& options,
        const std::vector<double>& windows_s, const std::optional<Baseline>& baseline,
        const ChangeModel& model = {});

  /// Takes a window and returns the transitions of records that it causes, valid until the next
  /// call. Windows may come in any order. Ignores windows of one length that lie closer than a
  /// fifth of it, late ones (WindowEstimate::late) and those that are not complete yet.
  const std::vector<Alarm>& push(const WindowEstimate& estimate);
  /// Returns the record of a change of a parameter or of ChangeRecord::kEverything; null if it has
  /// no record.
  const ChangeRecord* record(int parameter) const { return book_.record(parameter); }

  /// Takes a reading of the thermometer.
  void temperature(Time time, double degc) { temperature_.push(time, degc); }

  /// Returns the parameters given or learned so far; null while there are no such parameters.
  const Baseline* baseline() const { return baseline_.known() > 0 ? &baseline_ : nullptr; }
  int parameters() const { return static_cast<int>(watched_.size()); }
  /// Returns true if the parameter is watched for changes.
  bool watched(std::size_t parameter) const { return watched_[parameter].least_change > 0; }
  /// Returns the baseline of the long windows; null while it is being learned.
  const Baseline* quiet_baseline() const { return quiet_known_ ? &quiet_baseline_ : nullptr; }
  /// Returns how the values of ordinary windows follow the amplitude.
  const AmplitudeCurve& curve(std::size_t parameter) const { return curves_[parameter]; }
  /// Returns how the quiet baseline follows the conditions.
  const Dependence& dependence() const { return dependence_; }
  /// Returns the progress of learning the quiet baseline, 0..1.
  double quiet_learned() const;
  /// Restarts learning the quiet baseline, because amplitudes are now measured differently.
  void forget_quiet();
  /// Returns the mean temperature at a time; NaN if there is no valid reading.
  double degc(Time now) const { return temperature_.mean(now, now); }
  const WatchOptions& options() const { return options_; }
  /// Returns the threshold of every detector, chosen for at most options().alarms_per_year.
  double threshold() const { return threshold_; }

  /// The state has two parts: what was learned, and the changes detected since. Reading the second
  /// part is optional. After reading, call resumed().
  void archive(auto& a) {
    archive_learned(a);
    archive_detection(a);
    if (a.kReading) resumed();
  }
  void archive_learned(auto& a) {
    bool temperature = options_.temperature, amplitude = options_.amplitude;
    a(temperature, amplitude, learner_, baseline_);
    a(quiet_known_, quiet_learner_, quiet_baseline_, dependence_);
    if (a.kReading) {
      const std::size_t n = watched_.size();
      const bool fits = (baseline_.is_of(0) || baseline_.is_of(n)) &&
                        (!quiet_known_ || (quiet_baseline_.is_of(n) && dependence_.is_of(n)));
      if (!fits) return a.refuse();
      begin();
      if (quiet_known_) begin_quiet();
      other_conditions_ = temperature != options_.temperature || amplitude != options_.amplitude;
    }
  }
  void archive_detection(auto& a) { a(temperature_, book_, recent_, usual_); }
  /// Restarts learning the quiet baseline if it was learned for other conditions than these options
  /// correct for.
  void resumed() {
    if (std::exchange(other_conditions_, false)) forget_quiet();
  }

 private:
  /// The sum of logarithms of an amplitude.
  struct Usual {
    std::int64_t count = 0;
    double sum = 0;

    void archive(auto& a) {
      a.within(count, 0, a.kMaxCount);
      a.finite(sum);
    }
  };
  void begin();
  void begin_quiet();
  bool bending_known(const WindowEstimate& estimate) const;
  void learn(const WindowEstimate& estimate);
  void learn_quiet(const WindowEstimate& estimate);
  Dependence::Expected expected(std::size_t parameter, double degc) const;
  /// Effect of the conditions on an intact element's value, relative to the baseline.
  struct Intact {
    double ratio;      ///< most likely
    double low, high;  ///< credible range
  };
  Explained correct(WindowEstimate& estimate, std::size_t parameter, double baseline,
                    const Intact& intact) const;
  bool is_shorter(const WindowEstimate& estimate) const;  ///< than the main window
  Intact intact(std::size_t parameter, const WindowEstimate& estimate, double degc) const;
  /// Returns the estimate corrected to the conditions of its baseline.
  const WindowEstimate& corrected(const WindowEstimate& estimate);
  void remember_amplitudes(const WindowEstimate& estimate);
  double recovering(std::size_t parameter, Time now) const;
  /// Returns the estimate without frame stiffnesses that are too uncertain.
  const WindowEstimate& certain(const WindowEstimate& estimate);
  const WindowEstimate& corrected_quiet(const WindowEstimate& estimate);
  void find_doubted(const WindowEstimate& estimate);

  WatchOptions options_;
  std::vector<Watched> watched_;      ///< theta order
  std::vector<std::size_t> bending_;  ///< parameters krx, kry
  std::vector<double> windows_s_;
  double threshold_;
  BaselineLearner learner_;
  Baseline baseline_;
  MeanTemperature temperature_;
  std::vector<AmplitudeCurve> curves_;   ///< of baseline_
  std::vector<RecentAmplitude> recent_;  ///< of main windows
  std::vector<Usual> usual_;             ///< while the quiet baseline is being learned
  bool quiet_known_ = false;
  DependenceLearner quiet_learner_;
  Baseline quiet_baseline_;
  Dependence dependence_;
  ChangeBook book_;
  WindowEstimate corrected_;
  std::vector<std::uint8_t> stiffness_of_frames_;  ///< flags, theta order
  WindowEstimate certain_;
  std::vector<Explained> explained_;   ///< in the newest window
  std::vector<std::uint8_t> doubted_;  ///< 1: a gain is not credible now
  std::vector<Alarm> none_;
  bool other_conditions_ = false;  ///< archive_learned() read a state with other options
};

}  // namespace framewatch::estimator
