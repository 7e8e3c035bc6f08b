#include "daemon/monitor/actions/receivers.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/http_server.h"
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
  for (const unsigned status : {500u, 503u, 429u}) EXPECT_TRUE(answered(status).retry) << status;
  for (const unsigned status : {302u, 400u, 401u, 404u})
    EXPECT_FALSE(answered(status).retry) << status;
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
    DeliveryResult result;
    EXPECT_LT(seconds_for([&] { result = post_webhook(settings, "{}", never); }), kGivenUp_s);
    EXPECT_TRUE(result.retry);
    EXPECT_NE(result.trouble.find("timed out"), std::string::npos) << result.trouble;
    EXPECT_LT(seconds_for([&] { (void)post_webhook(to(port), "{}", [] { return true; }); }),
              kGivenUp_s);
  }
  const DeliveryResult refused = post_webhook(to(port), "{}", never);
  EXPECT_TRUE(refused.retry);
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
  const DeliveryResult refused = post_webhook(settings, "{}", never);
  EXPECT_NE(refused.trouble.find("certificate"), std::string::npos) << refused.trouble;
  EXPECT_TRUE(server.requests().empty());
  settings.webhook_ca_file = certificate;
  EXPECT_EQ(post_webhook(settings, "{}", never).trouble, "");
  settings.webhook = "https://localhost:" + std::to_string(server.port()) + "/";
  EXPECT_NE(post_webhook(settings, "{}", never).trouble, "");  // the certificate has another name
  EXPECT_EQ(server.requests().size(), 1u);
}

}  // namespace webhook_test
}  // namespace framewatch::daemon
