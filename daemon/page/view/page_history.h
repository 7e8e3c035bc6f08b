#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <framewatch/window_estimate_t.hpp>

#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// Behind the channels the motion of every frame, the base's first.
estimator::SampleSet with_every_floor(estimator::SampleSet set,
                                      const estimator::Structure& structure,
                                      const estimator::StoryResponse& response);

/// Collects calibrated instants for the page's next "motion" event: every stride-th one, so that at
/// most kMaxRate_hz go to the page.
class MotionRows {
 public:
  static constexpr double kMaxRate_hz = 200;
  static constexpr std::size_t kMaxRows = 200;  ///< of one event; more are left out and counted

  /// rate_hz: of the instants.
  explicit MotionRows(double rate_hz);

  void push(const estimator::SampleSet& instant);
  /// The collected rows as JSON, which are then forgotten; empty when there are none.
  std::string take();
  int stride() const { return stride_; }

 private:
  int stride_;
  std::string rows_;
  std::int64_t first_us_ = 0;
  std::size_t count_ = 0, left_out_ = 0;  ///< left_out_: ever
};

/// The last minutes, for a page that is opened late: two windows a second, the newest seconds of
/// motion, and of every parameter its newest value and boxplot, however old. Bounded: kMost_s, of
/// many parameters less.
class PageHistory {
 public:
  static constexpr double kMost_s = 300, kEvery_s = 0.5, kMotion_s = 10;
  static constexpr std::size_t kMaxValues = 100'000;  ///< of all windows together

  /// `config` must outlive this.
  explicit PageHistory(const estimator::PipelineConfig& config);

  void instant(const estimator::SampleSet& instant);
  /// What was stored before the page's server began; to be called before anything else comes.
  void restore(const std::vector<window_estimate_t>& estimates);
  /// A main window.
  void estimate(const window_estimate_t& estimate);
  /// One that came before without values and has them now. True when a row has changed.
  bool late(const window_estimate_t& estimate);
  /// A "motion" event; `at` counts up, per_s of it a second.
  void motion(const std::string& json, std::int64_t at, int per_s);

  /// {"rows": [[end_us, status, residual, rms of the base along x, along y, [values], [errors]]],
  /// "motion": [...]}. silent_s: since the newest sample.
  std::string json(double silent_s) const;
  /// Values that the newest window does not show, with the end of the window that did.
  std::string last_json() const;
  /// Boxplots, of parameters without new values the last ones; empty while there is none.
  std::string boxes_json() const;

 private:
  struct Row {
    std::int64_t end_us;
    std::int32_t status;
    double residual, base_rms[2];
    std::vector<double> value, error;  ///< NaN where the window does not show it
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
  window_estimate_t last_{};  ///< per parameter the newest value and boxplot; sequence unused
  std::vector<std::int64_t> last_us_;
  std::vector<bool> now_;
};

}  // namespace framewatch::daemon
