// SPDX-License-Identifier: MIT
// Tests the connection to an MQTT broker: one of our own with faults, and Debian's mosquitto.
#include "drivers/mqtt/mqtt_source.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/child.h"
#include "tests/support/mqtt_broker.h"
#include "tests/support/smtp_server.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace mqtt_source_test {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatient{60};
constexpr const char* kMosquitto = "/usr/sbin/mosquitto";

/// Waits until it is so. Returns false if it is not so for a long time.
bool await(const std::function<bool()>& so) {
  for (const auto until = Clock::now() + kPatient; Clock::now() < until;) {
    if (so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return so();
}

std::optional<std::string> no_secret(std::string& trouble) {
  trouble = "no secret";
  return std::nullopt;
}

MqttSettings settings(const std::string& url) {
  MqttSettings out;
  out.url = url;
  return out;
}

/// Collects messages until there are so many.
std::vector<MqttMessage> take(MqttSource& source, std::size_t count) {
  std::vector<MqttMessage> out;
  EXPECT_TRUE(await([&] {
    for (MqttMessage& m : source.take()) out.push_back(std::move(m));
    return out.size() >= count;
  })) << out.size();
  return out;
}

bool subscribed(const test::MqttBroker& broker, std::size_t topics) {
  return await([&] { return broker.topics().size() == topics; });
}

TEST(MqttSource, ReceivesTheTopicsThatItWasGiven) {
  test::MqttBroker broker;
  MqttSource source(settings(broker.url()), {"roof/t", "roof/h"}, no_secret);
  ASSERT_TRUE(subscribed(broker, 2));
  EXPECT_EQ(broker.topics(), (std::vector<std::string>{"roof/t", "roof/h"}));
  EXPECT_EQ(broker.user(), "");
  broker.publish("roof/t", "4.5");
  broker.publish("roof/h", std::string("\0x", 2), true);
  broker.publish("roof/t", "");
  const std::vector<MqttMessage> heard = take(source, 3);
  ASSERT_EQ(heard.size(), 3u);
  EXPECT_EQ(heard[0].topic, "roof/t");
  EXPECT_EQ(heard[0].payload, "4.5");
  EXPECT_FALSE(heard[0].retained);
  EXPECT_EQ(heard[1].payload, std::string("\0x", 2));
  EXPECT_TRUE(heard[1].retained);
  EXPECT_EQ(heard[2].payload, "");
  const MqttState state = source.state();
  EXPECT_TRUE(state.connected);
  EXPECT_EQ(state.trouble, "");
  EXPECT_EQ(state.connections, 1);
  EXPECT_EQ(state.messages, 3);
  EXPECT_EQ(state.dropped, 0);
}

TEST(MqttSource, ConnectsToABrokerThatComesLateAndAgainAfterItWasGone) {
  auto broker = std::make_unique<test::MqttBroker>();
  const int port = broker->port();
  broker.reset();
  MqttSource source(settings("mqtt://127.0.0.1:" + std::to_string(port)), {"t"}, no_secret);
  ASSERT_TRUE(await([&] { return !source.state().trouble.empty(); }));
  EXPECT_EQ(source.state().trouble, "Connection refused");
  EXPECT_FALSE(source.state().connected);
  broker = std::make_unique<test::MqttBroker>(port);
  ASSERT_TRUE(subscribed(*broker, 1));
  EXPECT_TRUE(await([&] { return source.state().connected; }));
  EXPECT_EQ(source.state().trouble, "");
  broker->hang_up();
  ASSERT_TRUE(await([&] { return broker->connections() == 2; }));
  ASSERT_TRUE(subscribed(*broker, 1));
  broker->publish("t", "1");
  EXPECT_EQ(take(source, 1).front().payload, "1");
  EXPECT_EQ(source.state().connections, 2);
}

TEST(MqttSource, DropsWhatDoesNotFitAndCountsIt) {
  test::MqttBroker broker;
  MqttSettings few = settings(broker.url());
  few.queue_capacity = 3;
  MqttSource source(few, {"t"}, no_secret);
  ASSERT_TRUE(subscribed(broker, 1));
  broker.publish("t", std::string(MqttSource::kMostPayload_bytes + 1, '1'));
  for (int i = 0; i < 10; ++i) broker.publish("t", std::to_string(i));
  ASSERT_TRUE(await([&] { return source.state().messages == 11; }));
  EXPECT_EQ(source.state().too_long, 1);
  EXPECT_EQ(source.state().dropped, 7);
  const std::vector<MqttMessage> heard = take(source, 3);
  EXPECT_EQ(heard.size(), 3u);
  EXPECT_EQ(heard.front().payload, "0");
  broker.publish("t", "later");
  EXPECT_EQ(take(source, 1).front().payload, "later");
}

TEST(MqttSource, LogsInAndTellsARefusal) {
  test::MqttBroker broker(0, {.answer = 5, .silent = false, .refused = {}});
  MqttSettings login = settings(broker.url());
  login.user = "framewatch";
  login.password_file = "given";
  const MqttSource source(login, {"t"}, [](std::string&) { return std::optional("pass word"); });
  ASSERT_TRUE(await([&] { return !source.state().trouble.empty(); }));
  EXPECT_NE(source.state().trouble.find("not authorised"), std::string::npos)
      << source.state().trouble;
  EXPECT_EQ(source.state().trouble.find("pass word"), std::string::npos);
  EXPECT_EQ(source.state().connections, 0);
  EXPECT_EQ(broker.user(), "framewatch");
  EXPECT_EQ(broker.password(), "pass word");
  login.password_file = "missing";
  const MqttSource without(login, {"t"}, no_secret);
  ASSERT_TRUE(await([&] { return !without.state().trouble.empty(); }));
  EXPECT_EQ(without.state().trouble, "no secret");
}

TEST(MqttSource, TellsATopicThatTheBrokerRefuses) {
  test::MqttBroker broker(0, {.answer = 0, .silent = false, .refused = {"secret"}});
  MqttSource source(settings(broker.url()), {"secret", "t"}, no_secret);
  ASSERT_TRUE(await([&] { return !source.state().trouble.empty(); }));
  EXPECT_EQ(source.state().trouble, "the broker refuses the topic secret");
  EXPECT_TRUE(source.state().connected);
  ASSERT_TRUE(subscribed(broker, 1));
  broker.publish("t", "1");
  EXPECT_EQ(take(source, 1).size(), 1u);
}

TEST(MqttSource, StopsWhileABrokerDoesNotAnswer) {
  test::MqttBroker broker(0, {.answer = 0, .silent = true, .refused = {}});
  const auto began = Clock::now();
  {
    const MqttSource source(settings(broker.url()), {"t"}, no_secret);
    ASSERT_TRUE(await([&] { return broker.connections() == 1; }));
    EXPECT_FALSE(source.state().connected);
  }
  EXPECT_LT(Clock::now() - began, std::chrono::seconds(30));
}

TEST(MqttSource, TellsAHostAndAFileThatDoNotExist) {
  const MqttSource nowhere(settings("mqtt://nowhere.invalid"), {"t"}, no_secret);
  MqttSettings missing = settings("mqtts://127.0.0.1");
  missing.ca_file = "/nonexistent/ca.pem";
  const MqttSource without(missing, {"t"}, no_secret);
  ASSERT_TRUE(await([&] { return !without.state().trouble.empty(); }));
  EXPECT_EQ(without.state().trouble, "/nonexistent/ca.pem: cannot be read");
  ASSERT_TRUE(await([&] { return !nowhere.state().trouble.empty(); }));
  EXPECT_NE(nowhere.state().trouble.find("nowhere.invalid"), std::string::npos)
      << nowhere.state().trouble;
}

/// mosquitto on a port, with TLS and a password file.
struct Mosquitto {
  explicit Mosquitto(int port) : made(folder), url("mqtts://127.0.0.1:" + std::to_string(port)) {
    test::write_file(folder.path("conf"), "user root\nlistener " + std::to_string(port) +
                                              " 127.0.0.1\ncertfile " + made.certificate +
                                              "\nkeyfile " + made.key +
                                              "\nallow_anonymous false\npassword_file " +
                                              folder.path("passwords") + "\nlog_dest none\n");
    good = std::system(("mosquitto_passwd -c -b " + folder.path("passwords") +
                        " roof right >/dev/null 2>&1")
                           .c_str()) == 0;
    if (good) process.emplace(std::vector<std::string>{kMosquitto, "-c", folder.path("conf")});
  }
  /// Sends one message by Debian's own client.
  bool publish(int port, const std::string& more) const {
    return std::system(("mosquitto_pub -h 127.0.0.1 -p " + std::to_string(port) + " --cafile " +
                        made.certificate + " -u roof -P right -t roof/t " + more +
                        " >/dev/null 2>&1")
                           .c_str()) == 0;
  }
  test::TemporaryDirectory folder;
  test::TestCertificate made;
  std::string url;
  bool good = false;
  std::optional<test::Child> process;
};

TEST(MqttSource, UnderstandsMosquittoWithTlsAndPassword) {
  if (!std::filesystem::exists(kMosquitto) || std::system("command -v mosquitto_pub >/dev/null"))
    GTEST_SKIP() << "no mosquitto and mosquitto_pub here: deploy/install-deps --with test";
  constexpr int kPort = 28883;  // of this test's own network
  const Mosquitto broker(kPort);
  ASSERT_TRUE(broker.good);
  ASSERT_TRUE(await([&] { return broker.publish(kPort, "-r -m 3"); }));
  MqttSettings login = settings(broker.url);
  login.user = "roof";
  login.password_file = "given";
  const auto secret = [](const char* word) {
    return [word](std::string&) { return std::optional<std::string>(word); };
  };
  const MqttSource untrusting(login, {"roof/t"}, secret("right"));
  ASSERT_TRUE(await([&] { return !untrusting.state().trouble.empty(); }));
  EXPECT_NE(untrusting.state().trouble.find("certificate verify failed"), std::string::npos)
      << untrusting.state().trouble;
  login.ca_file = broker.made.certificate;
  const MqttSource wrong(login, {"roof/t"}, secret("wrong"));
  ASSERT_TRUE(await([&] { return !wrong.state().trouble.empty(); }));
  EXPECT_NE(wrong.state().trouble.find("not authorised"), std::string::npos)
      << wrong.state().trouble;
  MqttSource source(login, {"roof/t"}, secret("right"));
  const std::vector<MqttMessage> kept = take(source, 1);
  EXPECT_EQ(kept.front().payload, "3");
  EXPECT_TRUE(kept.front().retained);
  ASSERT_TRUE(broker.publish(kPort, "-m 4.5"));
  const std::vector<MqttMessage> fresh = take(source, 1);
  EXPECT_EQ(fresh.front().payload, "4.5");
  EXPECT_FALSE(fresh.front().retained);
}

TEST(MqttAddress, IsAHostWithAPort) {
  EXPECT_EQ(mqtt_address("mqtt://broker.example.org")->port, 1883);
  EXPECT_EQ(mqtt_address("mqtts://broker.example.org/")->port, 8883);
  EXPECT_TRUE(mqtt_address("mqtts://b")->tls);
  EXPECT_EQ(mqtt_address("mqtts://b:1")->port, 1);
  EXPECT_EQ(mqtt_address("mqtt://[::1]:70")->host, "::1");
  EXPECT_EQ(mqtt_address("mqtt://[::1]:70")->port, 70);
  EXPECT_TRUE(is_this_machine(*mqtt_address("mqtt://[::1]")));
  EXPECT_TRUE(is_this_machine(*mqtt_address("mqtt://127.0.0.1:5")));
  EXPECT_FALSE(is_this_machine(*mqtt_address("mqtt://192.168.0.1")));
  for (const char* wrong :
       {"", "broker", "http://b", "mqtt://", "mqtt://:1883", "mqtt://b:", "mqtt://b:0",
        "mqtt://b:65536", "mqtt://b:1x", "mqtt://u:p@b", "mqtt://u@b", "mqtt://b/t", "mqtt://[::1",
        "mqtt://[::1]x", "mqtt://a b", "mqtt://a\nb", "mqtts:///"})
    EXPECT_FALSE(mqtt_address(wrong)) << wrong;
}

}  // namespace mqtt_source_test
}  // namespace framewatch::drivers
