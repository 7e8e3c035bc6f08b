// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/first_passes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "drivers/lcm/message_check.h"
#include "tests/daemon/tools/replay/replay_fixture.h"

namespace framewatch::daemon {
namespace first_passes_test {

constexpr double kFirstFull_s = 8.5;  // settling, a window, the filters' delay
constexpr double kArchive_s = 120;    // longer than the minute of motion that a pass takes
constexpr double kMaxRead = 0.8;      // share of the archive

class FirstPassesTest : public test::ReplayFixture {
 protected:
  /// Returns the table's configuration with a design that is `times` as stiff.
  std::string design(double factor) {
    std::string text = test::read_file(test::table_config());
    const auto replace = [&](const std::string& from, const std::string& to) {
      const auto at = text.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      text.replace(at, from.size(), to);
    };
    const auto scaled = [&](double k) { return std::to_string(factor * k); };
    replace("kx_npm = [[38e3, 22e3], [32e3, 19e3]]", "kx_npm = [[" + scaled(38e3) + ", " +
                                                         scaled(22e3) + "], [" + scaled(32e3) +
                                                         ", " + scaled(19e3) + "]]");
    replace("ky_npm = [[23e3, 36e3], [21e3, 33e3]]", "ky_npm = [[" + scaled(23e3) + ", " +
                                                         scaled(36e3) + "], [" + scaled(21e3) +
                                                         ", " + scaled(33e3) + "]]");
    const std::string name = path("design.toml");
    test::write_file(name, text);
    return name;
  }

  /// Returns the sensor time of the end of the first window with a value, s.
  double first_value_s(const std::string& config, bool one_pass) {
    ReplayArguments a;
    a.config = config;
    a.inputs = {log()};
    a.out = path("est.lcmlog");
    a.one_pass = one_pass;
    a.quiet = true;
    EXPECT_EQ(replay(a), 0);
    for (const auto& bytes : test::payloads(a.out, "FRAMEWATCH_ESTIMATE"))
      if (const auto e = drivers::decoded<framewatch::window_estimate_t>(bytes); e->status == 1)
        return static_cast<double>(e->window_end_us) * 1e-6;
    return std::numeric_limits<double>::infinity();
  }
};

TEST_F(FirstPassesTest, AWrongDesignCostsNoFullWindow) {
  for (const double factor : {0.4, 1.0, 2.5}) {
    const std::string config = design(factor);
    const double first_s = first_value_s(config, false);
    EXPECT_LT(first_s, kFirstFull_s) << factor;
    EXPECT_LE(first_s, first_value_s(config, true)) << factor;
  }
}

TEST_F(FirstPassesTest, TheSameInputGivesTheSameBytesAndOneLine) {
  const std::string config = design(2.5);
  const test::ReplayOutcome once = test::replay_of({log()}, path("a.lcmlog"), false, config);
  ASSERT_EQ(once.exit_code, 0);
  ASSERT_EQ(test::replay_of({log()}, path("b.lcmlog"), false, config).exit_code, 0);
  EXPECT_EQ(test::read_file(path("a.lcmlog")), test::read_file(path("b.lcmlog")));
  EXPECT_NE(once.err.find("tuned on the record first: "), std::string::npos) << once.err;
  EXPECT_NE(once.err.find(" passes\n"), std::string::npos) << once.err;
}

TEST_F(FirstPassesTest, ReportsTooLittleMotionToTuneOn) {
  std::string still = test::read_file(csv());
  still = still.substr(0, still.find('\n') + 1);
  const auto columns = std::count(still.begin(), still.end(), ',');
  for (int i = 0; i < 1200; ++i) {
    still += std::to_string(i * 0.01).substr(0, 5);
    for (auto c = columns; c > 0; --c) still += ",0";
    still += "\n";
  }
  test::write_file(path("still.csv"), still);
  const test::ReplayOutcome o = test::replay_of({path("still.csv")});
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_NE(o.err.find("too little motion to tune on first"), std::string::npos) << o.err;
}

TEST_F(FirstPassesTest, ReadsOnlyTheFirstMinuteOfMotionOfAnArchive) {
  const std::string archive = path("archive.lcmlog");
  test::record_table_test(archive, kArchive_s);
  std::vector<ConfigProblem> problems;
  const auto config = load_config(test::table_config(), problems);
  ASSERT_TRUE(config);
  std::int64_t read = 0;
  const FirstPasses first(*config, {{archive}}, [&](std::int64_t bytes) { read = bytes; });
  ASSERT_TRUE(first.tuning());
  EXPECT_TRUE(first.tuning()->found_right);
  EXPECT_EQ(first.passes(), 1);
  EXPECT_LT(static_cast<double>(read),
            kMaxRead * static_cast<double>(std::filesystem::file_size(archive)));
}

TEST_F(FirstPassesTest, GivesNoTuningForUnreadableInput) {
  std::vector<ConfigProblem> problems;
  const auto config = load_config(test::table_config(), problems);
  ASSERT_TRUE(config);
  EXPECT_FALSE(FirstPasses(*config, {{path("nowhere.lcmlog")}}).tuning());
}

}  // namespace first_passes_test
}  // namespace framewatch::daemon
