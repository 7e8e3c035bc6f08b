// SPDX-License-Identifier: MIT
// A pipeline that loads another one's state continues bit by bit like it, wherever the input is
// cut. The state is loaded into a pipeline that has seen other motion, so that a member that
// archive() forgets has a wrong value.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>

#include "estimator/pipeline/pipeline.h"
#include "estimator/state/archive.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

namespace framewatch::estimator {
namespace state_test {

constexpr double kRate_hz = 50;
constexpr int kInstants = 1100;
constexpr int kCompared = 310;  // instants after a cut: longer than a window and a re-tuning
constexpr int kOtherMotion = 420;

using Bytes = std::vector<std::uint8_t>;

/// All output of a pipeline, bit by bit, in the form of its state.
struct Said {
  std::vector<Bytes> estimates;
  void operator()(WindowEstimate estimate) {
    StateWriter writer;
    writer(estimate);
    estimates.push_back(writer.bytes());
  }
};

/// The pipeline under test with all its estimates.
struct Watched {
  explicit Watched(const PipelineConfig& config) : pipeline(config) {}
  void push(const AccelSample& sample) {
    each_window(pipeline.push(sample), [this](const WindowEstimate& e) { said(e); });
  }
  Said said;
  Pipeline pipeline;
};

class State : public testing::TestWithParam<bool> {
 protected:
  State() {
    config_.options.self_tune = true;
    config_.options.window_s = 4;
    config_.options.other_windows_s = {1, 2, 6};
    config_.options.long_window_s = 5;
    config_.options.hop_s = 0.04;
    config_.options.boxplot_windows = 60;
    config_.options.settle_s = 1;
    for (SensorAxis& axis : config_.axes) axis.noise_density = GetParam() ? 1e-3 : 0;
  }

  /// Samples of an instant with the faults of a long night: lost ones, a node that fails for a
  /// while, a stuck one, a clipping one, an interruption, late and repeated samples.
  void push(Watched& watched, int t, int from_axis, int to_axis, int shift = 0) const {
    if (t >= 690 && t < 770) return;  // no channel
    for (int axis = from_axis; axis < to_axis; ++axis) {
      if ((t * 31 + axis) % 97 == 0) continue;
      if (axis == 3 && t >= 520 && t < 560) continue;
      AccelSample sample = test::sample_at(accel_, kRate_hz, t, axis);
      sample.accel += 0.1 * shift;
      if (axis == 5 && t >= 860 && t < 890) sample.accel = 1;
      if (axis == 1) sample.accel = std::clamp(sample.accel, -1.5, 1.5);
      watched.push(sample);
      if (t % 40 == 7 && axis == 2) watched.push(sample);
    }
  }
  int axes() const { return static_cast<int>(config_.axes.size()); }

  /// Cuts after `axis` axes of an instant.
  struct Cut {
    int t, axis;
    Bytes state;
    std::size_t said;
  };

  PipelineConfig config_ = test::pipeline_config(test::table1(), kRate_hz);
  Eigen::MatrixXd accel_ = test::shaken(test::table1(), test::table1_theta(), kRate_hz,
                                        kInstants / kRate_hz, GetParam() ? 0.01 : 0.03);
};

TEST_P(State, ContinuesBitByBitFromAnyInstant) {
  std::vector<Cut> cuts;
  for (int t = 0; t < kInstants - kCompared; t += t < 480 ? 11 : 23)
    cuts.push_back({t, (t * 5) % axes(), {}, 0});
  cuts.push_back({689, 4, {}, 0});
  cuts.push_back({730, 0, {}, 0});
  cuts.push_back({0, 0, {}, 0});
  std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.t < b.t; });

  Watched uncut(config_);
  auto next = cuts.begin();
  for (int t = 0; t < kInstants; ++t) {
    int axis = 0;
    for (; next != cuts.end() && next->t == t; ++next) {
      push(uncut, t, axis, std::max(axis, next->axis));
      axis = std::max(axis, next->axis);
      next->axis = axis;
      StateWriter writer;
      uncut.pipeline.save(writer);
      next->state = writer.bytes();
      next->said = uncut.said.estimates.size();
    }
    push(uncut, t, axis, axes());
  }
  const PipelineCounters counters = uncut.pipeline.counters();
  EXPECT_GE(counters.retunes, 1) << "the cuts should meet every phase of re-tuning";
  EXPECT_GE(counters.interruptions, 1);

  std::size_t differing = 0;
  for (const Cut& cut : cuts) {
    Watched resumed(config_);
    for (int t = 0; t < (cut.t % 2 == 0 ? kOtherMotion : 0); ++t) push(resumed, t, 0, axes(), 1);
    resumed.said.estimates.clear();
    StateReader reader(cut.state);
    ASSERT_TRUE(resumed.pipeline.load(reader) && reader.whole()) << cut.t;
    push(resumed, cut.t, cut.axis, axes());
    for (int t = cut.t + 1; t < cut.t + kCompared; ++t) push(resumed, t, 0, axes());
    const auto& said = resumed.said.estimates;
    ASSERT_GT(said.size(), kCompared / 4u) << cut.t;
    for (std::size_t i = 0; i < said.size(); ++i)
      if (said[i] != uncut.said.estimates.at(cut.said + i)) {
        ++differing;
        ADD_FAILURE() << "cut at instant " << cut.t << ", axis " << cut.axis << ": estimate " << i
                      << " of " << said.size() << " after it differs";
        break;
      }
    ASSERT_LT(differing, 5u);
  }
}

TEST_P(State, ReadsBackItsBytes) {
  Watched first(config_);
  for (int t = 0; t < 500; ++t) push(first, t, 0, axes());
  StateWriter once;
  first.pipeline.save(once);
  Watched second(config_);
  StateReader reader(once.bytes());
  ASSERT_TRUE(second.pipeline.load(reader) && reader.whole());
  StateWriter twice;
  second.pipeline.save(twice);
  EXPECT_TRUE(once.bytes() == twice.bytes());
  EXPECT_EQ(first.pipeline.counters().windows, second.pipeline.counters().windows);
}

INSTANTIATE_TEST_SUITE_P(Noise, State, testing::Bool(),
                         [](const auto& given) { return given.param ? "configured" : "measured"; });

TEST(StateReader, RefusesTruncatedAndForeignStates) {
  const PipelineConfig config = test::pipeline_config(test::table1(), kRate_hz);
  Watched one(config);
  StateWriter writer;
  one.pipeline.save(writer);
  for (const std::size_t size : {0ul, 1ul, writer.bytes().size() / 2, writer.bytes().size() - 1}) {
    const Bytes cut(writer.bytes().begin(), writer.bytes().begin() + std::ptrdiff_t(size));
    Watched two(config);
    StateReader reader(cut);
    EXPECT_FALSE(two.pipeline.load(reader) && reader.whole()) << size;
  }
  Watched other(test::pipeline_config(test::table2(), kRate_hz));
  StateReader reader(writer.bytes());
  EXPECT_FALSE(other.pipeline.load(reader) && reader.whole());
}

}  // namespace state_test
}  // namespace framewatch::estimator
