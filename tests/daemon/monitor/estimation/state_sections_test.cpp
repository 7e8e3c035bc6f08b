// SPDX-License-Identifier: MIT
// A state file is read section by section. One that is damaged, missing or of another configuration
// costs only what depends on it, and the reader reports it.

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/estimation/state_file.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace state_sections_test {

const std::string kSettings =
    "\n[watch]\nlearn_s = 1\n[gap]\n[event_report]\ndirectory = \"reports\"\n";
const std::vector<std::string> kEverySection = {"counts", "events",      "lcm",      "can",
                                                "tuning", "window",      "baseline", "watch",
                                                "gap",    "event_report"};

class StateSections : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new test::TemporaryDirectory;
    test::record_table_test(path("rec.lcmlog"), 12);
    drivers::LcmLogReader reader;
    ASSERT_TRUE(reader.open(path("rec.lcmlog")));
    for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) events_.push_back(e);
    config_ = configured("building.toml", [](std::string&) {});
    Estimation estimation(config_, {});
    for (const drivers::LogEvent& e : events_)
      estimation.message(e.channel, e.data.data(), e.data.size());
    ASSERT_NE(estimation.baseline(), nullptr);
    good_ = saved_state(config_, estimation, 0);
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string path(const std::string& name) { return directory_->path(name); }

  /// Returns the table's configuration with a change.
  static Config configured(const std::string& name,
                           const std::function<void(std::string&)>& change) {
    std::string text = test::read_file(test::table_config()) + kSettings;
    change(text);
    test::write_file(path(name), text);
    std::vector<ConfigProblem> problems;
    const auto config = load_config(path(name), problems);
    for (const ConfigProblem& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
    return config.value_or(Config{});
  }
  static Config replaced(const std::string& what, const std::string& by) {
    return configured("other.toml", [&](std::string& text) {
      ASSERT_NE(text.find(what), std::string::npos) << what;
      text.replace(text.find(what), what.size(), by);
    });
  }

  /// An estimation resumed from the file "state", and the sections that were lost.
  struct Resumed {
    explicit Resumed(const Config& of) : config(of) {
      estimation.emplace(config, sink());
      loaded = load_what_fits(path("state"), config, *estimation, [this]() -> Estimation& {
        return estimation.emplace(config, sink());
      });
    }
    MessageSink sink() {
      return
          [this](std::int64_t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
            if (channel != "FRAMEWATCH_EVENT") return;
            if (const auto event = drivers::decoded<event_t>(bytes)) events.push_back(*event);
          };
    }
    std::vector<std::string> lost() const {
      std::vector<std::string> names;
      for (const LostSection& l : loaded.lost) names.push_back(l.name);
      return names;
    }
    const Config& config;
    std::vector<event_t> events;
    std::optional<Estimation> estimation;
    LoadedState loaded;
  };

  /// Expects all other sections in `estimation` to be as they were saved.
  static void expect_the_others(const Config& config, Estimation& estimation,
                                const std::vector<std::string>& lost) {
    const SavedState now = saved_state(config, estimation, 0);
    ASSERT_EQ(now.sections.size(), good_.sections.size());
    for (std::size_t s = 0; s < now.sections.size(); ++s) {
      const std::string& name = now.sections[s].name;
      const bool was_lost = std::find(lost.begin(), lost.end(), name) != lost.end();
      // The strong motion began with the counters of the lost window.
      if (!was_lost && name != "event_report") {
        EXPECT_TRUE(now.sections[s].bytes == good_.sections[s].bytes) << name;
      }
    }
  }

  inline static test::TemporaryDirectory* directory_ = nullptr;
  inline static std::vector<drivers::LogEvent> events_;
  inline static Config config_;
  inline static SavedState good_;
};

using Names = std::vector<std::string>;

