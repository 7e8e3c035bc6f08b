// SPDX-License-Identifier: MIT
#include <framewatch/window_estimate_t.hpp>

#include "daemon/monitor/live/reloader.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/live/live_estimation.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/config_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace reload_test {

using test::read_file;
using test::TemporaryDirectory;
using test::write_file;

constexpr double kSeconds = 12;
constexpr int kBeforeReload = 10 * 900;  // events: 9 s of ten nodes

std::vector<ConfigChange> changes(const std::string& before, const std::string& after) {
  std::vector<TextProblem> problems;
  return changes_between(*parse_toml(before, problems), *parse_toml(after, problems));
}

TEST(ConfigChanges, IgnoreLayoutCommentsAndOrder) {
  EXPECT_TRUE(changes("[a]\nx = 1\ny = [1, 2]\n", "# new\n[a]\ny = [1,2]\nx = 1.0\n").empty());
}

TEST(ConfigChanges, StateTheirReloadClass) {
  const std::string before =
      "[structure]\nstories = 2\n[estimator]\nmin_snr = 10\n"
      "[[channel]]\nname = \"a\"\n[[channel]]\nname = \"b\"\nnoise_mps2_per_rthz = 1e-4\n";
  std::string after = before;
  after.replace(after.find("= 10"), 4, "= 12");
  after.replace(after.find("1e-4"), 4, "2e-4");
  after.replace(after.find("= 2\n"), 3, "= 3");
  after += "[watch]\n";
  const auto found = changes(before, after);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].key, "channel[2].noise_mps2_per_rthz");
  EXPECT_EQ(found[0].reach, Reach::window);
  EXPECT_EQ(found[1].described(), "estimator.min_snr: 10 -> 12");
  EXPECT_EQ(found[1].reach, Reach::settings);
  EXPECT_EQ(found[2].described(), "structure.stories: 2 -> 3");
  EXPECT_EQ(found[2].reach, Reach::restart);
  EXPECT_EQ(found[2].place.line, 2);
  EXPECT_EQ(found[3].described(), "watch: not given -> {}");
  EXPECT_EQ(found[3].reach, Reach::settings);
}

TEST(ConfigChanges, ApplyNotificationSettingsWithoutARestart) {
  const auto found = changes("", "[actions]\nwebhook = \"http://a\"\n");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].reach, Reach::settings);
}

class Reloading : public testing::Test {
 protected:
  void SetUp() override {
    write(test::kGoodConfig);
    std::vector<ConfigProblem> problems;
    config_ = *parse_config(path_, test::kGoodConfig, problems);
  }
  void write(const std::string& text) { write_file(path_, text); }
  /// Reads the file again and returns the log lines.
  std::string read(Reloader& reloader, std::optional<Reloader::Result>& result) {
    testing::internal::CaptureStderr();
    result = reloader.read(config_);
    return testing::internal::GetCapturedStderr();
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_.path("b.toml");
  Config config_;
};

TEST_F(Reloading, RefusesAWrongFileAnotherStructureAndAMissingFile) {
  Reloader reloader(config_, test::kGoodConfig);
  std::optional<Reloader::Result> result;
  write(std::string(test::kGoodConfig) + "\n[estimator]\nmin_snr = \"many\"\n");
  EXPECT_NE(read(reloader, result).find("min_snr"), std::string::npos);
  EXPECT_FALSE(result);
  std::string wider = test::kGoodConfig;
  wider.replace(wider.find("node_mass_kg = 20.0"), 19, "node_mass_kg = 21.0");
  write(wider);
  const std::string said = read(reloader, result);
  EXPECT_NE(said.find("b.toml:8:"), std::string::npos) << said;
  EXPECT_NE(said.find("node_mass_kg: 20 -> 21: needs a restart"), std::string::npos) << said;
  EXPECT_NE(said.find("stays in force"), std::string::npos);
  std::filesystem::remove(path_);
  EXPECT_NE(read(reloader, result).find("No such file"), std::string::npos);
  EXPECT_EQ(reloader.count().refused, 3);
  EXPECT_NE(reloader.count().problem, "");

  write(std::string(test::kGoodConfig) + "\n[estimator]\nmin_snr = 20\n");
  read(reloader, result);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->reach, Reach::settings);
  EXPECT_EQ(result->config.pipeline.options.min_snr, 20);
  EXPECT_EQ(reloader.count().done, 1);
  EXPECT_EQ(reloader.count().problem, "");
  // A second reading finds no changes.
  EXPECT_NE(read(reloader, result).find("0 changes"), std::string::npos);
}

/// The estimates, by the end of their window, of a log during which the configuration changes.
class ReloadedRun {
 public:
  explicit ReloadedRun(const std::string& more, Reach reach, const std::string& log) {
    const std::string text = read_file(test::table_config());
    std::vector<ConfigProblem> problems;
    const Config config = *parse_config("b.toml", text, problems);
    drivers::LcmProvider lcm("memq://");
    lcm.subscribe("FRAMEWATCH_ESTIMATE", &ReloadedRun::keep, this)->setQueueCapacity(100000);
    LiveEstimation live(config, lcm);
    drivers::LcmLogReader reader;
    EXPECT_TRUE(reader.open(log));
    int n = 0;
    for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event; ++n) {
      lcm.publish(e.channel, e.data.data(), static_cast<unsigned>(e.data.size()));
      if (n == kBeforeReload && !more.empty()) {
        const auto fresh = parse_config("b.toml", text + more, problems);
        EXPECT_TRUE(fresh) << problems.front().message;
        before_ = estimates_.size();
        live.reconfigure(reloaded(live.config(), *fresh), reach);
        EXPECT_EQ(live.config().sha256, fresh->sha256);
      }
      EXPECT_TRUE(live.poll(0));
    }
    while (lcm.handleTimeout(100) > 0) {
    }
    lost_ = live.estimation().intake().lost();
  }
  void keep(const lcm::ReceiveBuffer* buffer, const std::string&) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    estimates_.emplace_back(bytes, bytes + buffer->data_size);
  }
  int valid_after(std::size_t first) const {
    int valid = 0;
    for (std::size_t i = first; i < estimates_.size(); ++i)
      valid += drivers::decoded<window_estimate_t>(estimates_[i])->status == 1 ? 1 : 0;
    return valid;
  }
  std::vector<std::vector<std::uint8_t>> estimates_;
  std::size_t before_ = 0;
  std::int64_t lost_ = 0;
};

TEST_F(Reloading, SettingsOutsideTheWindowChangeNoBitOfAnEstimate) {
  const std::string log = directory_.path("rec.lcmlog");
  test::record_table_test(log, kSeconds);
  const ReloadedRun uncut("", Reach::settings, log);
  ASSERT_GT(uncut.estimates_.size(), 500u);
  const ReloadedRun reloaded("\n[watch]\nlearn_s = 30\n[gap]\n", Reach::settings, log);
  EXPECT_GT(reloaded.before_, 100u);
  EXPECT_EQ(reloaded.lost_, 0);
  EXPECT_TRUE(reloaded.estimates_ == uncut.estimates_);

  // The window starts empty because its samples are weighted by the old weights of the rows. A
  // second later there are values again.
  const ReloadedRun anew("\n[watch]\n", Reach::window, log);
  EXPECT_GT(uncut.valid_after(anew.before_), 200);
  EXPECT_LT(anew.valid_after(anew.before_), uncut.valid_after(anew.before_) - 80);
  EXPECT_EQ(anew.lost_, 0);
}

}  // namespace reload_test
}  // namespace framewatch::daemon
