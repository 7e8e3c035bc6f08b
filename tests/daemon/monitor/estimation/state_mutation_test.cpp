// SPDX-License-Identifier: MIT
// Changes the contents of state files and makes their digests match. Each section must be refused
// with a reason, or the estimation must continue with it and soon be well again.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/estimation/state_file.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace state_mutation_test {

constexpr int kMutations = 120;

template <typename T>
void put(std::vector<std::uint8_t>& bytes, std::size_t at, T value) {
  if (at + sizeof value <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof value);
}

void mutate(std::mt19937& random, std::vector<std::uint8_t>& bytes) {
  const auto any = [&](auto... values) {
    const double all[] = {static_cast<double>(values)...};
    return all[random() % (sizeof...(values))];
  };
  for (int n = 1 << random() % 5; n > 0; --n) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 7) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1 << random() % 8));
        break;
      case 1:
        put(bytes, at, static_cast<std::int64_t>(any(-1, 0, 1, 9.2e18, -9.2e18, 1e12, 1e6)));
        break;
      case 2:
        put(bytes, at, any(std::nan(""), INFINITY, 1e308, -1, 0));
        break;
      case 3:
        put(bytes, at, static_cast<std::int32_t>(any(-1, 0, 2147483647, -2147483648.0, 70000)));
        break;
      case 4:
        bytes.erase(bytes.begin() + std::ptrdiff_t(at),
                    bytes.begin() + std::ptrdiff_t(std::min(at + (std::size_t{1} << random() % 7),
                                                            bytes.size())));
        break;
      case 5:
        if (random() % 4 == 0) bytes.resize(at);
        break;
      default:
        bytes[at] = 0xFF;
    }
    if (bytes.empty()) break;
  }
}

TEST(StateMutation, IsRefusedWithAReasonOrHarmless) {
  const test::TemporaryDirectory directory;
  test::record_table_test(directory.path("rec.lcmlog"), 11);
  std::vector<ConfigProblem> problems;
  test::write_file(directory.path("building.toml"),
                   test::read_file(test::table_config()) +
                       "\n[watch]\nlearn_s = 3\n[gap]\n[event_report]\ndirectory = \"reports\"\n");
  const Config config = *load_config(directory.path("building.toml"), problems);
  std::vector<drivers::LogEvent> events;
  drivers::LcmLogReader reader;
  ASSERT_TRUE(reader.open(directory.path("rec.lcmlog")));
  for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) events.push_back(e);
  const auto feed = [&](Estimation& estimation, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to && i < events.size(); ++i)
      estimation.message(events[i].channel, events[i].data.data(), events[i].data.size());
  };
  const std::size_t half = events.size() * 9 / 10;
  Estimation before(config, {});
  feed(before, 0, half);
  const SavedState good = saved_state(config, before, 0);
  ASSERT_GE(good.sections.size(), 10u);
  int refused = 0;
  for (int i = 0; i < kMutations; ++i) {
    std::mt19937 random(static_cast<unsigned>(i));
    SavedState bad = good;
    // Half of the changes are in the largest section.
    StateSection& section = bad.sections[random() % 2 == 0 ? 5 : random() % bad.sections.size()];
    ASSERT_TRUE(good.sections[5].name == "window");
    mutate(random, section.bytes);
    ASSERT_EQ(write_state(directory.path("state"), bad), "");
    std::optional<Estimation> estimation(std::in_place, config, MessageSink{});
    LoadedState loaded;
    ASSERT_NO_THROW(loaded = load_what_fits(
                        directory.path("state"), config, *estimation,
                        [&]() -> Estimation& { return estimation.emplace(config, MessageSink{}); }))
        << i;
    EXPECT_EQ(loaded.problem, "");
    ASSERT_LE(loaded.lost.size(), section.name == "baseline" ? 2u : 1u) << i;
    if (!loaded.lost.empty()) {
      EXPECT_EQ(loaded.lost[0].name, section.name) << i;
      ++refused;
    }
    feed(*estimation, half, half + 300);
  }
  EXPECT_GT(refused, kMutations / 3);
}

}  // namespace state_mutation_test
}  // namespace framewatch::daemon
