// SPDX-License-Identifier: MIT
#include "daemon/monitor/event_report/event_report_files.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace event_report_folder_test {

std::string report(const std::string& verdict) {
  return R"({"verdict": ")" + verdict + R"(", "reasons": ["why"], "start_us": 5, "end_us": 9})";
}

TEST(NewestEventReport, IsTheLastWrittenOne) {
  const test::TemporaryDirectory directory;
  NewestEventReport newest(directory.path(""));
  EXPECT_FALSE(newest.poll());
  test::write_file(directory.path("event-20261124T000000Z.json"), report("yellow"));
  test::write_file(directory.path("event-other.json"), report("red"));
  ASSERT_TRUE(newest.poll());
  EXPECT_EQ(newest.newest()->name, "event-20261124T000000Z");
  EXPECT_EQ(newest.newest()->color, EventColor::yellow);
  EXPECT_EQ(newest.newest()->reason, "why");
  EXPECT_EQ(newest.newest()->end_us, 9);
  test::write_file(directory.path("event-20261124T000100Z.json"), report("green"));
  EXPECT_EQ(newest.poll()->color, EventColor::green);
  for (const char* name : {"event-20261124T000000Z.json", "event-20261124T000100Z.json"})
    std::filesystem::remove(directory.path(name));
  EXPECT_FALSE(newest.poll());
  EXPECT_FALSE(NewestEventReport("").poll());
}

TEST(NewestEventReport, IgnoresOtherFiles) {
  for (const std::string& text :
       {std::string(), std::string("{"), report("blue"), std::string("[1]"),
        std::string(R"({"verdict": "red", "reasons": [], "start_us": 5, "end_us": 9})"),
        std::string(R"({"verdict": 3, "reasons": ["a"], "start_us": 5, "end_us": 9})")}) {
    const test::TemporaryDirectory directory;
    test::write_file(directory.path("event-20261124T000000Z.json"), text);
    EXPECT_FALSE(event_report_summary(directory.path(""), "event-20261124T000000Z")) << text;
  }
}

TEST(NewestEventReport, DoesNotFollowANameOutOfItsFolder) {
  EXPECT_TRUE(is_event_report_name("event-20261124T000000Z"));
  for (const char* name : {"event-20261124T000000Z.json", "event-", "", "../20261124T000000Z",
                           "event-20261124T000000/", "event-20269924T000000Z"})
    EXPECT_FALSE(is_event_report_name(name)) << name;
}

}  // namespace event_report_folder_test
}  // namespace framewatch::daemon
