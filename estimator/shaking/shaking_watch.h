#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/shaking.h"
#include "estimator/watch/baseline.h"

namespace framewatch::estimator {

/// Notices strong motion, follows its peaks, and says at its end what the building went through.
/// Bounded: a motion of over kLongest_s is divided. A time without samples is no calm: only heard
/// calm ends strong motion.
class ShakingWatch {
 public:
  static constexpr double kShortest_s = 0.5, kLongest_s = 900;
  /// A time without samples that is told; in a shorter one no story drifts far.
  static constexpr double kUnheard_s = 0.5;
  static constexpr std::size_t kMaxUnheard = 8;  ///< of one strong motion; further ones join

  ShakingWatch(const PipelineConfig& config, const ShakingOptions& options);

  /// One calibrated instant. True once a strong motion has ended; it is in ended() then.
  bool push(const SampleSet& set, const Baseline* baseline);
  /// An estimate of the main window, late ones too.
  void push(const WindowEstimate& estimate);
  /// The program was started anew and has every sample up to `known`; samples may be missing from
  /// there to the next instant. raw: it has those that the program before had heard last.
  void came_up(Time known, bool raw);
  /// The gap of simulation and measurement.
  void gap(double nrmse);
  bool active() const { return active_; }
  bool began() const { return began_; }  ///< at the last push of an instant
  const Shaking& ended() const { return ended_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(active_, start_, last_, response_, peak_, before_, first_, final_, after_, late_, during_,
      gap_);
    a(heard_any_, heard_, unheard_);
    a.within(unheard_count_, 0, static_cast<double>(kMaxUnheard));
    a.finite(unheard_calm_s_);
  }

 private:
  /// The newest of the windows that were put in, at most `most`, which do not overlap.
  struct Windows {
    std::size_t most = 3, count = 0;
    std::vector<Time> start, end;
    std::vector<double> value, std_error;  ///< windows x parameters; NaN: not shown

    Windows(std::size_t most, std::size_t parameters);
    bool overlaps(const WindowEstimate& e) const { return count > 0 && e.start < end[count - 1]; }
    void put(const WindowEstimate& e, std::size_t parameters);
    WindowMean mean(std::size_t parameter, std::size_t parameters) const;

    template <typename Archive>
    void archive(Archive& a) {
      a.within(count, 0, static_cast<double>(most));
      a(start, end, value, std_error);
    }
  };
  void begin(Time now);
  void push_late(const WindowEstimate& estimate);
  WindowMean first_mean(std::size_t parameter) const;
  bool end(Time now, const Baseline* baseline);
  void finish(Time now, const Baseline* baseline);
  bool look_for_unheard(Time now);
  void add_unheard(const Unheard& unheard);

  std::size_t elements_;
  ShakingOptions options_;
  std::vector<std::size_t> trigger_axes_;  ///< of the base; all, where it has none
  StoryResponse response_;
  PeakResponse peak_;
  bool active_ = false, began_ = false;
  Time start_{}, last_{};
  bool heard_any_ = false;
  Time heard_{};                              ///< the newest instant
  std::array<Unheard, kMaxUnheard> unheard_;  ///< while calm the newest one alone
  std::size_t unheard_count_ = 0;
  double unheard_calm_s_ = 0;  ///< of the time since last_
  struct CameUp {
    Time known{};
    bool raw = false;
  };
  std::optional<CameUp> came_up_;  ///< of this process, so no state
  double gap_ = 0;
  Windows before_, first_, final_, after_;
  Windows late_;  ///< those before first_ that came late
  BaselineLearner during_;
  Shaking ended_;
};

}  // namespace framewatch::estimator
