#include <csignal>
#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/action_queue.h"
#include "daemon/action_way.h"
#include "daemon/clocks.h"
#include "daemon/event_json.h"
#include "daemon/event_words.h"
#include "daemon/hook_command.h"
#include "daemon/tell_command.h"
#include "daemon/webhook.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/http_server.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace {

using namespace std::chrono_literals;

// Limits.
constexpr double kNoWaitForAThousand_s = 2;  // what telling may cost whoever has news
constexpr double kLongestEnd_s = 6;  // of a way that nobody listens to: 2 s and the last look
constexpr double kShortTimeout_s = 0.4;
constexpr double kTimeToBegin_s = 3;  // of a shell and its child, on a busy machine
constexpr double kGivenUp_s = 4;      // on a server that answers after six
constexpr auto kSoon = 10s;           // for what takes a moment on a machine with time

event_t event(std::int64_t id, int state = event_state::raised, int severity = severity::alarm) {
  event_t e{};
  e.id = id;
  e.time_us = 1'700'000'000 * kSecond_us + id;
  e.since_us = e.time_us - kSecond_us;
  e.state = state;
  e.severity = severity;
  e.kind = "stiffness_change";
  e.place = "kx_1_y1";
  e.value = -5.25;
  e.std_error = std::numeric_limits<double>::quiet_NaN();
  e.unit = "%";
  e.message = "kx_1_y1 is 5.2 % below its \"baseline\"";
  return e;
}

bool never() {
  return false;
}

double seconds_for(const std::function<void()>& work) {
  const std::int64_t began_us = steady_clock_us();
  work();
  return 1e-6 * static_cast<double>(steady_clock_us() - began_us);
}

std::vector<std::int64_t> ids(ActionQueue& queue, std::int64_t now_us) {
  std::vector<std::int64_t> out;
  while (const auto e = queue.take(now_us)) out.push_back(e->id);
  return out;
}

// --- which events, and when

TEST(ActionQueue, TellsWhatIsSevereEnoughAndThatItIsOver) {
  ActionQueue queue;
  ActionSettings settings;
  settings.kinds = {"stiffness_change", "gap"};
  queue.configure(settings);
  queue.put(event(1, event_state::raised, severity::information), false, 0);
  queue.put(event(1, event_state::cleared, severity::warning), false, 0);
  event_t other = event(2);
  other.kind = "bus_off";
  queue.put(other, false, 0);
  EXPECT_EQ(queue.waiting(), 0u);
  queue.put(event(3), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{3});
  queue.put(event(3, event_state::cleared, severity::information), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{3});
  queue.put(event(3, event_state::cleared, severity::information), false, 0);
  EXPECT_EQ(queue.waiting(), 0u);
}

TEST(ActionQueue, TellsWhatBeginsAndEndsAtOnce) {
  ActionQueue queue;
  queue.configure({});
  event_t e = event(1, event_state::cleared);
  e.since_us = e.time_us;
  queue.put(e, false, 0);
  EXPECT_EQ(queue.waiting(), 1u);
}

TEST(ActionQueue, OfChangesOnlyTheNewestIsToldAndNotAtOnce) {
  ActionQueue queue;
  ActionSettings settings;
  settings.changed_every_s = 10;
  queue.configure(settings);
  queue.put(event(1), false, 0);
  EXPECT_EQ(ids(queue, 0).size(), 1u);
  for (int i = 1; i <= 5; ++i) {
    event_t e = event(1, event_state::changed);
    e.value = i;
    queue.put(e, false, i * kSecond_us);
  }
  EXPECT_EQ(queue.merged(), 4);
  EXPECT_FALSE(queue.take(10 * kSecond_us - 1));
  const auto told = queue.take(10 * kSecond_us);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->value, 5);
  queue.put(event(1, event_state::changed), false, 11 * kSecond_us);
  queue.put(event(1, event_state::cleared), false, 12 * kSecond_us);
  EXPECT_EQ(queue.take(12 * kSecond_us).value_or(event_t{}).state, event_state::cleared);
  EXPECT_FALSE(queue.take(100 * kSecond_us));
}

