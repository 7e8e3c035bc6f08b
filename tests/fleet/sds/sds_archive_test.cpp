// SPDX-License-Identifier: MIT
#include "fleet/sds/sds_archive.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/miniseed.h"
#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace sds_archive_test {

constexpr std::int64_t kMidnight_us = 1'795'305'600'000'000;  // 2026-11-22, day 326
constexpr std::int64_t kSecond_us = 1'000'000;
const std::string kDay = "/2026/JP/KOBE3/HN1.D/JP.KOBE3.01.HN1.D.2026.326";
const std::string kDayBefore = "/2026/JP/KOBE3/HN1.D/JP.KOBE3.01.HN1.D.2026.325";

class SdsArchive : public testing::Test {
 protected:
  SdsOutcome add(std::int64_t start_us, int seconds, std::int32_t first = 0) {
    test::SeedSpan span;
    span.start_us = start_us;
    for (int i = 0; i < 100 * seconds; ++i) span.values.push_back(first + i % 1000);
    return add_bytes(test::miniseed(span));
  }
  SdsOutcome add_bytes(const std::string& bytes) {
    return add_to_sds(root_, std::vector<std::uint8_t>(bytes.begin(), bytes.end()),
                      {"JP", "KOBE3"});
  }
  /// Samples of a file, read with libmseed, and the number of runs without a gap.
  std::vector<std::vector<std::int32_t>> read(const std::string& file) {
    std::vector<std::vector<std::int32_t>> out;
    MSTraceList* list = nullptr;
    std::string path = root_ + file;
    EXPECT_EQ(ms_readtracelist(&list, path.c_str(), 0, -1, -1, 0, 1, 1, 0), MS_NOERROR);
    for (MSTraceID* id = list->traces; id != nullptr; id = id->next)
      for (MSTraceSeg* s = id->first; s != nullptr; s = s->next) {
        const auto* values = static_cast<const std::int32_t*>(s->datasamples);
        out.emplace_back(values, values + s->numsamples);
        name_ =
            std::string(id->network) + "." + id->station + "." + id->location + "." + id->channel;
        start_us_ = s->starttime;
      }
    mstl_free(&list, 0);
    return out;
  }
  test::TemporaryDirectory folder_;
  std::string root_ = folder_.path("sds"), name_;
  std::int64_t start_us_ = 0;
};

TEST_F(SdsArchive, SplitsAStretchAtMidnight) {
  const SdsOutcome done = add(kMidnight_us - 5 * kSecond_us, 10);
  EXPECT_EQ(done.problem, "");
  EXPECT_EQ(done.samples, 1000);
  EXPECT_EQ(done.files, (std::vector<std::string>{root_ + kDayBefore, root_ + kDay}));
  const auto before = read(kDayBefore);
  ASSERT_EQ(before.size(), 1u);
  EXPECT_EQ(name_, "JP.KOBE3.01.HN1");
  EXPECT_EQ(before[0].size(), 500u);
  EXPECT_EQ(before[0][499], 499);
  const auto after = read(kDay);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(start_us_, kMidnight_us);
  EXPECT_EQ(after[0][0], 500);
  EXPECT_EQ(after[0].size(), 500u);
}

TEST_F(SdsArchive, AddingAStretchAgainChangesNothing) {
  ASSERT_EQ(add(kMidnight_us, 10).files.size(), 1u);
  const std::string bytes = test::read_file(root_ + kDay);
  const SdsOutcome again = add(kMidnight_us, 10);
  EXPECT_TRUE(again.files.empty());
  EXPECT_EQ(again.samples, 0);
  EXPECT_EQ(test::read_file(root_ + kDay), bytes);
}

TEST_F(SdsArchive, JoinsOverlappingStretches) {
  ASSERT_EQ(add(kMidnight_us + 5 * kSecond_us, 10).problem, "");
  const SdsOutcome more = add(kMidnight_us, 10);
  EXPECT_EQ(more.samples, 500);
  const auto runs = read(kDay);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].size(), 1500u);
  EXPECT_EQ(runs[0][499], 499);
  EXPECT_EQ(runs[0][500], 0);  // existing samples stay
}

TEST_F(SdsArchive, KeepsAGap) {
  ASSERT_EQ(add(kMidnight_us, 2).problem, "");
  ASSERT_EQ(add(kMidnight_us + 7 * kSecond_us, 2).problem, "");
  EXPECT_EQ(read(kDay).size(), 2u);
}

TEST_F(SdsArchive, LeavesForeignFilesAlone) {
  test::SeedSpan floats;
  floats.encoding = DE_FLOAT32;
  floats.start_us = kMidnight_us;
  floats.values.assign(200, 1.5);
  test::SeedSpan good;
  good.start_us = kMidnight_us;
  good.values.assign(2000, 1);
  for (const std::string& bytes :
       {std::string("no record"), test::miniseed(floats), test::miniseed(good).substr(0, 700),
        test::miniseed(good) + "x"}) {
    EXPECT_NE(add_bytes(bytes).problem, "");
    EXPECT_FALSE(std::filesystem::exists(root_));
  }
  ASSERT_EQ(add(kMidnight_us, 2).problem, "");
  test::write_file(root_ + kDay, "damaged");
  EXPECT_NE(add(kMidnight_us, 10).problem.find(kDay), std::string::npos);
  EXPECT_EQ(test::read_file(root_ + kDay), "damaged");
}

TEST(SdsCodes, FollowSeed) {
  EXPECT_TRUE(is_network_code("JP") && is_station_code("KOBE3"));
  for (const char* bad : {"", "jp", "JPN", "J/"}) EXPECT_FALSE(is_network_code(bad)) << bad;
  for (const char* bad : {"", "KOBE-3", "KOBE33", "../.."})
    EXPECT_FALSE(is_station_code(bad)) << bad;
}

}  // namespace sds_archive_test
}  // namespace framewatch::fleet
