// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_sessions.h"

#include <sys/stat.h>

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/served_file.h"
#include "daemon/tools/report/session_file.h"
#include "tests/daemon/page/web/served.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace web_sessions_test {

TEST(WebSessions, ServeOnlyReports) {
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

/// A folder with one finished session "a", and a secret file beside the folder.
struct SessionsAndASecret {
  SessionsAndASecret() {
    std::filesystem::create_directories(sessions + "/a");
    session.request.test = "mine";
    test::write_file(sessions + "/a/session.json", session_json(session));
    session.request.test = "secret";
    test::write_file(secret_session, session_json(session));
    test::write_file(secret, "secret");
  }
  const test::TemporaryDirectory directory;
  const std::string sessions = directory.path("sessions");
  const std::string secret = directory.path("secret");
  const std::string secret_session = directory.path("secret.json");
  SessionFile session;
};

TEST(WebSessions, FollowNoLinks) {
  const SessionsAndASecret s;
  namespace fs = std::filesystem;
  fs::create_symlink(s.secret, s.sessions + "/a/report.html");
  fs::create_directory(s.sessions + "/b");
  fs::create_symlink(s.secret_session, s.sessions + "/b/session.json");
  fs::create_directory(s.directory.path("elsewhere"));
  test::write_file(s.directory.path("elsewhere/session.json"), session_json(s.session));
  test::write_file(s.directory.path("elsewhere/report.html"), "secret");
  fs::create_directory_symlink(s.directory.path("elsewhere"), s.sessions + "/c");
  fs::create_directory_symlink(".", s.sessions + "/d");
  for (const char* path :
       {"a/report.html", "b/session.json", "c/session.json", "c/report.html", "d/session.json"})
    EXPECT_FALSE(session_document(s.sessions, path)) << path;
  const auto list = nlohmann::json::parse(sessions_json(s.sessions));
  ASSERT_EQ(list.size(), 1u) << list;
  EXPECT_EQ(list[0]["test"], "mine");
  EXPECT_EQ(list[0]["report"], false);
  // The folder itself may be a link, like systemd's state directory.
  fs::create_directory_symlink(s.sessions, s.directory.path("link"));
  EXPECT_TRUE(session_document(s.directory.path("link"), "a/session.json"));
}

TEST(WebSessions, ReadNoPipesDevicesOrHugeFiles) {
  const SessionsAndASecret s;
  namespace fs = std::filesystem;
  const auto report = [&](const char* name) { return s.sessions + "/" + name + "/report.html"; };
  for (const char* name : {"pipe", "huge", "folder"}) fs::create_directory(s.sessions + "/" + name);
  ASSERT_EQ(::mkfifo(report("pipe").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo((s.sessions + "/pipe/session.json").c_str(), 0600), 0);
  test::write_file(report("huge"), "");
  fs::resize_file(report("huge"), kMaxServedBytes + 1);
  fs::create_directory(report("folder"));
  for (const char* path :
       {"pipe/report.html", "pipe/session.json", "huge/report.html", "folder/report.html"})
    EXPECT_FALSE(session_document(s.sessions, path)) << path;
  EXPECT_EQ(nlohmann::json::parse(sessions_json(s.sessions)).size(), 1u);
  fs::resize_file(report("huge"), kMaxServedBytes);
  EXPECT_EQ(session_document(s.sessions, "huge/report.html").value().content.size(),
            kMaxServedBytes);
}

}  // namespace web_sessions_test

namespace web_event_reports_test {

constexpr const char* kReport =
    R"({"verdict": "red", "reasons": ["story 1 drifted"], "start_us": 5000000, "end_us": 9000000})";

/// Two reports, and secret files beside them, behind links, and under other names.
class EventReportsTest : public ::testing::Test {
 protected:
  EventReportsTest() {
    std::filesystem::create_directories(folder_ + "/event-20261124T000003Z.html");
    for (const char* name : {"event-20261124T000000Z", "event-20261124T000100Z"}) {
      test::write_file(folder_ + "/" + name + ".json", kReport);
      test::write_file(folder_ + "/" + name + ".html", "<p>");
    }
    test::write_file(folder_ + "/notes.html", "secret");
    test::write_file(directory_.path("event-20261124T000002Z.html"), "secret");
    test::write_file(directory_.path("secret"), kReport);
    for (const char* ending : {".html", ".json"})
      std::filesystem::create_symlink(directory_.path("secret"),
                                      folder_ + "/event-20261124T000200Z" + ending);
  }
  const test::TemporaryDirectory directory_;
  const std::string folder_ = directory_.path("events");
};

TEST_F(EventReportsTest, AreListedNewestFirst) {
  const auto list = nlohmann::json::parse(event_reports_json(folder_));
  ASSERT_EQ(list.size(), 2u) << list;
  EXPECT_EQ(list[0]["name"], "event-20261124T000100Z");
  EXPECT_EQ(list[0]["verdict"], "red");
  EXPECT_EQ(list[0]["reason"], "story 1 drifted");
  EXPECT_EQ(list[1]["start_us"], 5000000);
  EXPECT_EQ(event_reports_json("/nonexistent"), "[]");
}

TEST_F(EventReportsTest, ServeOnlyTheirPagesAndData) {
  EXPECT_EQ(event_report_document(folder_, "event-20261124T000000Z.html").value().content, "<p>");
  EXPECT_EQ(event_report_document(folder_, "event-20261124T000000Z.json").value().type,
            "application/json");
  for (const char* path :
       {"notes.html", "../event-20261124T000002Z.html", "./event-20261124T000000Z.html",
        "event-20261124T000000Z.html/", "event-20261124T000000Z.html.partial",
        "event-20261124T000000Z", "event-20261124T000200Z.html", "event-20261124T000200Z.json",
        "event-20261124T000003Z.html", "", "event-/../notes.html", "event-20261124T000000Z/.html"})
    EXPECT_FALSE(event_report_document(folder_, path)) << path;
  EXPECT_FALSE(event_report_document("", "event-20261124T000000Z.html"));
}

class ServedEventReports : public test::Served {
 protected:
  ServedEventReports() : Served(with_reports()) {}
  static WebSettings with_reports() {
    folder().emplace();
    test::write_file(folder()->path("event-20261124T000000Z.json"), kReport);
    test::write_file(folder()->path("event-20261124T000000Z.html"), "<p>the report");
    WebSettings s = settings();
    s.event_reports = folder()->path("");
    return s;
  }
  static std::optional<test::TemporaryDirectory>& folder() {
    static std::optional<test::TemporaryDirectory> directory;
    return directory;
  }
};

TEST_F(ServedEventReports, AreServedWithoutScripts) {
  const auto asked = [&](const std::string& path) {
    return test::ask(server_.port(), test::request("GET " + path));
  };
  const std::string page = asked("/event-report/event-20261124T000000Z.html");
  EXPECT_NE(page.find("<p>the report"), std::string::npos) << page;
  EXPECT_NE(page.find("sandbox"), std::string::npos);
  EXPECT_NE(asked("/event-reports.json").find("\"verdict\":\"red\""), std::string::npos);
  EXPECT_NE(asked("/event-report/../event-20261124T000000Z.html").find("404"), std::string::npos);
  EXPECT_NE(asked("/event-report/event-20261124T000001Z.html").find("404"), std::string::npos);
}

class ServedWithoutEventReports : public test::Served {};

TEST_F(ServedWithoutEventReports, HasNone) {
  EXPECT_NE(
      test::ask(server_.port(), test::request("GET /event-reports.json")).find("\r\n\r\nnull"),
      std::string::npos);
}

}  // namespace web_event_reports_test

}  // namespace framewatch::daemon
