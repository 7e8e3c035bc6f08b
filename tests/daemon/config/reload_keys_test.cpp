// SPDX-License-Identifier: MIT
#include <map>

#include <gtest/gtest.h>

#include "daemon/config/changes.h"
#include "daemon/config/keys/section_table.h"
#include "tests/support/config_fixture.h"
#include "tests/support/key_values.h"

namespace framewatch::daemon {
namespace reload_keys_test {

/// Every section with keys that a running estimation accepts, and the keys that [actions] needs.
const std::string kEverySection =
    std::string(test::kGoodConfig) +
    "noise_mps2_per_rthz = 0.5\n[estimator]\n[lcm]\n[watch]\n[gap]\n[history]\ndirectory = \"h\"\n"
    "[actions]\ncommand = [\"mail\"]\nwebhook = \"http://here/\"\nemail = [\"a@here\"]\n"
    "time_zone = \"UTC\"\n[email]\nserver = \"here\"\nfrom = \"b@here\"\n[report]\ndirectory = "
    "\"r\"\n"
    "[fleet]\nbuilding = \"a\"\nhubs = [\"tls://a:1\"]\ncertificate = \"c\"\nkey = \"k\"\n"
    "ca = \"ca\"\n";

/// Returns the settings of a section; null if the test does not know it.
const void* settings_of(const Config& c, std::string_view section) {
  if (section == "estimator") return &c.pipeline.options;
  if (section == "channel") return &c.pipeline.axes.back();
  if (section == "lcm") return &c.lcm;
  if (section == "watch") return &*c.watch;
  if (section == "gap") return &*c.gap;
  if (section == "history") return &*c.history;
  if (section == "actions") return &*c.actions;
  if (section == "email") return &*c.email;
  if (section == "report") return &*c.report;
  if (section == "fleet") return &*c.fleet;
  return nullptr;
}

/// Returns the text without a key that cannot stand beside this one.
std::string without_rival(const Option& o, std::string text) {
  const std::string rival = "\nwebhook = ";
  if (o.key != "webhook_file") return text;
  const std::size_t at = text.find(rival);
  return text.erase(at, text.find('\n', at + 1) - at);
}

/// Returns the text with this key of the section's last table set to a value.
std::string with(const Option& o, const std::string& value) {
  const std::string key = std::string(o.key) + " = ", heading(find_section(o.section)->heading);
  std::string text = without_rival(o, kEverySection);
  const std::size_t at = text.rfind(heading + "\n");
  const std::size_t old = text.find("\n" + key, at), end = text.find("\n[", at);
  if (old < end) text.erase(old + 1, text.find('\n', old + 1) - old);
  return text.insert(at + heading.size() + 1, key + value + "\n");
}

/// Returns values that satisfy rules between keys.
std::string value_for(const Option& o) {
  if (o.key == "webhook") return "\"http://there/\"";
  if (o.key == "webhook_file") return "\"there\"";
  if (o.key == "webhook_format") return "\"teams\"";
  if (o.key == "webhook_key_file") return "\"there\"\nwebhook_format = \"pagerduty\"";
  if (o.key == "email") return "[\"c@there\"]";
  if (o.key == "from") return "\"c@there\"";
  if (o.key == "tls") return "\"tls\"";
  if (o.key == "quiet_hours") return "\"22:00-07:00\"";
  if (o.key == "well_at") return "\"08:00\"";
  if (o.key == "time_zone") return "\"Europe/Rome\"";
  if (o.key == "escalate") return "[\"webhook\", \"command\"]";
  if (o.key == "hubs") return "[\"tls://there:1\"]";
  if (o.key == "accept") return "[\"raw\"]";
  return test::another_value(o);
}

TEST(ReloadedConfig, TakesEveryKeyOfItsReloadClassAndNoOther) {
  const Config running = test::good(kEverySection);
  int taken = 0;
  for (const Option& o : options()) {
    if (!o.reload || !o.target || o.reload == Reach::restart) continue;
    SCOPED_TRACE(std::string(o.section) + "." + std::string(o.key));
    const Config fresh = test::good(with(o, value_for(o)));
    const void* before = settings_of(running, o.section);
    ASSERT_NE(before, nullptr) << "settings_of() does not know the section";
    ASSERT_FALSE(o.target.same(before, settings_of(fresh, o.section)));
    const Config next = reloaded(running, fresh);
    EXPECT_TRUE(o.target.same(settings_of(next, o.section), settings_of(fresh, o.section)));
    EXPECT_EQ(next.sha256, fresh.sha256);
    ++taken;
  }
  EXPECT_GT(taken, 25);
}

TEST(ReloadedConfig, KeepsKeysThatNeedARestart) {
  const Config running = test::good(kEverySection);
  Config other = running;
  other.lcm.url = "udpm://other:1";
  other.pipeline.options.rate_hz = 50;
  other.pipeline.axes.back().scale = 7;
  other.history->keep_days = 7;
  other.pipeline.structure.name = "other";
  other.can.buses.emplace_back();
  const Config next = reloaded(running, other);
  EXPECT_EQ(next.lcm.url, running.lcm.url);
  EXPECT_EQ(next.pipeline.options.rate_hz, running.pipeline.options.rate_hz);
  EXPECT_EQ(next.pipeline.axes.back().scale, running.pipeline.axes.back().scale);
  EXPECT_EQ(next.history->keep_days, running.history->keep_days);
  EXPECT_EQ(next.pipeline.structure.name, running.pipeline.structure.name);
  EXPECT_TRUE(next.can.buses.empty());
}

TEST(ReloadedConfig, TakesWholeSectionsAndDerivedValues) {
  const Config running = test::good(test::kGoodConfig);
  const Config fresh = test::good(kEverySection);
  const Config next = reloaded(running, fresh);
  EXPECT_TRUE(next.watch && next.gap && next.actions);
  EXPECT_FALSE(next.history);
  EXPECT_EQ(next.pipeline.options.long_window_s, fresh.watch->options.quiet_window_s);
  const Config back = reloaded(next, running);
  EXPECT_FALSE(back.watch || back.gap || back.actions);
  EXPECT_EQ(back.pipeline.options.long_window_s, 0);
}

/// Returns the classes of the changes between two texts.
std::map<std::string, Reach> reaches(const std::string& before, const std::string& after) {
  std::vector<TextProblem> problems;
  std::map<std::string, Reach> out;
  for (const ConfigChange& c :
       changes_between(*parse_toml(before, problems), *parse_toml(after, problems)))
    out[c.key] = c.reach;
  return out;
}

TEST(ReloadedConfig, UsesTheReloadClassesOfTheTable) {
  for (const Option& o : options()) {
    if (!o.reload) continue;
    const std::string path = std::string(o.section) + "." + std::string(o.key);
    const auto found = reaches("", path + " = 1\n");
    ASSERT_EQ(found.size(), 1u) << path;
    // source = { can = ... } is not a section by its path. It needs a restart, like all of source.
    EXPECT_EQ(found.begin()->second, *o.reload) << path;
  }
}

TEST(ReloadedConfig, AnEmptySectionCountsAsAChangeIfItEnablesAFeature) {
  for (const char* section : {"watch", "gap", "actions"})
    EXPECT_EQ(reaches("", "[" + std::string(section) + "]\n").at(section), Reach::settings);
  for (const char* section : {"history", "estimator", "lcm", "structure.design", "unheard_of"})
    EXPECT_EQ(reaches("", "[" + std::string(section) + "]\n").at(section), Reach::restart);
}

}  // namespace reload_keys_test
}  // namespace framewatch::daemon
