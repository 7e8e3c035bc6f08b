// SPDX-License-Identifier: MIT
#include "daemon/config/keys/target.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "daemon/config/keys/about_options.h"
#include "daemon/config/keys/action_options.h"
#include "daemon/config/keys/can_options.h"
#include "daemon/config/keys/channel_options.h"
#include "daemon/config/keys/event_report_options.h"
#include "daemon/config/keys/fleet_options.h"
#include "daemon/config/keys/history_options.h"
#include "daemon/config/keys/lcm_options.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/keys/section_table.h"
#include "daemon/config/keys/watch_options.h"
#include "daemon/config/keys/weather_options.h"
#include "drivers/can/can_map.h"
#include "drivers/mqtt/mqtt_settings.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/sensors.h"
#include "tests/support/key_values.h"

namespace framewatch::daemon {
namespace target_test {

std::string name_of(const Option& o) {
  return std::string(o.section) + "." + std::string(o.key);
}

TEST(KeyTargets, EveryKeyHasAFieldOrAReasonWhyNot) {
  for (const Option& o : options()) {
    const SectionDescription* section = find_section(o.section);
    ASSERT_NE(section, nullptr) << name_of(o);
    if (!section->reload || o.section == "effect") continue;
    EXPECT_NE(static_cast<bool>(o.target), !o.by_hand.empty()) << name_of(o);
    EXPECT_TRUE(o.reload) << name_of(o);
  }
}

TEST(KeyTargets, FieldsHaveTheTypesOfTheirKeys) {
  for (const Option& o : options()) {
    if (!o.target) continue;
    EXPECT_TRUE(o.target.takes(o.type)) << name_of(o);
    EXPECT_FALSE(o.is_path && o.target.text == nullptr) << name_of(o);
  }
}

/// Reads keys of one section into its settings.
template <class Settings>
Settings read(std::string_view section, const std::string& text) {
  std::vector<TextProblem> problems;
  const TomlValue table = *parse_toml(text, problems);
  Settings out;
  ConfigSection(section, std::string(section), &table, {}, problems).read_into(out);
  return out;
}

/// A structure without a name, and an axis without a source, are legal in code.
const std::set<std::string> kDefaultsOfTheTableOnly{"structure.name", "channel.source.lcm"};

template <class Settings>
void round_trip(std::string_view section, int& keys) {
  const Settings unread, absent = read<Settings>(section, "");
  for (const Option& o : options()) {
    if (o.section != section || o.target.owner != &kOwner<Settings>) continue;
    SCOPED_TRACE(name_of(o));
    const auto is_default = [&](const Settings& s) { return o.target.same(&s, &absent); };
    if (!o.required && !kDefaultsOfTheTableOnly.contains(name_of(o))) {
      EXPECT_TRUE(is_default(unread)) << "reading the default's text changes the field";
    }
    const std::string text = std::string(o.key) + " = " + test::another_value(o) + "\n";
    const Settings changed = read<Settings>(section, text);
    EXPECT_FALSE(is_default(changed)) << text;
    // No field of another key changes.
    for (const Option& other : options())
      if (&other != &o && other.section == section && other.target.owner == &kOwner<Settings>) {
        EXPECT_TRUE(other.target.same(&changed, &absent)) << name_of(other);
      }
    Settings copied = absent;
    o.target.copy(&changed, &copied);
    EXPECT_TRUE(o.target.same(&copied, &changed));
    ++keys;
  }
}

TEST(KeyTargets, EveryKeyReachesItsFieldAndNoOther) {
  int keys = 0;
  round_trip<estimator::Structure>("structure", keys);
  round_trip<estimator::SensorAxis>("channel", keys);
  round_trip<AxisSource>("channel.source", keys);
  round_trip<AxisSource>("channel.source.can", keys);
  round_trip<estimator::EstimatorOptions>("estimator", keys);
  round_trip<LcmSettings>("lcm", keys);
  round_trip<CommandSettings>("commands", keys);
  round_trip<drivers::CanBusMap>("can", keys);
  round_trip<drivers::CanNodeMap>("can_node", keys);
  round_trip<CanNodeSettings>("can_node", keys);
  round_trip<WeatherSettings>("weather", keys);
  round_trip<WeatherSettings>("weather.source", keys);
  round_trip<drivers::MqttSettings>("mqtt", keys);
  round_trip<WatchSettings>("watch", keys);
  round_trip<GapSettings>("gap", keys);
  round_trip<HistorySettings>("history", keys);
  round_trip<EventReportSettings>("event_report", keys);
  round_trip<FragilitySettings>("fragility", keys);
  round_trip<ActionSettings>("actions", keys);
  round_trip<EmailSettings>("email", keys);
  round_trip<ReportSettings>("report", keys);
  round_trip<FleetSettings>("fleet", keys);
  round_trip<ReportAbout>("about", keys);
  round_trip<ReportPhotograph>("about.photograph", keys);
  int all = 0;
  for (const Option& o : options()) all += o.target ? 1 : 0;
  EXPECT_EQ(keys, all) << "a settings struct is missing above";
}

TEST(KeyTargets, UnitsAndChoicesMatchTheFields) {
  EXPECT_EQ(read<estimator::SensorAxis>("channel", "tilt_deg = 30").tilt, 30 * M_PI / 180);
  EXPECT_EQ(read<drivers::CanNodeMap>("can_node", "latency_s = 0.002").latency_us, 1e6 * 0.002);
  EXPECT_EQ(read<AxisSource>("channel.source", "axis = \"z\"").axis, 2);
  EXPECT_EQ(read<ActionSettings>("actions", "severity = \"alarm\"").severity, 2);
  EXPECT_EQ(read<estimator::EstimatorOptions>("estimator", "variant = \"paper\"").variant,
            estimator::Variant::paper);
  EXPECT_EQ(read<HistorySettings>("history", "summary_s = 30").summary_s,
            std::vector<std::int64_t>{30});
}

TEST(KeyTargets, AWrongValueKeepsTheDefault) {
  EXPECT_EQ(read<LcmSettings>("lcm", "queue_capacity = \"many\"").queue_capacity, 10000);
  EXPECT_EQ(read<estimator::EstimatorOptions>("estimator", "other_windows_s = [[1], 2]\n")
                .other_windows_s,
            (std::vector<double>{1, 2.5, 10}));
}

}  // namespace target_test
}  // namespace framewatch::daemon
