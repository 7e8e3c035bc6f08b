// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/diff_command.h"

#include <gtest/gtest.h>

#include <framewatch/window_estimate_t.hpp>

#include "daemon/tools/replay/replay_command.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace diff_command_test {

using drivers::LcmLogReader;
using drivers::LcmLogWriter;
using drivers::LogEvent;
using drivers::LogRead;
using test::TemporaryDirectory;

class Diff : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    test::record_table_test(directory_->path("rec.lcmlog"), 9);
    ASSERT_EQ(
        replay({test::table_config(), {directory_->path("rec.lcmlog")}, a(), false, true, false}),
        0);
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string a() { return directory_->path("a.lcmlog"); }

  /// Writes a copy with every estimate changed or, if `change` returns false, left out.
  template <typename Change>
  std::string changed(Change change) {
    const std::string to = directory_->path("b.lcmlog");
    LcmLogReader reader;
    LcmLogWriter writer;
    EXPECT_TRUE(reader.open(a()) && writer.open(to));
    LogEvent event;
    while (reader.next(event) == LogRead::event) {
      if (event.channel == "FRAMEWATCH_ESTIMATE") {
        framewatch::window_estimate_t e{};
        EXPECT_GT(e.decode(event.data.data(), 0, static_cast<int>(event.data.size())), 0);
        if (!change(e)) continue;
        e.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
      }
      EXPECT_TRUE(writer.copy(event));
    }
    EXPECT_TRUE(writer.close());
    return to;
  }

  int diff_with(const std::string& b) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = diff({a(), b, false, false});
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    return code;
  }

  std::string out_, err_;
  inline static TemporaryDirectory* directory_ = nullptr;
};

TEST_F(Diff, FindsNoDifferenceBetweenALogAndItself) {
  EXPECT_EQ(diff_with(changed([](auto&) { return true; })), 0);
  EXPECT_NE(out_.find("files: identical, byte by byte"), std::string::npos) << out_;
  EXPECT_NE(out_.find(" 0 differ; 0 only in A, 0 only in B"), std::string::npos) << out_;
}

TEST_F(Diff, NamesFirstAndWorstDifferenceOfAParameter) {
  EXPECT_EQ(diff_with(changed([](window_estimate_t& e) {
              if (e.sequence == 850) e.value[0] *= 1 + 1e-9;
              if (e.sequence == 870) e.value[0] *= 1.5;
              return true;
            })),
            1);
  EXPECT_NE(out_.find("files: differ, first at byte "), std::string::npos) << out_;
  EXPECT_NE(out_.find("kx_1_y1: value (2)\n  first: FRAMEWATCH_ESTIMATE value at "),
            std::string::npos)
      << out_;
  EXPECT_NE(out_.find("(0.333 relative)"), std::string::npos) << out_;
  EXPECT_EQ(out_.find("kx_1_y2"), std::string::npos) << out_;
}

TEST_F(Diff, CountsWindowsMissingFromOneLog) {
  EXPECT_EQ(diff_with(changed([](window_estimate_t& e) { return e.sequence % 100 != 5; })), 1);
  EXPECT_NE(out_.find(" 0 differ; 9 only in A, 0 only in B"), std::string::npos) << out_;
}

TEST_F(Diff, JsonHasTheSameResult) {
  const std::string b = changed([](window_estimate_t& e) {
    if (e.sequence == 300) e.rows += 1;
    return true;
  });
  testing::internal::CaptureStdout();
  EXPECT_EQ(diff({a(), b, true, false}), 1);
  const std::string json = testing::internal::GetCapturedStdout();
  EXPECT_NE(json.find("\"same_estimates\": false"), std::string::npos) << json;
  EXPECT_NE(json.find("\"subject\": \"window\", \"field\": \"rows\", \"count\": 1"),
            std::string::npos)
      << json;
}

TEST_F(Diff, RefusesLogsWithoutEstimatesAndDamagedLogs) {
  EXPECT_EQ(diff_with(directory_->path("rec.lcmlog")), 2);
  EXPECT_NE(err_.find("holds no window_estimate_t"), std::string::npos) << err_;
  EXPECT_EQ(diff_with("/nonexistent"), 2);
  const std::string bytes = test::read_file(a());
  test::write_file(directory_->path("cut.lcmlog"), bytes.substr(0, bytes.size() - 3));
  EXPECT_EQ(diff_with(directory_->path("cut.lcmlog")), 2);
  EXPECT_NE(err_.find("framewatch repair"), std::string::npos) << err_;
}

}  // namespace diff_command_test
}  // namespace framewatch::daemon
