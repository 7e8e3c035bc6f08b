// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/story_drift.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/change_point.h"
#include "estimator/watch/change_record.h"

namespace framewatch::estimator {

struct ShakingOptions {
  /// The base moves strongly above this distance from its mean. Without a sensor on the base all
  /// axes count.
  double trigger_mps2 = 0.1;
  double quiet_s = 20;  ///< strong motion ends after so long below the trigger
};

/// The source of the stiffness before the shaking.
enum class BeforeFrom { none, baseline, windows_before, first_windows };

/// A stiffness before, during and after strong motion; count 0: not known.
struct ShakenStiffness {
  WindowMean before, during, after;
  BeforeFrom before_from = BeforeFrom::none;
  bool free = false;      ///< `after` is of windows behind the strong motion; else of its last ones
  bool watched = false;   ///< changes are detected against a baseline: only a record is a change
  ChangeRecord record{};  ///< of its change; id 0: no change

  /// Returns true if the size of the change is known.
  bool known() const {
    return record.id != 0 ? record.measured() : before.count > 0 && after.count > 0;
  }
  /// Returns the change; the record's if it has a number.
  double ratio() const {
    return record.measured() ? record.change.ratio : after.value / before.value - 1;
  }
  double std_error() const;  ///< of ratio()
};

/// The cause of an interruption.
enum class UnheardWhy {
  no_samples,     ///< the program ran and no sample came
  restart,        ///< the program was restarted; raw samples fill the time before
  restart_no_raw  ///< the program was restarted without raw samples of the time before
};

/// An interruption: a time without samples.
struct Unheard {
  Time from{}, to{};        ///< the last instant before it, the first one behind it
  bool from_known = false;  ///< false: there are no samples before `to`
  UnheardWhy why = UnheardWhy::no_samples;

  void archive(auto& a) {
    a(from, to, from_known);
    a.within(why, 0, static_cast<double>(UnheardWhy::restart_no_raw));
  }
};

/// One strong motion as the sensors and the windows recorded it.
struct Shaking {
  Time start{}, end{};  ///< first and last instant above the trigger
  Time found{};         ///< when its end was certain
  PeakResponse peak;
  std::vector<ShakenStiffness> stiffness;  ///< of the stiffness half of theta
  double gap_nrmse = 0;       ///< largest NRMSE of the gap meanwhile; NaN: not simulated
  DriftKnowledge known = {};  ///< at the end
  /// Interruptions, in order of time: those within the motion, and those that ended less than
  /// ShakingOptions::quiet_s before `start`, because it may have begun in them. Peaks exclude them.
  std::vector<Unheard> unheard = {};
  double drift_settles_s = 0;  ///< drifts are not known for so long after each interruption
};

/// Detects strong motion, follows its peaks and reports at its end how the building responded. A
/// motion longer than kLongest_s is divided. Interruptions do not count as calm: only recorded calm
/// ends strong motion.
class ShakingWatch {
 public:
  static constexpr double kShortest_s = 0.5, kLongest_s = 900;
  /// The shortest interruption that is recorded; in a shorter one no story drifts far.
  static constexpr double kUnheard_s = 0.5;
  static constexpr std::size_t kMaxUnheard = 8;  ///< in one strong motion; further ones are merged

  ShakingWatch(const PipelineConfig& config, const ShakingOptions& options);

  /// Takes one calibrated instant. Returns true when a strong motion has ended; ended() then
  /// returns it.
  bool push(const SampleSet& set, const Baseline* baseline);
  /// Takes an estimate of the main window, including late ones.
  void push(const WindowEstimate& estimate);
  /// Marks a restart of the program. It has every sample up to `known`; samples may be missing from
  /// there to the next instant. raw: raw samples fill the time before the restart.
  void came_up(Time known, bool raw);
  /// Takes the gap between simulation and measurement.
  void push_gap(double nrmse);
  bool active() const { return active_; }
  bool began() const { return began_; }  ///< set by the last push of an instant
  const Shaking& ended() const { return ended_; }

  void archive(auto& a) {
    a(active_, start_, last_, response_, peak_, before_, first_, final_, after_, late_, during_,
      gap_);
    a(heard_any_, heard_, unheard_);
    a.within(unheard_count_, 0, static_cast<double>(kMaxUnheard));
    a.finite(unheard_calm_s_);
  }

 private:
  /// The newest windows that do not overlap, at most `most`.
  struct Windows {
    std::size_t most = 3, count = 0;
    std::vector<Time> start, end;
    std::vector<double> value, std_error;  ///< windows x parameters; NaN: not observable

    Windows(std::size_t most, std::size_t parameters);
    bool overlaps(const WindowEstimate& e) const { return count > 0 && e.start < end[count - 1]; }
    void put(const WindowEstimate& e, std::size_t parameters);
    WindowMean mean(std::size_t parameter, std::size_t parameters) const;

    void archive(auto& a) {
      a.within(count, 0, static_cast<double>(most));
      a(start, end, value, std_error);
    }
  };
  void begin(Time now);
  void push_late(const WindowEstimate& estimate);
  WindowMean first_mean(std::size_t parameter) const;
  bool end(Time now, const Baseline* baseline);
  void finish(Time now, const Baseline* baseline);
  bool note_interruption(Time now);
  void add_unheard(const Unheard& unheard);

  std::size_t elements_;
  ShakingOptions options_;
  std::vector<std::size_t> trigger_axes_;  ///< of the base, or all axes if the base has no sensor
  StoryResponse response_;
  PeakResponse peak_;
  bool active_ = false, began_ = false;
  Time start_{}, last_{};
  bool heard_any_ = false;
  Time heard_{};                              ///< the newest instant
  std::array<Unheard, kMaxUnheard> unheard_;  ///< while calm only the newest one
  std::size_t unheard_count_ = 0;
  double unheard_calm_s_ = 0;  ///< of the time since last_
  struct CameUp {
    Time known{};
    bool raw = false;
  };
  std::optional<CameUp> came_up_;  ///< of this process, so not archived
  double gap_ = 0;
  Windows before_, first_, final_, after_;
  Windows late_;  ///< late windows before first_
  BaselineLearner during_;
  Shaking ended_;
};

}  // namespace framewatch::estimator
