#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "estimator/gap/axis_correction.h"
#include "estimator/gap/driving_axes.h"
#include "estimator/gap/gap_alarm.h"
#include "estimator/gap/gap_meter.h"
#include "estimator/gap/measured_inputs.h"
#include "estimator/gap/model_learner.h"
#include "estimator/gap/noise_path.h"
#include "estimator/gap/running_model.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/sensors.h"
#include "estimator/watch/baseline.h"

namespace framewatch::estimator {

/// Simulates the current model under the measured inputs continuously and gives the gap to
/// what the axes above measure. docs/gap.md, docs/equations.md (45), (46). What drives the
/// model is measured_inputs(): a motion of the base that no axis shows is a gap.
class GapMonitor {
 public:
  /// axes: with the remaining fractions of their delays (Pipeline::axes). model: none: it is
  /// learned; stories of a group then keep their shares of the design.
  GapMonitor(const PipelineConfig& config, const std::vector<SensorAxis>& axes,
             const GapOptions& options, const std::optional<GapModel>& model);

  /// Replaces the model and begins anew. Not bounded in time, and allocates.
  void adopt(const GapModel& model);
  bool has_model() const { return current_.has_value(); }

  /// An estimate of the main window, to learn a model from, and to tell which stiffness a gap comes
  /// from. believed: values of the parameters that windows do not show, theta order.
  void learn(const WindowEstimate& estimate, const Eigen::VectorXd& believed);
  /// One calibrated instant; noise_density of each axis, m/s^2/sqrt(Hz), or none. Once a second,
  /// while there is something to compare, the gap of the last window; valid until the next call.
  const GapWindow* push(const SampleSet& set, const std::vector<double>& noise_density);
  /// The alarm that began or ended at the last push(), or null.
  const GapNews* news() const { return news_; }

  template <typename Archive>
  void archive(Archive& a) {
    bool modelled = has_model();
    std::vector<double> theta;
    if (modelled) theta.assign(theta_.begin(), theta_.end());
    a(learner_, alarm_, since_gap_, named_, driving_, modelled);
    a.any_size(theta);
    if constexpr (Archive::kReading) {
      take_inputs();
      for (const double value : theta)
        if (!(value > 0 && value < a.kMax)) return a.refuse();
      if (modelled && !has_model() && theta.size() == static_cast<std::size_t>(table_.size()))
        adopt(model_of(Eigen::Map<const Eigen::VectorXd>(theta.data(), table_.size())));
    }
    a(theta_error_);
    if (modelled && has_model()) a(*current_);
  }

 private:
  /// One model and everything that depends on it.
  struct Current {
    Current(const GapMonitor& monitor, const GapModel& model);

    AxisCorrection correction;
    DriftControlledIntegrator filter;
    RunningModel running;
    NoisePath noise;
    GapMeter meter;
    SensorClock::duration delay;  ///< of what is compared
    std::vector<double> held;     ///< ring of instants x axes: filtered, NaN where not valid
    int newest = 0;
    double settled_s = 0;
    std::int64_t expected_index = -1;

    template <typename Archive>
    void archive(Archive& a) {
      a(correction, filter, running, noise, meter, held);
      a.within(newest, 0, RunningModel::kDelay);  // of kDelay + 1 instants
      a.finite(settled_s);
      a.within(expected_index, -1, a.kMaxCount);
    }
  };
  /// Delay of every input's samples beside the axes' own, of all that show it; instants.
  Eigen::VectorXd late(const std::vector<double>& rest) const;
  /// The inputs from the axes that drive now; the model that runs begins anew with them.
  void take_inputs();
  void hold(Current& c);
  void compare(Current& c) const;
  void noise_variances(const Current& c, const std::vector<double>& noise_density);
  /// Puts the parameter that has changed most significantly into news.
  void name_place(GapNews& news) const;

  /// A model of identified parameters.
  GapModel model_of(const Eigen::VectorXd& theta) const;

  Structure structure_;
  ParameterTable stories_;  ///< of the model that runs
  ParameterTable table_;    ///< of what is identified
  GroupDesign design_;
  std::vector<SensorAxis> axes_;
  DrivingAxes driving_;
  MeasuredInputs inputs_;  ///< of the axes that drive now
  /// What each axis above the base measures along x or y: degrees of freedom with weights.
  std::vector<std::vector<std::pair<int, double>>> seen_;
  double rate_hz_, high_pass_hz_;
  GapOptions options_;
  ModelLearner learner_;
  GapModel model_;                   ///< while there is one
  Eigen::VectorXd theta_;            ///< of what is identified
  std::vector<double> theta_error_;  ///< standard errors of what was learned; 0: as given
  std::vector<char> has_law_;        ///< of each parameter: an effect of the model acts there
  BaselineLearner since_gap_;        ///< windows since a gap began to show
  GapNews named_;                    ///< the last one
  std::optional<Current> current_;
  GapAlarm alarm_;
  Eigen::VectorXd driven_;  ///< the inputs now
  std::vector<double> noise_variance_;
  const GapNews* news_ = nullptr;
};

}  // namespace framewatch::estimator
