// SPDX-License-Identifier: MIT
// A channel that misreads, through the whole program: an event names it, its samples are left out,
// no value is wrong and certain, and the building raises no alarm.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/accel_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/daemon/tools/replay/replay_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace faulty_channel_test {

constexpr double kSeconds = 130;
constexpr std::int64_t kFault_us = 100'000'000, kSoon_us = 10'000'000;
constexpr double kWrong = 0.03, kErrors = 5, kRare = 1e-3;
const std::vector<std::pair<std::string, double>> kTrue_npm{
    {"kx_1_y1", 34e3}, {"kx_1_y2", 25e3}, {"kx_2_y1", 28e3}, {"kx_2_y2", 22e3},
    {"ky_1_x1", 26e3}, {"ky_1_x2", 31e3}, {"ky_2_x1", 24e3}, {"ky_2_x2", 29e3}};

/// Returns a faulty reading of the right one.
using Fault = std::function<double(double)>;

class FaultyChannelRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new test::TemporaryDirectory;
    test::record_table_test(directory_->path("right.lcmlog"), kSeconds);
    test::write_file(directory_->path("watch.toml"),
                     test::read_file(test::table_config()) + "\n[watch]\nlearn_s = 40\n");
  }
  static void TearDownTestSuite() { delete directory_; }

  /// Replays the log with a fault of one node's axis from kFault_us on.
  void run(int node, int axis, const Fault& fault) {
    const std::string bad = directory_->path("bad.lcmlog"), out = directory_->path("est.lcmlog");
    std::int64_t first_us = -1;
    test::rewrite(directory_->path("right.lcmlog"), bad, [&](drivers::LogEvent& e) {
      if (e.channel != "ACCEL") return true;
      auto m = *drivers::decoded<accel_t>(e.data);
      if (first_us < 0) first_us = m.time_us;
      if (m.node == node && m.time_us - first_us >= kFault_us) {
        m.accel_abs_mps2[axis] = fault(m.accel_abs_mps2[axis]);
        e.data = drivers::encoded(m);
      }
      return true;
    });
    ASSERT_EQ(test::replay_of({bad}, out, false, directory_->path("watch.toml")).exit_code, 0);
    fault_us_ = first_us + kFault_us;
    events_.clear();
    for (const auto& data : test::payloads(out, "FRAMEWATCH_EVENT"))
      events_.push_back(*drivers::decoded<event_t>(data));
  }
  /// Returns the share of the values that are wrong and certain.
  double wrong_and_certain() const {
    const std::string out = directory_->path("est.lcmlog");
    const auto names =
        drivers::decoded<parameter_table_t>(test::payloads(out, "FRAMEWATCH_PARAMETERS").front())
            ->name;
    double shown = 0, wrong = 0;
    for (const auto& data : test::payloads(out, "FRAMEWATCH_ESTIMATE")) {
      const auto e = *drivers::decoded<window_estimate_t>(data);
      for (const auto& [name, right] : kTrue_npm) {
        const auto p =
            static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
        if (!std::isfinite(e.value[p])) continue;
        const double off = std::abs(e.value[p] - right);
        ++shown;
        if (off > kWrong * right && off > kErrors * e.std_error[p]) ++wrong;
      }
    }
    EXPECT_GT(shown, 10'000);
    return wrong / shown;
  }

  inline static test::TemporaryDirectory* directory_ = nullptr;
  std::int64_t fault_us_ = 0;
  std::vector<event_t> events_;
};

TEST_F(FaultyChannelRun, IsNamedAndLeftOutAndNoDamage) {
  struct Case {
    const char* channel;
    int node, axis;
    Fault fault;
    const char* words;
  };
  const Case cases[] = {
      {"F2-Y1", 6, 0, [](double a) { return 1.1 * a; }, "too much"},
      {"F1-Y1", 2, 0, [](double a) { return 1e-3 * std::sin(1e6 * a); }, "does not move"},
      {"F1-Y2", 3, 0, [](double a) { return -a; }, "other sign"},
      {"F1-Y1", 2, 0, [](double a) { return 1.5 * std::tanh(a / 1.5); }, "saturates"},
      {"base-y", 1, 1, [](double a) { return 0.85 * a; }, "too little"}};
  for (const Case& c : cases) {
    run(c.node, c.axis, c.fault);
    ASSERT_FALSE(events_.empty()) << c.words;
    for (const event_t& e : events_) {
      EXPECT_EQ(e.kind, "channel_doubted") << e.message;
      EXPECT_EQ(e.place, c.channel) << e.message;
      EXPECT_EQ(e.severity, severity::warning);
    }
    EXPECT_LE(events_.front().time_us, fault_us_ + kSoon_us);
    EXPECT_NE(events_.back().message.find(c.words), std::string::npos) << events_.back().message;
    EXPECT_LE(wrong_and_certain(), kRare) << c.words;
  }
}

TEST_F(FaultyChannelRun, OfNothingRaisesNothing) {
  run(0, 0, [](double a) { return a; });
  EXPECT_TRUE(events_.empty());
  EXPECT_EQ(wrong_and_certain(), 0);
}

}  // namespace faulty_channel_test
}  // namespace framewatch::daemon
