// SPDX-License-Identifier: MIT
#include "estimator/simulate/sensor_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/example_effects.h"

namespace framewatch::estimator {
namespace channel_effects_test {

/// An effect on the axes of the table model: base x, base y, then floor 1 (y1, y2, x1, x2),
/// floor 2.
Effect channel_effect(EffectKind kind, int channel, std::vector<double> values, int with = -1) {
  EffectPlace place;
  place.kind = describe(kind).places.front();
  place.channel = channel;
  place.with_channel = with;
  return {kind, place, std::move(values)};
}

Eigen::VectorXd motion() {
  return Eigen::VectorXd::LinSpaced(10, 1, 10);
}

TEST(ChannelEffects, FollowTheirEquations) {
  const double angle = 10 * M_PI / 180;
  const struct {
    Effect effect;
    double expected;
  } cases[] = {
      {channel_effect(EffectKind::gain_error, 4, {0.2}), 6.0},
      {channel_effect(EffectKind::polarity, 4, {}), -5.0},
      {channel_effect(EffectKind::misalignment, 4, {10}, 2),
       5 * std::cos(angle) + 3 * std::sin(angle)},
      {channel_effect(EffectKind::bias_drift, 4, {0.5, 2}), 5.5},
      {channel_effect(EffectKind::swapped, 4, {}, 7), 8.0},
      {channel_effect(EffectKind::clipping, 4, {0.1}), 5.0},    // SensorModel clips
      {channel_effect(EffectKind::time_shift, 4, {0.1}), 5.0},  // ResponseChannel shifts
  };
  for (const auto& c : cases) {
    ChannelEffects effects({c.effect});
    const Eigen::VectorXd out = effects.apply(3.0, motion());
    EXPECT_NEAR(out[4], c.expected, 1e-12) << name_of(c.effect.kind);
    for (int i = 0; i < 10; ++i) {
      if (i == 4) continue;
      const bool exchanged = c.effect.kind == EffectKind::swapped && i == 7;
      EXPECT_EQ(out[i], exchanged ? 5.0 : motion()[i]) << name_of(c.effect.kind);
    }
  }
}

TEST(ChannelEffects, ABiasStartsAtItsTime) {
  ChannelEffects effects({channel_effect(EffectKind::bias_drift, 0, {0.5, 2})});
  EXPECT_EQ(effects.apply(1.0, motion())[0], 1.0);
}

TEST(ChannelEffects, DelayAndClipTheResponse) {
  const test::TableModel m = test::table_model();
  const ChannelEffects effects({channel_effect(EffectKind::time_shift, 3, {0.012}),
                                channel_effect(EffectKind::clipping, 5, {1.5}),
                                channel_effect(EffectKind::clipping, 5, {2.5})});
  std::vector<ResponseChannel> channels = response_channels(m.structure, m.axes);
  effects.delay(channels);
  EXPECT_EQ(channels[3].delay_s, 0.012);
  EXPECT_EQ(channels[4].delay_s, 0);
  std::vector<SensorModel> models(m.axes.size());
  effects.limit(models);
  EXPECT_EQ(models[5].clip_level, 1.5);
  EXPECT_EQ(models[4].clip_level, 0);
}

TEST(ChannelEffects, ClippingCutsNoiseToo) {
  const test::TableModel m = test::table_model();
  std::vector<SensorModel> models(m.axes.size());
  models[2].clip_level = 0.5;
  models[2].noise_density = 1;
  SensorArray array(m.axes, models, 100, 1);
  double largest = 0;
  for (int i = 0; i < 200; ++i)
    largest = std::max(largest, std::abs(array.measure(0.01 * i, Eigen::VectorXd::Zero(10))[2]));
  EXPECT_EQ(largest, 0.5);
}

}  // namespace channel_effects_test
}  // namespace framewatch::estimator
