// Whatever a state file holds, its digest right: it is refused with a reason, or the estimation
// goes on with it and is well again soon.

#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/file_digest.h"
#include "daemon/estimation/state_file.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace state_mutation_test {

constexpr int kMutations = 120;
constexpr std::size_t kDigest = 64, kHead = 130;

template <typename T>
void put(std::string& bytes, std::size_t at, T value) {
  if (at + sizeof value <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::string mutated(std::mt19937& random, std::string bytes) {
  bytes.resize(bytes.size() - kDigest);
  const auto any = [&](auto... values) {
    const double all[] = {static_cast<double>(values)...};
    return all[random() % (sizeof...(values))];
  };
  for (int n = 1 << random() % 5; n > 0; --n) {
    const std::size_t at = kHead + random() % (bytes.size() - kHead);
    switch (random() % 7) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
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
        bytes.erase(at, std::size_t{1} << random() % 7);
        break;
      case 5:
        if (random() % 4 == 0) bytes.resize(at);
        break;
      default:
        bytes[at] = static_cast<char>(0xFF);
    }
    if (bytes.size() < kHead + 1000) break;
  }
  return bytes + sha256(bytes);
}

TEST(StateMutation, IsRefusedWithAReasonOrHarmless) {
  const test::TemporaryDirectory directory;
  test::record_table_test(directory.path("rec.lcmlog"), 11);
  std::vector<ConfigProblem> problems;
  const Config config = *load_config(test::table_config(), problems);
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
  ASSERT_EQ(write_state(directory.path("good"), state_bytes(config, before, 0)), "");
  const std::string good = test::read_file(directory.path("good"));
  int refused = 0;
  for (int i = 0; i < kMutations; ++i) {
    std::mt19937 random(static_cast<unsigned>(i));
    test::write_file(directory.path("state"), mutated(random, good));
    Estimation estimation(config, {});
    bool touched = false;
    LoadedState loaded;
    ASSERT_NO_THROW(loaded = load_state(directory.path("state"), config, estimation, touched)) << i;
    if (!loaded.problem.empty()) {
      ++refused;
      continue;
    }
    feed(estimation, half, half + 300);
  }
  EXPECT_GT(refused, kMutations / 2);
}

}  // namespace state_mutation_test
}  // namespace framewatch::daemon
