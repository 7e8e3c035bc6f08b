// SPDX-License-Identifier: MIT
// Sends absurd samples by every input: messages, record files, CAN. They must be counted, the
// channel named, and the estimates those of good input.

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/accel_t.hpp>
#include <framewatch/temperature_t.hpp>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/replay_command.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/can_traffic.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace absurd_input_test {

constexpr double kSeconds = 20;
constexpr int kNode = 3;

/// Collects the findings of an estimation.
struct Listener : EstimationListener {
  explicit Listener(const Config& config)
      : estimation(
            config,
            [this](std::int64_t, const std::string& channel,
                   const std::vector<std::uint8_t>& bytes) {
              if (channel.ends_with("EVENT")) events.push_back(*drivers::decoded<event_t>(bytes));
              if (channel.ends_with("STATUS")) status = *drivers::decoded<status_t>(bytes);
            },
            this) {}
  void on_estimate(const estimator::WindowEstimate& e) override { estimates.push_back(e); }
  void on_sample(const estimator::AccelSample& s) override {
    if (std::isfinite(s.accel)) most = std::max(most, std::abs(s.accel));
  }
  double most = 0;  ///< m/s^2, the largest of all samples
  std::vector<event_t> events;
  status_t status;
  std::vector<estimator::WindowEstimate> estimates;
  Estimation estimation;
};

Config table_config() {
  std::vector<ConfigProblem> problems;
  return *load_config(test::table_config(), problems);
}

/// Returns the largest change of a value that both series have, in standard errors. Nearly all have
/// both or neither: a repaired sample may move one across the gate.
double moved(const std::vector<estimator::WindowEstimate>& a,
             const std::vector<estimator::WindowEstimate>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  int both = 0, one = 0;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
    for (std::size_t p = 0; p < a[i].value.size(); ++p) {
      one += std::isfinite(a[i].value[p]) != std::isfinite(b[i].value[p]);
      if (!std::isfinite(a[i].value[p]) || !std::isfinite(b[i].value[p])) continue;
      ++both;
      worst = std::max(worst, std::abs(a[i].value[p] - b[i].value[p]) / b[i].std_error[p]);
    }
  EXPECT_LT(one, both / 20);
  return worst;
}

std::string axis_of(const Config& config, int node, int axis) {
  for (std::size_t i = 0; i < config.sources.size(); ++i)
    if (config.sources[i].sensor_node == node && config.sources[i].axis == axis)
      return config.pipeline.axes[i].name;
  return "";
}

TEST(AbsurdInput, IsCountedNamedAndLeftOutInMessages) {
  const test::TemporaryDirectory directory;
  test::record_table_test(directory.path("rec.lcmlog"), kSeconds);
  const Config config = table_config();
  Listener clean(config), hit(config);
  drivers::LcmLogReader reader;
  ASSERT_TRUE(reader.open(directory.path("rec.lcmlog")));
  std::mt19937_64 random(3);
  std::int64_t sent = 0, count = 0, name_axis = -1;
  std::vector<std::uint8_t> bytes;
  for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) {
    clean.estimation.message(e.channel, e.data.data(), e.data.size());
    auto m = drivers::decoded<accel_t>(e.data);
    if (!m || m->node != kNode || ++count % 40 != 0) {
      hit.estimation.message(e.channel, e.data.data(), e.data.size());
      continue;
    }
    // Byte-swapped doubles and every large exponent.
    const int axis = std::isnan(m->accel_abs_mps2[0]) ? 1 : 0;
    name_axis = axis;
    const auto exponent = static_cast<std::uint64_t>(1031 + 19 * sent);
    m->accel_abs_mps2[axis] =
        std::bit_cast<double>(exponent << 52 | (random() & 0xFFFFFFFFFFFFF) | 1ull << 51);
    drivers::encode_into(bytes, *m);
    hit.estimation.message(e.channel, bytes.data(), bytes.size());
    ++sent;
  }
  clean.estimation.finish();
  hit.estimation.finish();
  ASSERT_GT(sent, 40);
  EXPECT_LT(moved(clean.estimates, hit.estimates), 1);
  EXPECT_TRUE(clean.events.empty());
  const std::string name = axis_of(config, kNode, static_cast<int>(name_axis));
  ASSERT_FALSE(hit.events.empty());
  EXPECT_EQ(hit.events.front().kind, "absurd_samples");
  EXPECT_EQ(hit.events.front().place, name);
  EXPECT_EQ(hit.estimation.raised().all().size(), 1u);
  for (std::size_t i = 0; i < hit.status.name.size(); ++i)
    EXPECT_EQ(hit.status.rejected[i], hit.status.name[i] == name ? sent : 0);
}

