#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {

/// The largest drift of a story in one of its frames.
struct StoryPeak {
  double drift_ratio = 0;  ///< |story drift| over story height
  int frame = -1;          ///< in which it was; -1: no frame of the story could be measured
  std::int64_t time_us = 0;
};

/// What the building went through from its first to its last motion above a threshold.
struct Shake {
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time
  bool over = false;
  double base_accel_mps2 = 0, floor_accel_mps2 = 0;  ///< peaks, absolute, without offsets
  std::array<double, 2> base_shear_n{};  ///< peaks along x and y: the floors' inertia; 0: not known
  std::vector<StoryPeak> story;          ///< from the lowest

  /// The largest drift ratio of all stories.
  double drift_ratio() const;
};

/// Follows the calibrated motion and keeps the peaks of the newest shake and of the strongest one.
/// Displacements are accelerations over the base's, integrated twice above the estimator's
/// high_pass_hz: high-passed, then the response of an oscillator of that frequency
/// (docs/equations.md (12)). Sensor time only; a fixed amount of memory.
class Shaking {
 public:
  static constexpr double kMoves_mps2 = 0.05;  ///< less is no shaking; nor is what noise can be
  static constexpr double kCalm_s = 10;        ///< without motion: the shake is over

  /// Precondition: problems(config) is empty. `config` must outlive this.
  explicit Shaking(const estimator::PipelineConfig& config);

  void push(const estimator::SampleSet& instant);

  /// Null while there was none.
  const Shake* newest() const { return newest_ ? &*newest_ : nullptr; }
  /// By drift ratio, the newest one included.
  const Shake* strongest() const;
  std::int64_t first_us() const { return first_us_; }  ///< since when it is followed; 0: not yet

 private:
  /// Second-order filters of one axis: its acceleration without offset, and its displacement.
  struct Axis {
    double in[2]{}, high[2]{}, relative_in[2]{}, relative_high[2]{}, displacement[2]{};
    int settled = 0;  ///< instants since it began
  };
  struct Filter {
    double gain, a1, a2, high_gain, over_w2;
    double high(double x, double in[2], double out[2]) const;
    double integrated(double x, double x1, double x2, double out[2]) const;
  };
  void reset();
  void advance(std::size_t axis, double accel, double base);
  void note(std::int64_t time_us);
  bool moves() const;

  const estimator::PipelineConfig& config_;
  Filter filter_;
  int settle_;  ///< instants
  double threshold_mps2_;
  std::vector<int> axis_of_;  ///< by degree of freedom
  std::vector<Axis> axes_;
  std::vector<double> accel_, displacement_;  ///< by axis, NaN where not known
  std::int64_t last_index_ = -1, first_us_ = 0;
  std::optional<Shake> newest_, strongest_;
};

}  // namespace framewatch::daemon
