#include "daemon/web/web_sessions.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/session/session_file.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace web_sessions_test {

TEST(WebSessions, GiveOutReportsAndNothingElse) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"2026-11-21T14-03-10_a", "2026-11-21T15-00-00"}) {
    std::filesystem::create_directory(directory.path(name));
    SessionFile session;
    session.request.test = name;
    test::write_file(directory.path(name) + "/session.json", session_json(session));
    test::write_file(directory.path(name) + "/raw.lcmlog", "raw");
  }
  test::write_file(directory.path("2026-11-21T15-00-00/report.html"), "<p>");
  test::write_file(directory.path("report.html"), "outside");
  const std::string folder = directory.path("");
  const auto list = nlohmann::json::parse(sessions_json(folder));
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["session"], "2026-11-21T15-00-00");
  EXPECT_EQ(list[0]["report"], true);
  EXPECT_EQ(list[1]["report"], false);
  EXPECT_EQ(sessions_json("/nonexistent"), "[]");
  EXPECT_EQ(session_document(folder, "2026-11-21T15-00-00/report.html").value().content, "<p>");
  EXPECT_TRUE(session_document(folder, "2026-11-21T14-03-10_a/session.json"));
  for (const char* path :
       {"2026-11-21T15-00-00/raw.lcmlog", "../report.html", "./report.html", "report.html",
        "2026-11-21T15-00-00/../report.html", "2026-11-21T15-00-00/", "", "/report.html",
        "2026-11-21T15-00-00/report.html/x", "2026-11-21T14-03-10_a/report.html"})
    EXPECT_FALSE(session_document(folder, path)) << path;
  EXPECT_FALSE(session_document("", "2026-11-21T15-00-00/report.html"));
}

}  // namespace web_sessions_test
}  // namespace framewatch::daemon