TEST(ActionQueue, WhatNobodyWasToldIsToldAsRaised) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), false, 0);
  queue.put(event(1, event_state::changed), false, 0);
  EXPECT_EQ(queue.take(0).value_or(event_t{}).state, event_state::raised);
}

TEST(ActionQueue, TellsNoMoreThanSoManyInAMinuteTheMostSevereFirst) {
  ActionQueue queue;
  ActionSettings settings;
  settings.per_minute = 3;
  queue.configure(settings);
  for (int id = 1; id <= 6; ++id)
    queue.put(event(id, event_state::raised, id < 5 ? severity::warning : severity::alarm), false,
              0);
  EXPECT_EQ(ids(queue, 0), (std::vector<std::int64_t>{5, 6, 1}));
  EXPECT_TRUE(ids(queue, 19 * kSecond_us).empty());
  EXPECT_EQ(ids(queue, 20 * kSecond_us), std::vector<std::int64_t>{2});
  EXPECT_EQ(ids(queue, 600 * kSecond_us), (std::vector<std::int64_t>{3, 4}));
}

TEST(ActionQueue, IsBoundedAndLosesTheLeastSevere) {
  ActionQueue queue;
  queue.configure({});
  int lost = queue.put(event(0, event_state::raised, severity::warning), false, 0);
  for (std::size_t i = 1; i <= 2 * ActionQueue::kMost; ++i)
    lost += queue.put(event(static_cast<std::int64_t>(i)), false, 0);
  EXPECT_EQ(queue.waiting(), ActionQueue::kMost);
  EXPECT_EQ(lost, static_cast<int>(ActionQueue::kMost) + 1);
  EXPECT_EQ(queue.take(0).value_or(event_t{}).id, 1);
}

TEST(ActionQueue, WhatSomebodyKnowsIsNotToldAgainUntilItIsOver) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), true, 0);
  queue.told_before(event(2));
  queue.put(event(2, event_state::changed), true, 0);
  EXPECT_EQ(queue.waiting(), 0u);
  queue.put(event(2, event_state::cleared), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{2});
}

TEST(ActionQueue, WhatWaitsIsNotToldAnyMoreWhenSomebodyKnows) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), false, 0);
  queue.acknowledged(event(1));
  EXPECT_EQ(queue.waiting(), 0u);
  queue.put(event(1, event_state::cleared), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{1});
}

// --- the command

class Hook : public testing::Test {
 protected:
  /// A shell script as the command.
  ActionSettings script(const std::string& lines, std::vector<std::string> arguments = {}) {
    test::write_file(directory_.path("hook"),
                     "#!/bin/sh\ncd " + directory_.path("") + "\n" + lines);
    std::filesystem::permissions(directory_.path("hook"), std::filesystem::perms::owner_all);
    ActionSettings settings;
    settings.command = {directory_.path("hook")};
    settings.command.insert(settings.command.end(), arguments.begin(), arguments.end());
    return settings;
  }
  static Told run(const ActionSettings& settings) {
    const event_t e = event(7);
    return run_hook(settings, event_json(e, "a building"), event_environment(e, "a building"),
                    never);
  }
  std::string file(const std::string& name) { return test::read_file(directory_.path(name)); }

  test::TemporaryDirectory directory_;
};

TEST_F(Hook, GetsTheEventOnItsInputAndInItsEnvironment) {
  ::setenv("WATCHDOG_USEC", "1", 1);
  const Told told = run(
      script("cat >input; env >environment; printf '%s' \"$1\" >argument\n", {"$(touch made); *"}));
  ::unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(told.trouble, "");
  const auto json = nlohmann::json::parse(file("input"));
  EXPECT_EQ(json["schema"], "framewatch.event/1");
  EXPECT_EQ(json["state"], "raised");
  EXPECT_EQ(json["severity"], "alarm");
  EXPECT_EQ(json["id"], 7);
  EXPECT_EQ(json["value"], -5.25);
  EXPECT_TRUE(json["std_error"].is_null());
  EXPECT_EQ(json["time"], "2023-11-14T22:13:20.000Z");
  EXPECT_EQ(json["message"], event(7).message);
  EXPECT_EQ(file("argument"), "$(touch made); *");
  EXPECT_FALSE(std::filesystem::exists(directory_.path("made")));
  const std::string environment = file("environment");
  for (const char* line : {"FRAMEWATCH_KIND=stiffness_change\n", "FRAMEWATCH_STATE=raised\n",
                           "FRAMEWATCH_EVENT_ID=7\n", "FRAMEWATCH_BUILDING=a building\n", "PATH="})
    EXPECT_NE(environment.find(line), std::string::npos) << line;
  EXPECT_EQ(environment.find("WATCHDOG_USEC"), std::string::npos);
}

