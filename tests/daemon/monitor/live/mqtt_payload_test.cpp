// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/mqtt_payload.h"

#include <string>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"

namespace framewatch::daemon {
namespace mqtt_payload_test {

constexpr std::int64_t kNoon_us = 1'795'305'600 * kSecond_us;  // 2026-11-22T00:00:00Z

WeatherSettings covariate(const std::string& field, const std::string& time_field = "") {
  WeatherSettings out;
  out.field = field;
  out.time_field = time_field;
  return out;
}

/// Returns the value that read_mqtt_payload() finds. The test fails if it finds none.
double value(const std::string& payload, const WeatherSettings& of) {
  std::string problem;
  const auto out = read_mqtt_payload(payload, of, problem);
  EXPECT_TRUE(out) << problem;
  EXPECT_EQ(problem, "");
  return out ? out->value : -1e9;
}

std::string problem_of(const std::string& payload, const WeatherSettings& of) {
  std::string problem;
  EXPECT_FALSE(read_mqtt_payload(payload, of, problem)) << payload;
  return problem;
}

TEST(MqttPayload, IsANumberOrJson) {
  EXPECT_EQ(value("4.5", covariate("")), 4.5);
  EXPECT_EQ(value(" -1e1\r\n", covariate("")), -10);
  EXPECT_EQ(value(R"({"temperature": 21.5, "humidity": 40})", covariate("/temperature")), 21.5);
  EXPECT_EQ(value(R"({"a": [{"v": "7"}]})", covariate("/a/0/v")), 7);
  EXPECT_EQ(value(R"({"a/b": {"~": 3}})", covariate("/a~1b/~0")), 3);
}

TEST(MqttPayload, OtherwiseSaysWhatItIs) {
  for (const char* payload : {"", "on", "4,5", "nan", "inf", "4.5 degC", "1e999"})
    EXPECT_EQ(problem_of(payload, covariate("")),
              "\"" + std::string(payload) + "\" is not a number");
  EXPECT_EQ(problem_of("{", covariate("/t")), "\"{\" is not JSON");
  EXPECT_EQ(problem_of(R"({"t": "off"})", covariate("/t")),
            R"("{"t": "off"}" has no number at /t)");
  for (const char* payload : {R"({"t": null})", R"({"t": true})", R"({"t": {}})", "[1]", "1", "{}"})
    EXPECT_NE(problem_of(payload, covariate("/t")).find("has no number"), std::string::npos);
  EXPECT_NE(problem_of("[1]", covariate("/01")).find("has no number"), std::string::npos);
  EXPECT_EQ(problem_of(std::string(100, 'x'), covariate("")).size(), 40 + 2 + 2 + 16);
  EXPECT_NE(problem_of("\xff\x01", covariate("")).find("is not a number"), std::string::npos);
  std::string deep(60'000, '[');
  EXPECT_NE(problem_of(deep, covariate("/t")).find("is not JSON"), std::string::npos);
  deep += std::string(60'000, ']');
  EXPECT_NE(problem_of(deep, covariate("/t")).find("has no number"), std::string::npos);
}

TEST(MqttPayload, HasATimeWhereTheSettingsSay) {
  const auto time_of = [](const std::string& time) {
    std::string problem;
    const auto out =
        read_mqtt_payload(R"({"v": 1, "t": )" + time + "}", covariate("/v", "/t"), problem);
    EXPECT_EQ(out.has_value(), problem.empty());
    return out ? *out->time_us - kNoon_us : -1;
  };
  EXPECT_EQ(time_of("\"2026-11-22T00:00:00Z\""), 0);
  EXPECT_EQ(time_of("\"2026-11-22T00:00:01.250Z\""), 1'250'000);
  EXPECT_EQ(time_of("\"2026-11-22T01:00:01+01:00\""), 1'000'000);
  EXPECT_EQ(time_of("\"2026-11-21T20:30:00-03:30\""), 0);
  EXPECT_EQ(time_of("1795305600"), 0);
  EXPECT_EQ(time_of("1795305600.5"), 500'000);
  EXPECT_EQ(time_of("1795305600500"), 500'000);
  EXPECT_EQ(time_of("\"1795305601\""), 1'000'000);
  for (const char* wrong :
       {"null", "\"today\"", "true", "-1", "1e300", "\"2026-11-22T00:00:00+1:00\""})
    EXPECT_EQ(time_of(wrong), -1) << wrong;
  EXPECT_NE(problem_of(R"({"v": 1})", covariate("/v", "/t")).find("has no time at /t"),
            std::string::npos);
}

}  // namespace mqtt_payload_test
}  // namespace framewatch::daemon