TEST_F(StateSections, LoadAllWithTheSameConfiguration) {
  Names names;
  for (const StateSection& s : good_.sections) names.push_back(s.name);
  EXPECT_EQ(names, kEverySection);
  for (const std::string& name : names) EXPECT_FALSE(without_section(name).empty()) << name;
  ASSERT_EQ(write_state(path("state"), good_), "");
  Resumed resumed(config_);
  EXPECT_EQ(resumed.loaded.problem, "");
  EXPECT_EQ(resumed.lost(), Names{});
  expect_the_others(config_, *resumed.estimation, {});
}

TEST_F(StateSections, LoseOnlyTheDamagedSection) {
  const std::vector<std::uint8_t> whole = state_bytes(good_);
  std::size_t at = whole.size();
  for (std::size_t s = good_.sections.size(); s-- > 0;) {
    const StateSection& section = good_.sections[s];
    at -= section.bytes.size();
    if (section.bytes.empty()) continue;
    std::string bytes(whole.begin(), whole.end());
    bytes[at + section.bytes.size() / 2] ^= 1;
    test::write_file(path("state"), bytes);
    Resumed resumed(config_);
    EXPECT_EQ(resumed.loaded.problem, "");
    const Names expected =
        section.name == "baseline" ? Names{"baseline", "watch"} : Names{section.name};
    EXPECT_EQ(resumed.lost(), expected);
    ASSERT_FALSE(resumed.loaded.lost.empty());
    EXPECT_EQ(resumed.loaded.lost[0].why, "is damaged: its digest does not match");
    expect_the_others(config_, *resumed.estimation, expected);
    bool touched = false;
    Estimation whole_or_none(config_, {});
    const std::string problem = load_state(path("state"), config_, whole_or_none, touched).problem;
    EXPECT_EQ(problem, "section " + section.name + " is damaged: its digest does not match");
    EXPECT_FALSE(touched);
  }
}

TEST_F(StateSections, LoseOnlyASectionWithImpossibleNumbers) {
  for (std::size_t s = 0; s < good_.sections.size(); ++s) {
    SavedState bad = good_;
    std::fill(bad.sections[s].bytes.begin(), bad.sections[s].bytes.end(), std::uint8_t{0xFF});
    if (bad.sections[s].bytes.empty()) bad.sections[s].bytes = {1};
    ASSERT_EQ(write_state(path("state"), bad), "");
    Resumed resumed(config_);
    const std::string& name = bad.sections[s].name;
    const Names expected = name == "baseline" ? Names{"baseline", "watch"} : Names{name};
    EXPECT_EQ(resumed.lost(), expected);
    expect_the_others(config_, *resumed.estimation, expected);
  }
}

TEST_F(StateSections, LoadTheFirstOfATruncatedFile) {
  const std::vector<std::uint8_t> whole = state_bytes(good_);
  std::size_t kept = whole.size();
  Names lost;
  for (std::size_t s = good_.sections.size(); s-- > 0;) {
    const StateSection& section = good_.sections[s];
    if (section.bytes.empty()) continue;
    kept -= section.bytes.size();
    lost.insert(lost.begin(), section.name);
    test::write_file(path("state"),
                     std::string(whole.begin(), whole.begin() + std::ptrdiff_t(kept)));
    Resumed resumed(config_);
    EXPECT_EQ(resumed.loaded.problem, "");
    EXPECT_EQ(resumed.lost(), lost);
    expect_the_others(config_, *resumed.estimation, lost);
  }
  for (const std::size_t size : {kept - 1, kept / 2, std::size_t{20}, std::size_t{0}}) {
    test::write_file(path("state"),
                     std::string(whole.begin(), whole.begin() + std::ptrdiff_t(size)));
    Resumed resumed(config_);
    EXPECT_NE(resumed.loaded.problem, "") << size;
  }
}

TEST_F(StateSections, RefuseAnotherFormatOrHeadAsAWhole) {
  const std::vector<std::uint8_t> whole = state_bytes(good_);
  std::string bytes(whole.begin(), whole.end());
  bytes[8 + 17] ^= 64;  // the format follows the magic word and its length
  test::write_file(path("state"), bytes);
  EXPECT_NE(Resumed(config_).loaded.problem.find("was written by framewatch"), std::string::npos);
  bytes = {whole.begin(), whole.end()};
  bytes[100] ^= 1;
  test::write_file(path("state"), bytes);
  EXPECT_NE(Resumed(config_).loaded.problem.find("its head"), std::string::npos);
}