TEST_F(Hook, SaysWhyItFailed) {
  EXPECT_NE(run(script("echo so; echo it is so >&2; exit 3\n"))
                .trouble.find("hook: exit status 3: it is so"),
            std::string::npos);
  EXPECT_NE(run(script("kill -9 $$\n")).trouble.find("hook: signal 9"), std::string::npos);
  ActionSettings none;
  none.command = {"/no/such/program"};
  EXPECT_EQ(run(none).trouble, "/no/such/program: No such file or directory");
  EXPECT_FALSE(run(none).again);
}

TEST_F(Hook, IsEndedWithItsGroupWhenItTakesTooLong) {
  // It does not want to end, and neither does its child.
  ActionSettings settings = script(
      "trap '' TERM\nsh -c 'trap \"\" TERM; echo $$ >pid; while :; do sleep 0.1; done' &\n"
      "while :; do sleep 0.1; done\n");
  settings.command_timeout_s = kTimeToBegin_s;
  Told told;
  const double took_s = seconds_for([&] { told = run(settings); });
  EXPECT_NE(told.trouble.find("ended after 3 s"), std::string::npos) << told.trouble;
  EXPECT_LT(took_s, kTimeToBegin_s + kLongestEnd_s);
  ASSERT_NE(file("pid"), "");
  const pid_t pid = std::stoi(file("pid"));
  EXPECT_TRUE(test::comes_true(
      [&] {
        const std::string state = test::read_file("/proc/" + std::to_string(pid) + "/stat");
        return state.empty() || state.find(") Z") != std::string::npos;
      },
      kSoon));
}

TEST_F(Hook, MayReadNothingAndWriteALot) {
  ActionSettings settings = script("exec yes\n");
  settings.command_timeout_s = kShortTimeout_s;
  EXPECT_NE(run(settings).trouble.find("ended after"), std::string::npos);
  EXPECT_EQ(run(script("exec >&- 2>&-; sleep 0.3\n")).trouble, "");
}

// --- the webhook

