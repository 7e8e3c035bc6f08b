// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <framewatch/window_estimate_t.hpp>

#include "daemon/page/view/newest_values.h"
#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// Appends the motion of every frame to the channels of `set`, the base first.
estimator::SampleSet with_every_floor(estimator::SampleSet set,
                                      const estimator::Structure& structure,
                                      const estimator::StoryResponse& response);

/// Collects calibrated instants for the next "motion" event of the page. Keeps every stride-th
/// instant, so that the page receives at most kMaxRate_hz.
class MotionRows {
 public:
  static constexpr double kMaxRate_hz = 200;
  static constexpr std::size_t kMaxRows = 200;  ///< in one event; further rows are counted only

  /// rate_hz: rate of the instants.
  explicit MotionRows(double rate_hz);

  void push(const estimator::SampleSet& instant);
  /// Returns the collected rows as JSON and forgets them. Returns an empty text without rows.
  std::string take();
  int stride() const { return stride_; }

 private:
  int stride_;
  std::string rows_;
  std::int64_t first_us_ = 0;
  std::size_t count_ = 0, left_out_ = 0;  ///< left_out_: ever
};

/// Empties the values and boxplots of an estimate and makes room for those of `parameters`.
void clear_values(window_estimate_t& estimate, std::size_t parameters);

/// Holds the last minutes for a page that is opened late: two windows a second, the newest seconds
/// of motion, and the newest value and boxplot of each parameter. Keeps kMost_s of windows, fewer
/// when the model has many parameters.
class PageHistory {
 public:
  static constexpr double kMost_s = 300, kEvery_s = 0.5, kMotion_s = 10;
  static constexpr std::size_t kMaxValues = 100'000;  ///< in all windows together

  /// `config` must outlive this.
  explicit PageHistory(const estimator::PipelineConfig& config);

  void instant(const estimator::SampleSet& instant);
  /// Loads stored estimates. Call it before the other functions.
  void restore(const std::vector<window_estimate_t>& estimates);
  /// Takes an estimate of the main window.
  void estimate(const window_estimate_t& estimate);
  /// Takes an estimate that came before without values. Returns true when a row has changed.
  bool late(const window_estimate_t& estimate);
  /// Takes a "motion" event. at: time in ticks of 1/per_s seconds.
  void motion(const std::string& json, std::int64_t at, int per_s);

  /// Returns {"rows": [[end_us, status, residual, rms of the base along x, along y, [values],
  /// [errors]]], "motion": [...]}. silent_s: since the newest sample.
  std::string json(double silent_s) const;
  /// Returns the values that the newest window lacks, each with the end of its window.
  std::string last_json() const;
  NewestValues newest() const { return {last_.value, last_.std_error, last_us_}; }
  /// Returns the last boxplot of each parameter; an empty text before the first.
  std::string boxes_json() const;

 private:
  struct Row {
    std::int64_t end_us;
    std::int32_t status;
    double residual, base_rms[2];
    std::vector<double> value, error;  ///< NaN where the window has no value
  };
  struct Motion {
    std::int64_t at;
    std::string json;
  };
  void keep_last(const window_estimate_t& estimate);

  const estimator::PipelineConfig& config_;
  std::deque<Row> rows_;
  std::deque<Motion> motion_;
  double sum_[2]{}, squares_[2]{};
  std::int64_t count_[2]{};
  window_estimate_t last_{};  ///< newest value and boxplot of each parameter; sequence unused
  std::vector<std::int64_t> last_us_;
  std::vector<bool> now_;
};

}  // namespace framewatch::daemon
