// SPDX-License-Identifier: MIT
// Tests values from minutes of weak motion, in which ordinary windows have none.
#include "estimator/identify/window/long_window.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/pipeline/pipeline.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/restless_building.h"

namespace framewatch::estimator {
namespace long_window_test {

constexpr double kGround = 1e-4, kNoise = 7e-5;  // m/s^2/sqrt(Hz)
constexpr double kLong_s = 200;
constexpr int kWindow = 4;           // its index after four ordinary windows
constexpr double kOff = 0.08;        // relative error of the design
constexpr double kMaxErrors = 5;     // largest error of a value in standard errors
constexpr double kMaxScatter = 1.4;  // largest rms of these errors
constexpr double kMaxError = 0.09;
constexpr double kMaxErrorOfOthers = 0.035;  // largest error of values from ordinary windows
constexpr double kSpike = 1000;              // m/s^2

struct DeliveryResult {
  std::vector<WindowEstimate> given;
  int others = 0, frames_of_others = 0;  ///< ordinary windows, and their values of frame stiffness
};

class LongWindows : public testing::Test {
 protected:
  /// Runs the building for some instants. `alter` may change it before an instant; `delivered` may
  /// change or drop a sample.
  DeliveryResult run(int instants,
                     const std::function<void(test::RestlessBuilding&, int)>& alter = {},
                     const std::function<bool(int, int)>& delivered = {}) const {
    PipelineConfig config{structure_, axes_, {}, truth_};
    for (int p = 0; p < table_.size(); ++p) config.design[p] *= p % 2 == 0 ? 1 + kOff : 1 - kOff;
    config.options.hop_s = 0.5;
    config.options.long_window_s = kLong_s;
    config.options.max_error_k = kMaxErrorOfOthers;
    test::RestlessBuilding building(structure_, truth_, axes_, 3);
    building.set_ground(kGround);
    building.set_noise(kNoise);
    DeliveryResult out;
    const auto keep = [&](const WindowEstimate& e) {
      if (e.window == kWindow) return out.given.push_back(e);
      ++out.others;
      for (int p = 0; p < table_.size(); ++p)
        out.frames_of_others +=
            table_[p].kind == ParameterKind::frame_stiffness &&
                    e.reason[static_cast<std::size_t>(p)] == Observability::observable
                ? 1
                : 0;
    };
    Pipeline pipeline(config);
    for (int t = 0; t < instants; ++t) {
      if (alter) alter(building, t);
      const Eigen::VectorXd& accel = building.next();
      for (int a = 0; a < accel.size(); ++a)
        if (!delivered || delivered(t, a))
          each_window(pipeline.push({from_microseconds(10'000LL * t), a,
                                     t == spike_at_ && a == 7 ? kSpike : accel[a]}),
                      keep);
    }
    each_window(pipeline.finish(), keep);
    return out;
  }
  /// Returns the deviations of the frames' stiffnesses over their standard errors.
  std::vector<double> deviations(const WindowEstimate& e, double* error = nullptr) const {
    std::vector<double> out;
    for (int p = 0; p < table_.size(); ++p) {
      const auto u = static_cast<std::size_t>(p);
      if (table_[p].kind != ParameterKind::frame_stiffness ||
          e.reason[u] != Observability::observable)
        continue;
      out.push_back((e.value[u] - truth_[p]) / e.std_error[u]);
      if (error != nullptr) *error = std::max(*error, e.std_error[u] / truth_[p]);
    }
    return out;
  }
  static double rms(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return std::sqrt(sum / static_cast<double>(values.size()));
  }

  Structure structure_ = daemon::table1();
  ParameterTable table_{structure_};
  Eigen::VectorXd truth_ = daemon::table1_theta();
  std::vector<SensorAxis> axes_ = [this] {
    std::vector<SensorAxis> axes = daemon::full_sensor_axes(structure_);
    for (SensorAxis& axis : axes) axis.noise_density = kNoise;
    return axes;
  }();
  const std::size_t frames_ = 20;
  int spike_at_ = -1;  ///< instant at which a sensor reads kSpike
};

TEST_F(LongWindows, ShowElementsThatOtherWindowsDoNot) {
  const DeliveryResult run = this->run(30'000);
  EXPECT_EQ(run.frames_of_others, 0);
  EXPECT_GT(run.others, 100);
  ASSERT_GE(run.given.size(), 3u);
  const WindowEstimate& e = run.given.back();
  EXPECT_EQ(e.rows, 20'000);
  EXPECT_NEAR(std::chrono::duration<double>(e.end - e.start).count(), kLong_s, 0.011);
  EXPECT_NEAR(std::chrono::duration<double>(e.end - run.given[run.given.size() - 2].end).count(),
              kLong_s / 5, 1e-6);
  double error = 0;
  const std::vector<double> off = deviations(e, &error);
  ASSERT_EQ(off.size(), frames_);
  EXPECT_LT(rms(off), kMaxScatter);
  for (const double z : off) EXPECT_LT(std::abs(z), kMaxErrors);
  EXPECT_LT(error, kMaxError);
}

TEST_F(LongWindows, OneStrongMomentDoesNotDominate) {
  constexpr double kStronger = 300;
  const auto quake = [](test::RestlessBuilding& building, int t) {
    if (t == 12'000) building.set_ground(kStronger * kGround);
    if (t == 13'000) building.set_ground(kGround);
  };
  const DeliveryResult run = this->run(23'000, quake), calm = this->run(23'000);
  ASSERT_FALSE(run.given.empty());
  ASSERT_EQ(run.given.size(), calm.given.size());
  double error = 0, calm_error = 0;
  const std::vector<double> off = deviations(run.given.back(), &error);
  (void)deviations(calm.given.back(), &calm_error);
  ASSERT_EQ(off.size(), frames_);
  EXPECT_LT(rms(off), kMaxScatter);
  EXPECT_GT(error, calm_error / 6);  // a hundred times less if the spike counted
}

TEST_F(LongWindows, IgnoreASpikeOfASensor) {
  spike_at_ = 14'000;
  const DeliveryResult run = this->run(25'000);
  ASSERT_FALSE(run.given.empty());
  const std::vector<double> off = deviations(run.given.back());
  ASSERT_GE(off.size(), frames_ * 3 / 4);  // errors are larger and near the limit
  EXPECT_LT(rms(off), kMaxScatter);
}

TEST_F(LongWindows, LeaveOutABriefSensorLossAndLoseADeadSensorsPlace) {
  const int top = [&] {
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (axes_[a].story == 5 && axes_[a].frame == 0) return static_cast<int>(a);
    return -1;
  }();
  const DeliveryResult moment = this->run(
      23'000, {}, [&](int t, int axis) { return axis != top || t < 10'000 || t >= 10'300; });
  ASSERT_FALSE(moment.given.empty());
  EXPECT_EQ(deviations(moment.given.back()).size(), frames_);
  EXPECT_LT(rms(deviations(moment.given.back())), kMaxScatter);
  const DeliveryResult dead =
      this->run(32'000, {}, [&](int t, int axis) { return axis != top || t < 10'000; });
  ASSERT_FALSE(dead.given.empty());
  const WindowEstimate& e = dead.given.back();
  EXPECT_EQ(e.reason[static_cast<std::size_t>(table_.frame_stiffness(5, 0))],
            Observability::channel_lost);
  const std::vector<double> off = deviations(e);
  EXPECT_GE(off.size(), frames_ * 3 / 4);
  EXPECT_LT(rms(off), kMaxScatter);
}

}  // namespace long_window_test
}  // namespace framewatch::estimator
