// SPDX-License-Identifier: MIT
#include "fleet/serve/fleet_server.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/file_digest.h"
#include "daemon/page/web/web_socket.h"
#include "fleet/serve/fleet_pages.h"
#include "tests/daemon/page/web/served.h"
#include "tests/fleet/support/own_postgres.h"

namespace framewatch::fleet {
namespace fleet_server_test {

using nlohmann::json;

const std::string kOperator = "0123456789abcdef0", kViewer = "abcdefabcdefabcdef";
const std::string kBearer = "Authorization: Bearer ";

/// A page with two people, whose commands are collected.
class Page {
 public:
  explicit Page(const std::string& database, bool with_people = true, bool with_hub = true)
      : pages_(database, with_hub ? FleetPages::Give([this](CommandOrder order) {
                 given.push_back(std::move(order));
                 return takes;
               })
                                  : FleetPages::Give()),
        server_(settings(with_people), pages_) {
    std::string error;
    const int socket = daemon::listen_on("127.0.0.1", 0, error);
    EXPECT_TRUE(socket >= 0 && server_.start(socket, error)) << error;
  }
  std::string get(const std::string& path, const std::string& more = "") {
    return test::ask(server_.port(), test::request("GET " + path, more));
  }
  std::string post(const std::string& path, const std::string& more = "") {
    return test::ask(server_.port(), test::request("POST " + path, more));
  }

  std::vector<CommandOrder> given;
  bool takes = true;