class Webhook : public testing::Test {
 protected:
  static ActionSettings to(int port, const std::string& scheme = "http") {
    ActionSettings settings;
    settings.webhook = scheme + "://127.0.0.1:" + std::to_string(port) + "/events?a=b";
    return settings;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(Webhook, PostsJsonWithTheHeadersOfAFile) {
  test::HttpServer server;
  ActionSettings settings = to(server.port());
  settings.webhook_header_file = directory_.path("headers");
  test::write_file(settings.webhook_header_file,
                   "# a secret\nAuthorization: Bearer abc\r\n\nX-Building: 7\n");
  EXPECT_EQ(post_webhook(settings, "{\"a\":1}", never).trouble, "");
  ASSERT_EQ(server.requests().size(), 1u);
  test::HttpRequest request = server.requests().front();
  EXPECT_EQ(request.method, "POST");
  EXPECT_EQ(request.path, "/events");
  EXPECT_EQ(request.body, "{\"a\":1}");
  EXPECT_EQ(request.headers["content-type"], "application/json");
  EXPECT_EQ(request.headers["authorization"], "Bearer abc");
  EXPECT_EQ(request.headers["x-building"], "7");
}

TEST_F(Webhook, TriesAgainWhatMayPassAndNothingElse) {
  test::HttpServer server;
  const auto answered = [&](unsigned status) {
    server.answer({status});
    return post_webhook(to(server.port()), "{}", never);
  };
  EXPECT_EQ(answered(204).trouble, "");
  EXPECT_EQ(answered(500).trouble, "the server answers 500");
  for (const unsigned status : {500u, 503u, 429u}) EXPECT_TRUE(answered(status).again) << status;
  for (const unsigned status : {302u, 400u, 401u, 404u})
    EXPECT_FALSE(answered(status).again) << status;
  EXPECT_NE(answered(302).trouble, "");
}

TEST_F(Webhook, ASlowServerOneThatRefusesAndNoHeadersAreTroubles) {
  int port = 0;
  {
    test::HttpServer server;
    port = server.port();
    server.delay(6s);
    ActionSettings settings = to(port);
    settings.webhook_timeout_s = kShortTimeout_s;
    Told told;
    EXPECT_LT(seconds_for([&] { told = post_webhook(settings, "{}", never); }), kGivenUp_s);
    EXPECT_TRUE(told.again);
    EXPECT_NE(told.trouble.find("timed out"), std::string::npos) << told.trouble;
    EXPECT_LT(seconds_for([&] { (void)post_webhook(to(port), "{}", [] { return true; }); }),
              kGivenUp_s);
  }
  const Told refused = post_webhook(to(port), "{}", never);
  EXPECT_TRUE(refused.again);
  EXPECT_NE(refused.trouble, "");
  ActionSettings settings = to(port);
  settings.webhook_header_file = directory_.path("none");
  EXPECT_NE(post_webhook(settings, "{}", never).trouble.find("none: "), std::string::npos);
}

TEST_F(Webhook, TrustsNoCertificateOfItsOwnMaking) {
  const std::string key = directory_.path("key"), certificate = directory_.path("certificate");
  const std::string make =
      "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj "
      "/CN=test -addext subjectAltName=IP:127.0.0.1 -keyout " +
      key + " -out " + certificate + " 2>/dev/null";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "openssl makes no certificate";
  test::HttpServer server(0, test::read_file(certificate), test::read_file(key));
  ActionSettings settings = to(server.port(), "https");
  const Told refused = post_webhook(settings, "{}", never);
  EXPECT_NE(refused.trouble.find("certificate"), std::string::npos) << refused.trouble;
  EXPECT_TRUE(server.requests().empty());
  settings.webhook_ca_file = certificate;
  EXPECT_EQ(post_webhook(settings, "{}", never).trouble, "");
  settings.webhook = "https://localhost:" + std::to_string(server.port()) + "/";
  EXPECT_NE(post_webhook(settings, "{}", never).trouble, "");  // it is another name
  EXPECT_EQ(server.requests().size(), 1u);
}

// --- a thread of its own

TEST(ActionWay, NeverKeepsWhoeverHasNewsWaitingAndEndsInTime) {
  std::atomic<int> begun = 0;
  double end_s = 0;
  {
    ActionWay way("test", [&](const ActionSettings&, const event_t&, const Abandoned& abandoned) {
      ++begun;
      while (!abandoned()) std::this_thread::sleep_for(10ms);
      return Told{"nobody listens", true};
    });
    way.configure({}, 3600);
    EXPECT_LT(seconds_for([&] {
                for (int i = 0; i < 1000; ++i) way.event(event(i), false);
              }),
              kNoWaitForAThousand_s);
    EXPECT_TRUE(test::comes_true([&] { return begun > 0; }, kSoon));
    const ActionWay::Counters c = way.counters();
    EXPECT_EQ(c.waiting + c.lost, 1000);
    EXPECT_GT(c.lost_us, 0);
    end_s = 1e-6 * static_cast<double>(steady_clock_us());
  }
  EXPECT_LT(1e-6 * static_cast<double>(steady_clock_us()) - end_s, kLongestEnd_s);
}

TEST(ActionWay, TellsAgainUntilTheServerTakesItAndCountsWhatItDoesNot) {
  test::HttpServer server;
  server.answer({500, 503, 200, 404, 200});
  ActionSettings settings;
  settings.webhook = "http://127.0.0.1:" + std::to_string(server.port());
  ActionWay way("webhook",
                [](const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
                  return post_webhook(s, event_json(e, "b"), abandoned);
                });
  way.configure(settings, 60);
  way.event(event(1), false);
  EXPECT_TRUE(test::comes_true([&] { return !way.counters().trouble.empty(); }, kSoon));
  EXPECT_EQ(way.counters().waiting, 1);
  EXPECT_TRUE(test::comes_true([&] { return way.counters().told == 1; }, kSoon));
  EXPECT_EQ(way.counters().trouble, "");
  way.event(event(2), false);
  EXPECT_TRUE(test::comes_true([&] { return way.counters().lost == 1; }, kSoon));
  EXPECT_EQ(way.counters().trouble, "the server answers 404");
  way.event(event(3), false);
  EXPECT_TRUE(test::comes_true([&] { return way.counters().told == 2; }, kSoon));
  EXPECT_EQ(server.requests().size(), 5u);
}

TEST(ActionWay, AServerThatWasGoneIsToldWhatWaitedAndPatienceEnds) {
  int port = 0;
  {
    test::HttpServer server;
    port = server.port();
  }
  ActionSettings settings;
  settings.webhook = "http://127.0.0.1:" + std::to_string(port);
  ActionWay way("webhook",
                [](const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
                  return post_webhook(s, event_json(e, "b"), abandoned);
                });
  way.configure(settings, 60);
  way.event(event(1), false);
  way.event(event(2), false);
  EXPECT_TRUE(test::comes_true([&] { return !way.counters().trouble.empty(); }, kSoon));
  {
    test::HttpServer server(port);
    EXPECT_TRUE(test::comes_true([&] { return way.counters().told == 2; }, kSoon));
  }
  way.configure(settings, 0.5);
  way.event(event(3), false);
  EXPECT_TRUE(test::comes_true([&] { return way.counters().lost == 1; }, kSoon));
}

// --- all of it

std::string config_with_actions(const test::TemporaryDirectory& directory,
                                const std::string& keys) {
  const std::string path = directory.path("table.toml");
  test::write_file(path, test::read_file(test::table_config()) + "\n[actions]\n" + keys);
  return path;
}

TEST(Actions, ProblemsOfTheConfigurationAreToldAtOnce) {
  const test::TemporaryDirectory directory;
  const auto problems = [&](const std::string& keys) {
    std::vector<ConfigProblem> found;
    EXPECT_FALSE(load_config(config_with_actions(directory, keys), found));
    std::string all;
    for (const ConfigProblem& p : found) all += p.where + ": " + p.message + "\n";
    return all;
  };
  EXPECT_NE(problems("").find("needs a command or a webhook"), std::string::npos);
  EXPECT_NE(problems("webhook = \"ftp://a\"").find("http://"), std::string::npos);
  EXPECT_NE(problems("webhook = \"https:///a\"").find("must name a host"), std::string::npos);
  EXPECT_NE(problems("webhook = \"https://me:secret@a/\"").find("webhook_header_file"),
            std::string::npos);
  EXPECT_NE(problems("command = [\"a\"]\nwebhook_ca_file = \"b\"").find("needs a webhook"),
            std::string::npos);
  const std::string both = problems("command = [\"\"]\nseverity = \"bad\"\nper_minute = 0");
  EXPECT_NE(both.find("name of a program"), std::string::npos);
  EXPECT_NE(both.find("severity"), std::string::npos);
  EXPECT_NE(both.find("per_minute"), std::string::npos);
}

TEST(Actions, TellSaysWhetherSomebodyCanBeTold) {
  const test::TemporaryDirectory directory;
  EXPECT_EQ(tell_command({config_with_actions(directory, "command = [\"true\"]"), "a test"}), 0);
  EXPECT_EQ(tell_command({config_with_actions(directory, "command = [\"false\"]"), "a test"}), 1);
  EXPECT_EQ(tell_command({test::table_config(), "a test"}), 2);
}

}  // namespace
}  // namespace framewatch::daemon
