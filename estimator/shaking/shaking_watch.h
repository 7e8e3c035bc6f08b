#pragma once

#include <cstddef>
#include <vector>

#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/shaking.h"
#include "estimator/watch/baseline.h"

namespace framewatch::estimator {

/// Notices strong motion, follows its peaks, and says at its end what the building went through.
/// Bounded: a motion of over kLongest_s is divided.
class ShakingWatch {
 public:
  static constexpr double kShortest_s = 0.5, kLongest_s = 900;

  ShakingWatch(const PipelineConfig& config, const ShakingOptions& options);

  /// One calibrated instant. True once a strong motion has ended; it is in ended() then.
  bool push(const SampleSet& set, const Baseline* baseline);
  /// An estimate of the main window, late ones too.
  void push(const WindowEstimate& estimate);
  /// The gap of simulation and measurement.
  void gap(double nrmse);
  bool active() const { return active_; }
  bool began() const { return began_; }  ///< at the last push of an instant
  const Shaking& ended() const { return ended_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(active_, start_, last_, response_, peak_, before_, first_, final_, after_, late_, during_, gap_);
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
  void finish(Time now, const Baseline* baseline);

  std::size_t elements_;
  ShakingOptions options_;
  std::vector<std::size_t> trigger_axes_;  ///< of the base; all, where it has none
  StoryResponse response_;
  PeakResponse peak_;
  bool active_ = false, began_ = false;
  Time start_{}, last_{};
  double gap_ = 0;
  Windows before_, first_, final_, after_;
  Windows late_;  ///< those before first_ that came late
  BaselineLearner during_;
  Shaking ended_;
};

}  // namespace framewatch::estimator
