// SPDX-License-Identifier: MIT
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/monitor/estimation/publisher.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/recorded_table_test.h"

namespace framewatch::daemon {
namespace publisher_test {

Config table() {
  std::vector<ConfigProblem> problems;
  auto config = load_config(test::table_config(), problems);
  if (!config) throw std::runtime_error(problems.front().message);
  return *config;
}

struct Sent {
  std::int64_t time_us;
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

template <typename MessageType>
MessageType decoded(const Sent& sent) {
  MessageType message{};
  const int size = static_cast<int>(sent.bytes.size());
  EXPECT_EQ(message.decode(sent.bytes.data(), 0, size), size);
  return message;
}

estimator::WindowEstimate estimate(std::int64_t sequence, std::size_t parameters) {
  estimator::WindowEstimate e;
  e.start = estimator::from_microseconds(1'000'000);
  e.end = estimator::from_microseconds(6'000'000 + 10'000 * sequence);
  e.sequence = sequence;
  e.status = estimator::WindowStatus::valid;
  e.rows = 500;
  e.value.assign(parameters, 2.5);
  e.value.back() = std::numeric_limits<double>::quiet_NaN();
  e.std_error.assign(parameters, 0.5);
  e.reason.assign(parameters, estimator::Observability::observable);
  e.reason.back() = estimator::Observability::floor_too_stiff;
  e.snr.assign(parameters, 100);
  e.prior_share.assign(parameters, 0.25);
  e.noise_share.assign(parameters, 0.125);
  e.last_value.assign(parameters, 2.5);
  e.last_std_error.assign(parameters, 0.5);
  e.last_end.assign(parameters, estimator::from_microseconds(5'000'000));
  e.boxplot.assign(parameters, {1, 2, 3, 0.5, 3.5, 4, 7});
  return e;
}

TEST(Publisher, PublishesTheEstimates) {
  const Config config = table();
  std::vector<Sent> sent;
  Publisher publisher(config, [&](std::int64_t time_us, const std::string& channel,
                                  const std::vector<std::uint8_t>& bytes) {
    sent.push_back({time_us, channel, bytes});
  });
  publisher.estimate(estimate(3, 20));
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].channel, "FRAMEWATCH_ESTIMATE");
  EXPECT_EQ(sent[0].time_us, 6'030'000);
  const auto m = decoded<framewatch::window_estimate_t>(sent[0]);
  EXPECT_EQ(m.window_start_us, 1'000'000);
  EXPECT_EQ(m.window_end_us, 6'030'000);
  EXPECT_EQ(m.sequence, 3);
  EXPECT_EQ(m.status, 1);
  EXPECT_EQ(m.rows, 500);
  ASSERT_EQ(m.parameters, 20);
  EXPECT_EQ(m.value[0], 2.5);
  EXPECT_TRUE(std::isnan(m.value[19]));
  EXPECT_EQ(m.reason[19], 3);
  EXPECT_EQ(m.noise_share[3], 0.125F);
  ASSERT_EQ(m.held, 1);
  EXPECT_EQ(m.held_index[0], 19);
  EXPECT_EQ(m.held_value[0], 2.5);
  EXPECT_EQ(m.held_end_us[0], 5'000'000);
  EXPECT_EQ(m.boxplot_windows, 4);
  ASSERT_EQ(m.boxplots, 20);
  EXPECT_EQ(m.median[7], 2);
  EXPECT_EQ(m.whisker_high[7], 3.5);
  EXPECT_EQ(m.outliers[7], 4);
  EXPECT_EQ(m.boxplot_count[7], 7);
}

TEST(Publisher, ThinsBoxplotsAsConfigured) {
  Config config = table();
  config.lcm.boxplot_every = 5;
  std::vector<std::int32_t> boxplots;
  Publisher publisher(config, [&](std::int64_t time_us, const std::string& channel,
                                  const std::vector<std::uint8_t>& bytes) {
    boxplots.push_back(
        decoded<framewatch::window_estimate_t>(Sent{time_us, channel, bytes}).boxplots);
  });
  for (std::int64_t i = 0; i < 11; ++i) publisher.estimate(estimate(i, 20));
  EXPECT_EQ(boxplots, (std::vector<std::int32_t>{20, 0, 0, 0, 0, 20, 0, 0, 0, 0, 20}));
}

TEST(Publisher, PublishesTableAndStatus) {
  Config config = table();
  config.lcm.prefix = "SITE_";
  std::vector<Sent> sent;
  Publisher publisher(config, [&](std::int64_t time_us, const std::string& channel,
                                  const std::vector<std::uint8_t>& bytes) {
    sent.push_back({time_us, channel, bytes});
  });
  const estimator::Pipeline pipeline(config.pipeline);
  publisher.parameters(42, pipeline);
  framewatch::status_t counts{};
  counts.time_us = 43;
  counts.windows = 7;
  counts.rejected_messages = 10;
  for (auto* column : {&counts.received, &counts.lost, &counts.late, &counts.repaired,
                       &counts.rejected, &counts.stuck, &counts.clipped})
    for (std::size_t i = 0; i < config.pipeline.axes.size(); ++i)
      column->push_back(static_cast<std::int64_t>(i));
  counts.noise_mps2_per_rthz.resize(config.pipeline.axes.size());
  publisher.status(counts);

  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].channel, "SITE_PARAMETERS");
  const auto parameters = decoded<framewatch::parameter_table_t>(sent[0]);
  EXPECT_EQ(parameters.time_us, 42);
  EXPECT_EQ(parameters.config_sha256, config.sha256);
  EXPECT_EQ(parameters.parameters, pipeline.parameters().size());
  EXPECT_EQ(parameters.name.front(), "kx_1_y1");
  EXPECT_EQ(parameters.unit.front(), "N/m");
  EXPECT_EQ(parameters.kind.back(), 3);
  EXPECT_EQ(parameters.window_rows, 500);
  EXPECT_GT(parameters.design.front(), 0);

  EXPECT_EQ(sent[1].channel, "SITE_STATUS");
  const auto status = decoded<framewatch::status_t>(sent[1]);
  EXPECT_EQ(status.time_us, 43);
  EXPECT_EQ(status.windows, 7);
  EXPECT_EQ(status.rejected_messages, 10);
  EXPECT_EQ(status.config_sha256, config.sha256);
  ASSERT_EQ(status.channels, static_cast<std::int32_t>(config.pipeline.axes.size()));
  EXPECT_EQ(status.name[1], config.pipeline.axes[1].name);
  EXPECT_EQ(status.rejected[1], 1);
}

}  // namespace publisher_test
}  // namespace framewatch::daemon
