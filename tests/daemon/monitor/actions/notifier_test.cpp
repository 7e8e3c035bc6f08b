#include "daemon/monitor/actions/notifier.h"

#include <atomic>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/monitor/actions/receivers.h"
#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/http_server.h"

namespace framewatch::daemon {
namespace notifier_test {

using namespace std::chrono_literals;

// Limits.
constexpr double kNoWaitForAThousand_s = 2;  // time that the caller may lose
constexpr double kLongestEnd_s = 6;  // with a receiver that does not answer: 2 s and the last poll
constexpr auto kSoon = 10s;          // for short actions on an idle machine

TEST(Notifier, NeverKeepsWhoeverHasNewsWaitingAndEndsInTime) {
  std::atomic<int> begun = 0;
  double end_s = 0;
  {
    Notifier notifier("test",
                      [&](const ActionSettings&, const event_t&, const Abandoned& abandoned) {
                        ++begun;
                        while (!abandoned()) std::this_thread::sleep_for(10ms);
                        return DeliveryResult{"nobody listens", true};
                      });
    notifier.configure({}, 3600);
    EXPECT_LT(seconds_for([&] {
                for (int i = 0; i < 1000; ++i) notifier.event(event(i), false);
              }),
              kNoWaitForAThousand_s);
    EXPECT_TRUE(test::comes_true([&] { return begun > 0; }, kSoon));
    const Notifier::Counters c = notifier.counters();
    EXPECT_EQ(c.waiting + c.lost, 1000);
    EXPECT_GT(c.lost_us, 0);
    end_s = 1e-6 * static_cast<double>(steady_clock_us());
  }
  EXPECT_LT(1e-6 * static_cast<double>(steady_clock_us()) - end_s, kLongestEnd_s);
}

TEST(Notifier, TellsAgainUntilTheServerTakesItAndCountsWhatItDoesNot) {
  test::HttpServer server;
  server.answer({500, 503, 200, 404, 200});
  ActionSettings settings;
  settings.webhook = "http://127.0.0.1:" + std::to_string(server.port());
  Notifier notifier("webhook",
                    [](const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
                      return post_webhook(s, event_json(e, "b"), abandoned);
                    });
  notifier.configure(settings, 60);
  notifier.event(event(1), false);
  EXPECT_TRUE(test::comes_true([&] { return !notifier.counters().trouble.empty(); }, kSoon));
  EXPECT_EQ(notifier.counters().waiting, 1);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 1; }, kSoon));
  EXPECT_EQ(notifier.counters().trouble, "");
  notifier.event(event(2), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().lost == 1; }, kSoon));
  EXPECT_EQ(notifier.counters().trouble, "the server answers 404");
  notifier.event(event(3), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 2; }, kSoon));
  EXPECT_EQ(server.requests().size(), 5u);
}

TEST(Notifier, AServerThatWasGoneIsToldWhatWaitedAndPatienceEnds) {
  int port = 0;
  {
    test::HttpServer server;
    port = server.port();
  }
  ActionSettings settings;
  settings.webhook = "http://127.0.0.1:" + std::to_string(port);
  Notifier notifier("webhook",
                    [](const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
                      return post_webhook(s, event_json(e, "b"), abandoned);
                    });
  notifier.configure(settings, 60);
  notifier.event(event(1), false);
  notifier.event(event(2), false);
  EXPECT_TRUE(test::comes_true([&] { return !notifier.counters().trouble.empty(); }, kSoon));
  {
    test::HttpServer server(port);
    EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 2; }, kSoon));
  }
  notifier.configure(settings, 0.5);
  notifier.event(event(3), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().lost == 1; }, kSoon));
}

}  // namespace notifier_test
}  // namespace framewatch::daemon