 private:
  static FleetServerSettings settings(bool with_people) {
    FleetServerSettings out;
    if (!with_people) return out;
    out.people.put({"olga", Role::operator_, daemon::sha256(kOperator)});
    out.people.put({"victor", Role::viewer, daemon::sha256(kViewer)});
    return out;
  }
  FleetPages pages_;
  FleetServer server_;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
std::string as(const std::string& token) {
  return kBearer + token + "\r\n";
}
json body(const std::string& answer) {
  return json::parse(answer.substr(answer.find("\r\n\r\n") + 4), nullptr, false);
}

constexpr const char* kNoDatabase = "host=/nowhere user=nobody";

TEST(FleetServer, ServesTheWholePageWithAStrictPolicy) {
  Page page(kNoDatabase, false);
  const std::string index = page.get("/");
  EXPECT_TRUE(has(index, "200 OK")) << index;
  EXPECT_TRUE(has(index, "default-src 'none'"));
  EXPECT_TRUE(has(index, "nosniff"));
  for (std::size_t at = index.find("src=\""); at != std::string::npos;
       at = index.find("src=\"", at + 1)) {
    const std::string file = index.substr(at + 5, index.find('"', at + 5) - at - 5);
    EXPECT_TRUE(has(page.get("/" + file), "200 OK")) << file;
  }
  EXPECT_FALSE(has(index, "<script>"));
  for (const char* file : {"/fleet.css", "/page.css", "/icon.svg", "/uPlot.min.css"})
    EXPECT_TRUE(has(page.get(file), "200 OK")) << file;
  EXPECT_TRUE(has(page.get("/session.js"), "404"));
  EXPECT_TRUE(has(page.get("/../people"), "404"));
}

TEST(FleetServer, AdmitsOnlyListedPeople) {
  Page page(kNoDatabase);
  for (const char* path : {"/", "/overview.json", "/fleet.js", "/journal.json"})
    EXPECT_TRUE(has(page.get(path), "403")) << path;
  EXPECT_TRUE(has(page.get("/healthz"), "200 OK"));
  EXPECT_TRUE(has(page.get("/me.json", as("wrong")), "403"));
  EXPECT_EQ(body(page.get("/me.json", as(kViewer)))["role"], "viewer");
  EXPECT_EQ(body(page.get("/me.json", as(kOperator)))["who"], "olga");
  const std::string exchanged = page.get("/?token=" + kOperator);
  EXPECT_TRUE(has(exchanged, "303") && has(exchanged, "HttpOnly; SameSite=Strict")) << exchanged;
  EXPECT_EQ(body(page.get("/me.json", "Cookie: framewatch_fleet=" + kOperator + "\r\n"))["role"],
            "operator");
}

TEST(FleetServer, RefusesOtherNamesMethodsAndPages) {
  Page page(kNoDatabase);
  EXPECT_TRUE(has(page.post("/overview.json", as(kOperator)), "405"));
  EXPECT_TRUE(has(
      page.post("/command?building=a&verb=ping", as(kOperator) + "Origin: http://evil.example\r\n"),
      "403"));
  EXPECT_TRUE(has(page.get("/me.json", as(kOperator) + "Host: evil.example\r\n"), "400"));
  EXPECT_TRUE(page.given.empty());
}

TEST(FleetServer, ReportsAMissingDatabase) {
  Page page(kNoDatabase, false);
  for (const char* path : {"/overview.json", "/building.json?name=a", "/earthquake.json?time_us=1",
                           "/earthquakes.json?days=3", "/journal.json"}) {
    const std::string answer = page.get(path);
    EXPECT_TRUE(has(answer, "503")) << path << answer;
    EXPECT_FALSE(body(answer)["problem"].get<std::string>().empty());
  }
}

TEST(FleetServer, ChecksArguments) {
  Page page(kNoDatabase, false);
  for (const char* path : {"/building.json", "/building.json?name=A'B",
                           "/series.json?name=a&parameter=k&from_us=2&to_us=1",
                           "/series.json?name=a&from_us=1&to_us=2",
                           "/series.json?name=a&parameter=k&from_us=1&to_us=2&period_s=7",
                           "/earthquake.json", "/earthquake.json?time_us=9223372036854775807",
                           "/earthquakes.json?days=0", "/journal.json?name=*"})
    EXPECT_TRUE(has(page.get(path), "400")) << path;
  EXPECT_TRUE(has(page.get("/other.json"), "404"));
}

class FleetServerOnPostgres : public OnPostgres {
 protected:
  void SetUp() override {
    OnPostgres::SetUp();
    if (IsSkipped()) return;
    FleetPages first(where_, {});  // makes the tables
    (void)first.answer({"GET", "/overview.json", {}, "nobody", Role::viewer});
    ASSERT_TRUE(
        look_.execute("INSERT INTO building (name, retired) VALUES ('a', false),"
                      " ('b', false), ('c', true)"))
        << look_.error();
  }
  std::string number(const std::string& sql) {
    const auto rows = look_.query(sql);
    return rows && !rows->empty() ? rows->front().front().value_or("NULL") : look_.error();
  }
};

TEST_F(FleetServerOnPostgres, WritesACommandToTheJournalBeforeSendingIt) {
  Page page(where_);
  EXPECT_TRUE(has(page.post("/command?building=a&verb=ping", as(kViewer)), "403"));
  EXPECT_TRUE(has(page.post("/command?building=nobody&verb=ping", as(kOperator)), "404"));
  EXPECT_TRUE(has(page.post("/command?building=a&verb=erase", as(kOperator)), "400"));
  EXPECT_TRUE(
      has(page.post("/command?building=all&verb=raw&from_us=1&to_us=2", as(kOperator)), "400"));
  EXPECT_TRUE(page.given.empty());
  EXPECT_EQ(number("SELECT count(*) FROM journal"), "0");
  EXPECT_TRUE(
      has(page.post("/command?building=all&verb=minutes&from_us=1&to_us=2", as(kOperator)), "202"));
  ASSERT_EQ(page.given.size(), 1u);
  EXPECT_EQ(page.given[0].targets.size(), 2u);
  EXPECT_EQ(page.given[0].who, "olga");
  FleetPages pages(where_, {});
  pages.note({page.given[0].request, page.given[0].targets[0].id, false, "it does not accept it"});
  const json journal = body(page.get("/journal.json?name=a", as(kViewer)));
  ASSERT_EQ(journal.size(), 1u) << journal;
  EXPECT_EQ(journal[0]["who"], "olga");
  EXPECT_EQ(journal[0]["verb"], "minutes");
  EXPECT_EQ(journal[0]["content"]["to_us"], 2);
  EXPECT_EQ(journal[0]["refused"], 1);
  EXPECT_EQ(journal[0]["waiting"], 1);
  EXPECT_EQ(journal[0]["answers"][0]["answer"], "it does not accept it");
  page.takes = false;
  EXPECT_TRUE(has(page.post("/command?building=b&verb=ping", as(kOperator)), "503"));
  EXPECT_EQ(number("SELECT answer FROM journal_answer ORDER BY came DESC NULLS LAST LIMIT 1"),
            "too many commands are waiting: try again later");
}

TEST_F(FleetServerOnPostgres, DoesNotResendAnUnchangedOverview) {
  Page page(where_, false, false);
  const json overview = body(page.get("/overview.json"));
  ASSERT_EQ(overview["buildings"].size(), 2u) << overview;
  EXPECT_TRUE(
      has(page.get("/overview.json?version=" + overview["version"].get<std::string>()), "204"));
  EXPECT_TRUE(has(page.post("/command?building=a&verb=ping"), "403"));
}

}  // namespace fleet_server_test
}  // namespace framewatch::fleet
