// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/webhook.h"

#include <chrono>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/http_server.h"
#include "tests/support/smtp_server.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace webhook_test {

using namespace std::chrono_literals;

// Limits.
constexpr double kShortTimeout_s = 0.4;
constexpr double kGivenUp_s = 4;  // with a server that answers after six

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
  EXPECT_EQ(post_webhook(settings, event(7), "a building", never).trouble, "");
  ASSERT_EQ(server.requests().size(), 1u);
  test::HttpRequest request = server.requests().front();
  EXPECT_EQ(request.method, "POST");
  EXPECT_EQ(request.path, "/events");
  EXPECT_EQ(request.body, event_json(event(7), "a building"));
  EXPECT_EQ(request.headers["content-type"], "application/json");
  EXPECT_EQ(request.headers["authorization"], "Bearer abc");
  EXPECT_EQ(request.headers["x-building"], "7");
}

TEST_F(Webhook, RetriesOnlyTemporaryFailures) {
  test::HttpServer server;
  const auto answered = [&](unsigned status) {
    server.answer({status});
    return post_webhook(to(server.port()), event(7), "b", never);
  };
  EXPECT_EQ(answered(204).trouble, "");
  EXPECT_EQ(answered(500).trouble, "the server answers 500");
  for (const unsigned status : {500u, 503u, 429u}) EXPECT_TRUE(answered(status).retry) << status;
  for (const unsigned status : {302u, 400u, 401u, 404u, 413u})
    EXPECT_FALSE(answered(status).retry) << status;
  EXPECT_NE(answered(302).trouble, "");
}

TEST_F(Webhook, SaysWhatTheServerAnsweredAndWhatToMend) {
  test::HttpServer server;
  server.answer({404});
  server.say("no_service\nat all");
  DeliveryResult result = post_webhook(to(server.port()), event(7), "b", never);
  EXPECT_EQ(result.trouble,
            "the server answers 404 (no_service): check the address: what it names does not exist "
            "any more");
  server.answer({401});
  EXPECT_NE(
      post_webhook(to(server.port()), event(7), "b", never).trouble.find("webhook_header_file"),
      std::string::npos);
  server.answer({200});
  server.say(std::string(5000, 'x') + "\x1b");
  result = post_webhook(to(server.port()), event(7), "b", never);
  EXPECT_EQ(result.trouble, "");
  EXPECT_EQ(result.answer, "200 (" + std::string(160, 'x') + ")");
}

TEST_F(Webhook, TakesThePauseThatTheServerAsksFor) {
  test::HttpServer server;
  server.answer({429});
  server.say("", "17");
  EXPECT_EQ(post_webhook(to(server.port()), event(7), "b", never).retry_after_s, 17);
  server.say("", "soon");
  EXPECT_EQ(post_webhook(to(server.port()), event(7), "b", never).retry_after_s, 0);
  server.answer({400});
  server.say("", "17");
  EXPECT_EQ(post_webhook(to(server.port()), event(7), "b", never).retry_after_s, 0);
}

TEST_F(Webhook, ReadsASecretAddressFromAFile) {
  test::HttpServer server;
  ActionSettings settings;
  settings.webhook_file = directory_.path("address");
  EXPECT_NE(post_webhook(settings, event(7), "b", never).trouble.find("address: "),
            std::string::npos);
  test::write_file(settings.webhook_file, "\nhttp://127.0.0.1/\n");
  EXPECT_NE(post_webhook(settings, event(7), "b", never).trouble.find("the first line is empty"),
            std::string::npos);
  test::write_file(settings.webhook_file, " " + to(server.port()).webhook + " \r\n");
  EXPECT_EQ(post_webhook(settings, event(7), "b", never).trouble, "");
  EXPECT_EQ(server.requests().front().path, "/events");
}

TEST_F(Webhook, PostsToTheRootOfNtfyAndTheKeyOfPagerDuty) {
  test::HttpServer server;
  const std::string root = "http://127.0.0.1:" + std::to_string(server.port());
  ActionSettings settings;
  settings.webhook = root + "/my-topic";
  settings.webhook_format = WebhookFormat::ntfy;
  EXPECT_EQ(post_webhook(settings, event(7), "b", never).trouble, "");
  EXPECT_EQ(server.requests().back().path, "/");
  EXPECT_EQ(nlohmann::json::parse(server.requests().back().body)["topic"], "my-topic");
  settings.webhook = root + "/v2/enqueue";
  settings.webhook_format = WebhookFormat::pagerduty;
  settings.webhook_key_file = directory_.path("key");
  const DeliveryResult missing = post_webhook(settings, event(7), "b", never);
  EXPECT_NE(missing.trouble.find("key: "), std::string::npos) << missing.trouble;
  EXPECT_EQ(server.requests().size(), 1u);
  test::write_file(settings.webhook_key_file, "abc\n");
  EXPECT_EQ(post_webhook(settings, event(7), "b", never).trouble, "");
  EXPECT_EQ(nlohmann::json::parse(server.requests().back().body)["routing_key"], "abc");
}

TEST_F(Webhook, ReportsASlowServerARefusalAndMissingHeaders) {
  int port = 0;
  {
    test::HttpServer server;
    port = server.port();
    server.delay(6s);
    ActionSettings settings = to(port);
    settings.webhook_timeout_s = kShortTimeout_s;
    DeliveryResult result;
    EXPECT_LT(seconds_for([&] { result = post_webhook(settings, event(7), "b", never); }),
              kGivenUp_s);
    EXPECT_TRUE(result.retry);
    EXPECT_NE(result.trouble.find("timed out"), std::string::npos) << result.trouble;
    EXPECT_LT(
        seconds_for([&] { (void)post_webhook(to(port), event(7), "b", [] { return true; }); }),
        kGivenUp_s);
  }
  const DeliveryResult refused = post_webhook(to(port), event(7), "b", never);
  EXPECT_TRUE(refused.retry);
  EXPECT_NE(refused.trouble, "");
  ActionSettings settings = to(port);
  settings.webhook_header_file = directory_.path("none");
  EXPECT_NE(post_webhook(settings, event(7), "b", never).trouble.find("none: "), std::string::npos);
}

TEST_F(Webhook, TrustsNoSelfSignedCertificate) {
  const test::TestCertificate made(directory_);
  test::HttpServer server(0, test::read_file(made.certificate), test::read_file(made.key));
  ActionSettings settings = to(server.port(), "https");
  const DeliveryResult refused = post_webhook(settings, event(7), "b", never);
  EXPECT_NE(refused.trouble.find("certificate"), std::string::npos) << refused.trouble;
  EXPECT_TRUE(server.requests().empty());
  settings.webhook_ca_file = made.certificate;
  EXPECT_EQ(post_webhook(settings, event(7), "b", never).trouble, "");
  settings.webhook = "https://localhost:" + std::to_string(server.port()) + "/";
  EXPECT_NE(post_webhook(settings, event(7), "b", never).trouble,
            "");  // the certificate has another name
  EXPECT_EQ(server.requests().size(), 1u);
}

}  // namespace webhook_test

}  // namespace framewatch::daemon
