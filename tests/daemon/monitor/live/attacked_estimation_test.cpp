// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/accel_t.hpp>
#include <framewatch/channel_table_t.hpp>
#include <framewatch/event_t.hpp>

#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/live/live_estimation.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/lcm_source.h"
#include "tests/drivers/lcm/multicast/datagram_sender.h"
#include "tests/support/config_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace attacked_estimation_test {

namespace packets = drivers::packets;
using Clock = std::chrono::steady_clock;
using Payloads = std::vector<std::vector<std::uint8_t>>;

constexpr const char* kUrl = "udpm://239.255.76.67:7714?ttl=0";
constexpr std::uint16_t kTestPort = 7714;
constexpr int kGarbagePerMs = 10;

std::string random_text(std::mt19937& random, std::size_t most) {
  std::string out(random() % most, '\0');
  for (char& c : out) c = static_cast<char>(random());
  return out;
}

std::string text_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

/// Returns 400 datagrams: noise, LCM headers with impossible lengths, known messages with senseless
/// contents, foreign channels.
std::vector<packets::Bytes> garbage() {
  std::mt19937 random(3);
  const std::string accel = text_of(drivers::encoded(accel_t{}));
  const std::string table = text_of(drivers::encoded(channel_table_t{}));
  std::vector<packets::Bytes> out;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const std::string noise = random_text(random, 1400);
    switch (i % 8) {
      case 0:
        out.emplace_back(noise.begin(), noise.end());
        break;
      case 1:
        out.push_back(packets::whole(i, "ACCEL", noise));
        break;
      case 2:
        out.push_back(packets::whole(i, "ACCEL", accel.substr(0, 8) + noise.substr(0, 44)));
        break;
      case 3:
        out.push_back(packets::whole(i, "ACCEL_CHANNELS", table.substr(0, 8) + noise));
        break;
      case 4:
        out.push_back(packets::part(i, 3000u << i % 20, 0xFFFFFF00u >> i % 30, i % 3, 3,
                                    std::string("ACCEL\0", 6) + noise));
        break;
      case 5:
        out.push_back(packets::whole(i, "FRAMEWATCH_ACKNOWLEDGE", noise));
        break;
      case 6:
        out.push_back(packets::whole(i, random_text(random, 80), noise));
        break;
      default:
        out.push_back(packets::part(i, 1 << 24, 0, 0, 65535, std::string("ACCEL\0", 6) + noise));
    }
  }
  return out;
}

/// Sends 10,000 of them a second until it is destroyed.
class GarbageSender {
 public:
  ~GarbageSender() {
    stop_ = true;
    thread_.join();
  }
  std::int64_t sent() const { return sent_; }

 private:
  void work() {
    const std::vector<packets::Bytes> pool = garbage();
    const drivers::DatagramSender sender(kTestPort);
    for (auto due = Clock::now(); !stop_; due += std::chrono::milliseconds(1)) {
      for (int i = 0; i < kGarbagePerMs; ++i, ++sent_)
        sender.send(pool[static_cast<std::size_t>(sent_) % pool.size()]);
      std::this_thread::sleep_until(due);
    }
  }
  std::atomic<bool> stop_ = false;
  std::atomic<std::int64_t> sent_ = 0;
  std::thread thread_{[this] { work(); }};
};

std::int64_t samples_received(const Estimation& estimation) {
  std::int64_t received = 0;
  for (const estimator::AxisCounters& axis : estimation.pipeline().counters().axes)
    received += axis.received;
  return received;
}

/// Plays a log over multicast, and at the same time directly into an estimation without an
/// attacker.
class AttackedEstimation : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
    test::record_table_test(directory_.path("rec.lcmlog"), 10);
    std::vector<ConfigProblem> problems;
    config_ = load_config(test::table_config(), problems);
    ASSERT_TRUE(config_);
    std::string error;
    lcm_ = drivers::open_lcm(kUrl, {}, error);
    ASSERT_TRUE(lcm_) << error;
    live_.emplace(*config_, *lcm_);
  }

  /// Calls `beside` after each message, to send anything.
  void play(const std::function<void(const drivers::LogEvent&)>& beside) {
    Estimation reference(*config_, [&](std::int64_t, const std::string& channel,
                                       const std::vector<std::uint8_t>& bytes) {
      if (channel == "FRAMEWATCH_ESTIMATE") quiet_.push_back(bytes);
    });
    drivers::LcmSource results(*lcm_, {"FRAMEWATCH_ESTIMATE"}, 100'000,
                               [&](const drivers::LcmMessage& m) {
                                 const auto* bytes = static_cast<const std::uint8_t*>(m.data);
                                 attacked_.emplace_back(bytes, bytes + m.size);
                               });
    drivers::LcmLogReader reader;
    ASSERT_TRUE(reader.open(directory_.path("rec.lcmlog")));
    drivers::LogEvent event;
    for (std::int64_t played = 0; reader.next(event) == drivers::LogRead::event; ++played) {
      reference.message(event.channel, event.data.data(), event.data.size());
      lcm_->publish(event.channel, event.data.data(), static_cast<unsigned>(event.data.size()));
      beside(event);
      if (played % 50 == 0) catch_up(reference);
      ASSERT_TRUE(results.handle(0));
    }
    catch_up(reference);
    reference.finish();
    live_->finish();
    while (attacked_.size() < quiet_.size() && Clock::now() < until_)
      ASSERT_TRUE(results.handle(100));
    EXPECT_GT(quiet_.size(), 300u);
    EXPECT_TRUE(attacked_ == quiet_) << attacked_.size() << " of " << quiet_.size();
  }

  void catch_up(const Estimation& reference) {
    while (samples_received(live_->estimation()) < samples_received(reference) &&
           Clock::now() < until_)
      ASSERT_TRUE(live_->poll(10));
  }

  const Clock::time_point until_ = Clock::now() + std::chrono::minutes(5);
  test::TemporaryDirectory directory_;
  std::optional<Config> config_;
  std::unique_ptr<drivers::LcmProvider> lcm_;
  std::optional<LiveEstimation> live_;
  Payloads quiet_, attacked_;
};

TEST_F(AttackedEstimation, TenThousandGarbageDatagramsASecondChangeNoBitOfAnEstimate) {
  const GarbageSender attacker;
  play([](const drivers::LogEvent&) {});
  EXPECT_GT(live_->dropped().malformed, 0);
  EXPECT_GT(attacker.sent(), 1000);
}

TEST_F(AttackedEstimation, ATwinOnAnotherSocketRaisesAnEventAndChangesNoBit) {
  const drivers::DatagramSender twin(kTestPort);
  play([&](const drivers::LogEvent& event) {
    if (event.channel != "ACCEL") return;
    auto sample = *drivers::decode_accel(event.data.data(), event.data.size());
    if (sample.node != 2) return;
    for (double& value : sample.accel_abs_mps2) value *= 0.8;
    twin.send(packets::whole(1, "ACCEL", text_of(drivers::encode_accel(sample))));
    std::this_thread::sleep_for(std::chrono::milliseconds(3));  // news comes once a second
  });
  const std::vector<event_t> events = live_->take_events();
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events[0].kind, "two_senders");
  EXPECT_NE(events[0].message.find("127.0.0.1:"), std::string::npos) << events[0].message;
}

}  // namespace attacked_estimation_test
}  // namespace framewatch::daemon