TEST(AbsurdInput, IsSkippedInARecordFile) {
  const test::TemporaryDirectory directory;
  test::record_table_test(directory.path("rec.csv"), kSeconds);
  std::string text = test::read_file(directory.path("rec.csv"));
  int number = 0;
  std::string spoiled;
  for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
    end = text.find('\n', at);
    std::string line = text.substr(at, end - at);
    const std::size_t comma = line.rfind(',');
    if (++number > 600 && number % 100 == 0)
      line = line.substr(0, comma + 1) + (number % 200 == 0 ? "1e300" : "-3.4e38");
    spoiled += line + "\n";
  }
  test::write_file(directory.path("spoiled.csv"), spoiled);
  const auto estimates = [&](const std::string& in) {
    ReplayArguments a{test::table_config(),
                      {directory.path(in)},
                      directory.path(in + ".lcmlog"),
                      false,
                      true,
                      false};
    EXPECT_EQ(replay(a), 0);
    std::map<std::int64_t, window_estimate_t> out;
    std::vector<event_t> events;
    drivers::LcmLogReader reader;
    EXPECT_TRUE(reader.open(a.out));
    for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) {
      if (e.channel == "FRAMEWATCH_ESTIMATE") {
        const auto m = *drivers::decoded<window_estimate_t>(e.data);
        out[m.window_end_us] = m;
      }
      if (e.channel == "FRAMEWATCH_EVENT") events.push_back(*drivers::decoded<event_t>(e.data));
    }
    return std::pair(out, events);
  };
  const auto [clean, no_events] = estimates("rec.csv");
  const auto [hit, events] = estimates("spoiled.csv");
  EXPECT_TRUE(no_events.empty());
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, "absurd_samples");
  ASSERT_EQ(clean.size(), hit.size());
  for (const auto& [end, m] : clean)
    for (std::size_t p = 0; p < m.value.size(); ++p) {
      const window_estimate_t& now = hit.at(end);
      ASSERT_EQ(now.reason[p], m.reason[p]);
      if (m.reason[p] == 0) {
        EXPECT_LT(std::abs(now.value[p] - m.value[p]), now.std_error[p]);
      }
    }
}

bool carries(const drivers::CanFrame& frame, const drivers::CanMessageMap& message) {
  return frame.extended == message.extended && ((frame.id ^ message.id) & message.mask) == 0;
}

/// Puts `pattern` into the first signal of every 50th frame with signals. Returns the number of
/// changed frames.
std::int64_t spoil(const Config& config, std::vector<drivers::BusFrame>& frames,
                   const std::function<std::uint64_t(std::int64_t)>& pattern) {
  std::int64_t spoiled = 0, count = 0;
  for (drivers::BusFrame& f : frames)
    for (const drivers::CanNodeMap& node : config.can.nodes)
      for (const drivers::CanMessageMap& m : node.messages) {
        if (node.bus != f.bus || m.readings.empty() || !carries(f.frame, m) || ++count % 50 != 0 ||
            count < 1000)
          continue;
        drivers::put_bits(m.readings[0].field, pattern(spoiled++), f.frame.data);
      }
  return spoiled;
}

TEST(AbsurdInput, IsCountedAndLeftOutForExtremesOfInt32OnCan) {
  const Config config = test::can_example("epson_m_a552");
  auto frames = test::can_traffic(config, 1500, 9.80665);
  const std::int64_t spoiled = spoil(config, frames, [](std::int64_t i) {
    return std::uint64_t{i % 2 == 0 ? 0x7FFFFFFFu : 0x80000000u};
  });
  ASSERT_GT(spoiled, 20);
  Listener heard(config);
  for (const drivers::BusFrame& f : frames) heard.estimation.frame(f.bus, f.frame);
  heard.estimation.finish();
  std::int64_t absurd = 0;
  for (const estimator::AxisCounters& c : heard.estimation.axis_counters()) absurd += c.absurd;
  EXPECT_EQ(absurd, spoiled);
  EXPECT_FALSE(heard.events.empty());
}

TEST(AbsurdInput, DoesNotSpreadOverResampledFloatsOnCan) {
  Config config = test::can_example("raw_int16");
  ASSERT_TRUE(config.can.resample);
  for (drivers::CanNodeMap& node : config.can.nodes)  // one float per frame
    for (drivers::CanMessageMap& m : node.messages)
      if (!m.readings.empty()) {
        m.readings.resize(1);
        drivers::CanField& field = m.readings[0].field;
        field = {field.start, 32, true, true, drivers::CanValue::float32, 1, 0};
      }
  auto frames = test::can_traffic(config, 4000);
  std::int64_t beyond = 0;
  (void)spoil(config, frames, [&](std::int64_t i) {
    const auto bits = static_cast<std::uint32_t>(i % 2) << 31 |
                      (134u + static_cast<std::uint32_t>(i % 122)) << 23 | 0x600000u;
    beyond += !std::isnan(std::bit_cast<float>(bits));
    return std::uint64_t{bits};
  });
  ASSERT_GT(beyond, 50);
  Listener heard(config);
  for (const drivers::BusFrame& f : frames) heard.estimation.frame(f.bus, f.frame);
  heard.estimation.finish();
  std::int64_t absurd = 0;
  for (const estimator::AxisCounters& c : heard.estimation.axis_counters()) absurd += c.absurd;
  EXPECT_EQ(absurd, beyond);
  EXPECT_LT(heard.most, 1.1);
  EXPECT_FALSE(heard.events.empty());
}

TEST(AbsurdInput, IsRefusedAsATemperature) {
  Config config = table_config();
  config.watch.emplace();
  config.watch->temperature_channel = "TEMPERATURE";
  Listener heard(config);
  temperature_t m{};
  m.time_us = 1;
  std::vector<std::uint8_t> bytes;
  for (const double degc : {20.0, 1e300, std::nan(""), -400.0}) {
    m.temperature_degc = degc;
    drivers::encode_into(bytes, m);
    EXPECT_EQ(heard.estimation.message("TEMPERATURE", bytes.data(), bytes.size()),
              degc == 20 ? drivers::IntakeResult::table : drivers::IntakeResult::malformed);
  }
}

}  // namespace absurd_input_test
}  // namespace framewatch::daemon
