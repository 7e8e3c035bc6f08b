#include "daemon/page/web/web_sessions.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/daemon/page/web/served.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace web_event_reports_test {

constexpr const char* kReport =
    R"({"verdict": "red", "reasons": ["story 1 drifted"], "start_us": 5000000, "end_us": 9000000})";

/// Two reports, and secrets beside them, behind links, and under other names.
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

TEST_F(EventReportsTest, NothingButTheirPagesAndDataIsGivenOut) {
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

TEST_F(ServedEventReports, ComeWithoutScriptsAndOnlyWhereTheyAreWritten) {
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
