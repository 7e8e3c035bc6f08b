// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "tests/support/config_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace weather_test {

const char* const kDbc = R"(VERSION ""
BS_:
BU_: A
BO_ 512 Ambient: 4 A
 SG_ Outside : 0|16@1- (0.01,0) [0|0] "K" A
 SG_ Sun : 16|16@1+ (0.1,0) [0|0] "W/m2" A
)";
const std::string kBus = "[[can]]\ninterface = \"can0\"\ndbc = [\"n.dbc\"]\n";

std::optional<Config> config_of(const std::string& more, std::string& problems) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("n.dbc"), kDbc);
  std::vector<ConfigProblem> found;
  auto out = parse_config(directory.path("c.toml"), test::kGoodConfig + more, found);
  problems.clear();
  for (const ConfigProblem& p : found) problems += p.message + "\n";
  return out;
}

std::string problems_of(const std::string& more) {
  std::string out;
  (void)config_of(more, out);
  return out;
}

TEST(ConfigWeather, ReadsCovariatesOfEverySource) {
  std::string problems;
  const auto config = config_of(kBus + R"(
[[weather]]
name = "humidity_pct"
[[weather]]
name = "inside_degc"
source = { lcm = "ROOMS" }
away_after_s = 7200
[[weather]]
name = "roof_degc"
source = { thermometer = "TEMPERATURE" }
stuck_after_s = 0
[[weather]]
name = "sun_wpm2"
source = { can = "can0", dbc_signal = "Ambient.Sun" }
scale = 2
offset = 3
)",
                                problems);
  ASSERT_TRUE(config) << problems;
  ASSERT_EQ(config->weather.size(), 4u);
  EXPECT_EQ(config->weather[0].lcm_channel, "WEATHER");
  EXPECT_EQ(config->weather[0].stuck_after_s, 0);
  EXPECT_EQ(config->weather[1].lcm_channel, "ROOMS");
  EXPECT_EQ(config->weather[1].away_after_s, 7200);
  EXPECT_EQ(config->weather[1].stuck_after_s, 3 * 86400);
  EXPECT_EQ(config->weather[2].thermometer, "TEMPERATURE");
  EXPECT_EQ(config->weather[2].stuck_after_s, 0);
  ASSERT_EQ(config->can.values.size(), 1u);
  EXPECT_EQ(config->can.values[0].covariate, 3u);
  EXPECT_EQ(config->can.values[0].message.id, 512u);
  EXPECT_FALSE(config->can.empty());
}

TEST(ConfigWeather, TheThermometerOfWatchCountsWithoutATable) {
  std::string problems;
  const std::string watch = "[watch]\ntemperature_channel = \"T\"\n";
  const auto config = config_of(watch, problems);
  ASSERT_TRUE(config) << problems;
  ASSERT_EQ(config->weather.size(), 1u);
  EXPECT_EQ(config->weather[0].name, "temperature_degc");
  EXPECT_EQ(config->weather[0].thermometer, "T");
  const auto named = config_of(
      "[[weather]]\nname = \"roof_degc\"\nsource = { thermometer = \"T\" }\n" + watch, problems);
  ASSERT_TRUE(named) << problems;
  ASSERT_EQ(named->weather.size(), 1u);
  EXPECT_EQ(named->weather[0].name, "roof_degc");
}

TEST(ConfigWeather, ReportsEveryProblem) {
  const auto expect = [](const std::string& more, const std::string& part) {
    const std::string all = problems_of(more);
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
  };
  const std::string out = "[[weather]]\nname = \"outside_degc\"\n";
  expect("[[weather]]\n", "name");
  expect("[[weather]]\nname = \"outside\"\n", "must end with its unit: _degc, _pct, _mps or _wpm2");
  expect("[[weather]]\nname = \"a,b_degc\"\n", "must not hold a comma");
  expect(out + out, "outside_degc is the name of another one");
  expect(out + "scale = 0\n", "scale: must not be 0");
  expect(out + "away_after_s = 1\n", "away_after_s");
  expect(out + "source = { lcm = \"ACCEL\" }\n", "ACCEL is the LCM channel of samples");
  expect(out + "source = { thermometer = \"ACCEL\" }\n", "ACCEL is the LCM channel of samples");
  expect(out + "source = { lcm = \"\" }\n", "1 to 63 characters");
  expect(out + "source = { can = \"can0\" }\n", "can and dbc_signal belong together");
  expect(out + "source = { can = \"can0\", dbc_signal = \"Ambient.Outside\" }\n",
         "no [[can]] has interface = \"can0\"");
  expect(kBus + out + "source = { can = \"can0\", dbc_signal = \"Ambient.Outsid\" }\n",
         "did you mean Outside?");
  expect("[[weather]]\nname = \"wind_mps\"\nsource = { thermometer = \"T\" }\n",
         "needs a temperature");
  expect("[weather]\nname = \"wind_mps\"\n", "weather");
  std::string many;
  for (int i = 0; i < 21; ++i)
    many += "[[weather]]\nname = \"room" + std::to_string(i) + "_degc\"\n";
  expect(many, "at most 20 tables");
}