TEST_F(StateSections, LoseOnlySectionsThatDependOnChangedKeys) {
  ASSERT_EQ(write_state(path("state"), good_), "");
  const auto lost = [&](const Config& config) { return Resumed(config).lost(); };
  EXPECT_EQ(lost(configured("other.toml", [](std::string& text) { text += "# a comment\n"; })),
            Names{});
  EXPECT_EQ(lost(replaced("learn_s = 1", "learn_s = 1\nsmallest_change_k_ratio = 0.05")),
            Names{"watch"});
  EXPECT_EQ(lost(replaced("hop_s = 0.01", "hop_s = 0.02")),
            (Names{"can", "window", "watch", "gap", "event_report"}));
  EXPECT_EQ(lost(replaced("node_mass_kg = 20.0", "node_mass_kg = 21.0")),
            (Names{"tuning", "window", "baseline", "watch", "gap", "event_report"}));
  EXPECT_EQ(lost(replaced("noise_mps2_per_rthz = 5e-4", "noise_mps2_per_rthz = 6e-4")),
            (Names{"lcm", "can", "tuning", "window", "gap", "event_report"}));
  EXPECT_EQ(lost(replaced("[gap]\n", "")), Names{"gap"});  // learns as long as [watch]
}

TEST_F(StateSections, ReportAMissingSection) {
  SavedState without = good_;
  std::erase_if(without.sections, [](const StateSection& s) { return s.name == "gap"; });
  ASSERT_EQ(write_state(path("state"), without), "");
  Resumed resumed(config_);
  ASSERT_EQ(resumed.lost(), Names{"gap"});
  EXPECT_EQ(resumed.loaded.lost[0].why, "is not in the file");
  expect_the_others(config_, *resumed.estimation, {"gap"});
}

TEST_F(StateSections, KeepTheBaselineWithoutWindowAndDetection) {
  SavedState without = good_;
  std::erase_if(without.sections,
                [](const StateSection& s) { return s.name == "window" || s.name == "watch"; });
  ASSERT_EQ(write_state(path("state"), without), "");
  Resumed resumed(config_);
  EXPECT_EQ(resumed.lost(), (Names{"window", "watch"}));
  ASSERT_NE(resumed.estimation->baseline(), nullptr);
  Estimation whole(config_, {});
  ASSERT_EQ(whole.load(good_.sections), "");
  EXPECT_TRUE(resumed.estimation->baseline()->holds(*whole.baseline()));
  for (const drivers::LogEvent& e : events_)
    resumed.estimation->message(e.channel, e.data.data(), e.data.size());
  EXPECT_GT(resumed.estimation->windows(), whole.windows());
}

TEST_F(StateSections, WithdrawFindingsThatNothingCouldClear) {
  Estimation estimation(config_, {});
  ASSERT_EQ(estimation.load(good_.sections), "");
  event_t alarm{};
  alarm.id = 7;
  alarm.kind = "stiffness_change";
  alarm.state = event_state::raised;
  estimation.raised().note(alarm);
  SavedState state = saved_state(config_, estimation, 0);
  ASSERT_EQ(write_state(path("state"), state), "");
  EXPECT_EQ(Resumed(config_).estimation->raised().all().size(), 1u);
  std::erase_if(state.sections, [](const StateSection& s) { return s.name == "watch"; });
  ASSERT_EQ(write_state(path("state"), state), "");
  Resumed resumed(config_);
  EXPECT_TRUE(resumed.estimation->raised().all().empty());
  resumed.estimation->finish();
  ASSERT_EQ(resumed.events.size(), 1u);
  EXPECT_EQ(resumed.events[0].id, 7);
  EXPECT_EQ(resumed.events[0].state, event_state::cleared);
}

}  // namespace state_sections_test
}  // namespace framewatch::daemon