TEST(ConfigWeather, WarnsOfKelvinInADbcFile) {
  std::string problems;
  const std::string kelvin = kBus + "[[weather]]\nname = \"outside_degc\"\n" +
                             "source = { can = \"can0\", dbc_signal = \"Ambient.Outside\" }\n";
  const auto config = config_of(kelvin, problems);
  ASSERT_TRUE(config) << problems;
  ASSERT_FALSE(config->doubts.empty());
  EXPECT_NE(config->doubts.front().message.find("set offset = 273.15"), std::string::npos);
  const auto good = config_of(kelvin + "offset = 273.15\n", problems);
  ASSERT_TRUE(good) << problems;
  for (const ConfigProblem& doubt : good->doubts)
    EXPECT_EQ(doubt.message.find("273.15"), std::string::npos) << doubt.message;
}

const std::string kRoof = "[[weather]]\nname = \"roof_degc\"\nsource = { mqtt = \"roof/t\" }\n";

TEST(ConfigWeather, ReadsTopicsOfABroker) {
  std::string problems;
  const auto config = config_of(R"(
[mqtt]
url = "mqtts://broker.example.org"
user = "framewatch"
password_file = "secret"
ca_file = "/etc/ca.pem"
[[weather]]
name = "roof_degc"
source = { mqtt = "roof/t", field = "/value", time_field = "/time" }
)",
                                problems);
  ASSERT_TRUE(config) << problems;
  EXPECT_EQ(config->weather[0].mqtt, "roof/t");
  EXPECT_EQ(config->weather[0].field, "/value");
  EXPECT_EQ(config->weather[0].time_field, "/time");
  ASSERT_TRUE(config->mqtt);
  EXPECT_EQ(config->mqtt->url, "mqtts://broker.example.org");
  EXPECT_TRUE(config->mqtt->password_file.ends_with("/secret"));
  EXPECT_EQ(config->mqtt->ca_file, "/etc/ca.pem");
  EXPECT_TRUE(config->doubts.empty() ||
              config->doubts[0].message.find("mqtt") == std::string::npos);
}

TEST(ConfigWeather, DoubtsAPasswordThatCrossesTheNetworkInTheClear) {
  const auto doubts = [](const std::string& host) {
    std::string problems, out;
    const auto config = config_of("[mqtt]\nurl = \"mqtt://" + host +
                                      "\"\nuser = \"me\"\npassword_file = \"secret\"\n" + kRoof,
                                  problems);
    EXPECT_TRUE(config) << problems;
    for (const ConfigProblem& d : config->doubts) out += d.message;
    return out.find("the password crosses the network to " + host) != std::string::npos;
  };
  EXPECT_TRUE(doubts("broker.lan"));
  EXPECT_FALSE(doubts("localhost"));
}

TEST(ConfigWeather, RefusesABrokerAndTopicsThatCannotWork) {
  const auto has = [](const std::string& more, const std::string& problem) {
    const std::string all = problems_of(more);
    EXPECT_NE(all.find(problem), std::string::npos) << more << "\n" << all;
  };
  const std::string broker = "[mqtt]\nurl = \"mqtt://b\"\n";
  const auto source = [&](const std::string& keys) {
    return broker + "[[weather]]\nname = \"roof_degc\"\nsource = { " + keys + " }\n";
  };
  has(kRoof, "needs a section [mqtt]");
  has("[mqtt]\nurl = \"http://b\"\n", "mqtt.url: \"http://b\": must be such as");
  has("[mqtt]\nuser = \"a\"\n", "mqtt.url");
  has(broker + "ca_file = \"x\"\n", "needs TLS");
  has(broker + "password_file = \"x\"\n", "needs user");
  has("[mqtt]\nurl = \"mqtts://b\"\nkey_file = \"x\"\n", "needs certificate_file");
  has("[mqtt]\nurl = \"mqtts://b\"\ncertificate_file = \"x\"\n", "needs key_file");
  has(source("mqtt = \"roof/+/t\""), "must be one topic");
  has(source("mqtt = \"roof/#\""), "must be one topic");
  has(source("mqtt = \"\""), "a topic has 1 to");
  has(source("mqtt = \"t\", field = \"v\""), "must be a JSON pointer");
  has(source("mqtt = \"t\", field = \"/a~2\""), "must be a JSON pointer");
  has(source("field = \"/v\""), "needs mqtt");
  has(source("mqtt = \"t\", time_field = \"/v\""), "needs field");
  has(source("mqtt = \"t\", thermometer = \"T\""), "a covariate has one source");
}

}  // namespace weather_test
}  // namespace framewatch::daemon
