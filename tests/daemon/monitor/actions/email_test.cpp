// SPDX-License-Identifier: MIT
// Tests e-mail against a small mail server that refuses, defers and cuts off.
#include "daemon/monitor/actions/email.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/smtp_server.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace email_test {

constexpr double kPatient_s = 30;

EmailSettings account(const test::SmtpServer& server, EmailTls tls = EmailTls::none) {
  EmailSettings out;
  out.server = "127.0.0.1";
  out.port = server.port();
  out.tls = tls;
  out.from = "framewatch@example.org";
  out.timeout_s = kPatient_s;
  return out;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Email, CarriesTextAndAttachment) {
  const test::SmtpServer server;
  Email email = event_email(event(7), "north wing");
  email.body +=
      ".a line that begins with a dot\nstiffness \xe2\x88\x92"
      "5 %\n";
  email.attachments.push_back({"kx_1_y1.png", "image/png", std::string("\x89PNG\0\r\n", 7)});
  const DeliveryResult result = send_email(account(server), "owner@example.org", email, never);
  EXPECT_EQ(result.trouble, "");
  EXPECT_EQ(result.answer, "250 2.0.0 queued as 1");
  const std::string message = server.message(1);
  for (const char* part :
       {"X-Envelope: <framewatch@example.org> owner@example.org\r\n",
        "Subject: north wing: alarm raised: kx_1_y1 is 5.2 % below its \"baseline\"\r\n",
        "From: framewatch <framewatch@example.org>\r\n", "To: <owner@example.org>\r\n",
        "Message-ID: <", "References: <", "Auto-Submitted: auto-generated\r\n", " +0000\r\n",
        "\r\n\r\nkx_1_y1 is 5.2 % below its", "framewatch acknowledge 7",
        "\r\n.a line that begins with a dot\r\n", "stiffness =E2=88=925 %\r\n",
        "filename=\"kx_1_y1.png\"", "iVBORwANCg=="})
    EXPECT_TRUE(has(message, part)) << part << "\n" << message;
}

TEST(Email, CannotBeGivenFurtherHeadersByAnEvent) {
  const test::SmtpServer server;
  event_t e = event(7);
  e.message = "a\r\nBcc: thief@example.org\r\n\r\nbody";
  EXPECT_EQ(send_email(account(server), "owner@example.org", event_email(e, "x\ny"), never).trouble,
            "");
  EXPECT_FALSE(has(server.message(1), "\nBcc:"));
  EXPECT_TRUE(has(server.message(1), "Subject: x\\ny: alarm raised: a\\r\\nBcc:"))
      << server.message(1);
}

TEST(Email, HeadersBeyondAsciiAreEncoded) {
  EXPECT_EQ(header_value("Turm: -5 %"), "Turm: -5 %");
  EXPECT_EQ(header_value("T\xc3\xbcrme"), "=?UTF-8?B?VMO8cm1l?=");
  const std::string words = header_value(std::string(100, 'x') + "\xc2\xb1");
  EXPECT_TRUE(std::all_of(words.begin(), words.end(), [](char c) { return c >= ' ' && c <= '~'; }));
  EXPECT_EQ(std::count(words.begin(), words.end(), ' '), 2) << words;
}

TEST(Email, LogsInOverTlsAndTrustsNoUnknownCertificate) {
  const test::TemporaryDirectory folder;
  const test::TestCertificate made(folder);
  test::write_file(folder.path("login"), "user\npass word\n");
  for (const EmailTls tls : {EmailTls::starttls, EmailTls::tls}) {
    const test::SmtpServer server({"--tls", tls == EmailTls::tls ? "tls" : "starttls", "--cert",
                                   made.certificate, "--key", made.key, "--login",
                                   "user:pass word"});
    EmailSettings s = account(server, tls);
    s.login_file = folder.path("login");
    const Email email = event_email(event(7), "b");
    const DeliveryResult untrusted = send_email(s, "a@example.org", email, never);
    EXPECT_TRUE(has(untrusted.trouble, "ca_file")) << untrusted.trouble;
    EXPECT_FALSE(has(server.commands(), "AUTH"));
    s.ca_file = made.certificate;
    EXPECT_EQ(send_email(s, "a@example.org", email, never).trouble, "");
    EXPECT_TRUE(has(server.message(1), "a@example.org"));
    test::write_file(folder.path("wrong"), "user\nother\n");
    s.login_file = folder.path("wrong");
    const DeliveryResult denied = send_email(s, "a@example.org", email, never);
    EXPECT_TRUE(has(denied.trouble, "check the user and the password")) << denied.trouble;
    EXPECT_FALSE(has(denied.trouble, "other"));
    EXPECT_FALSE(denied.retry);
    s.login_file.clear();
    const DeliveryResult nobody = send_email(s, "a@example.org", email, never);
    EXPECT_TRUE(has(nobody.trouble, "login_file")) << nobody.trouble;
    ::setenv("FRAMEWATCH_EMAIL_USER", "user", 1);
    ::setenv("FRAMEWATCH_EMAIL_PASSWORD", "pass word", 1);
    EXPECT_EQ(send_email(s, "a@example.org", email, never).trouble, "");
    ::unsetenv("FRAMEWATCH_EMAIL_USER");
    ::unsetenv("FRAMEWATCH_EMAIL_PASSWORD");
    EXPECT_NE(server.message(2), "");
  }
}

TEST(Email, NeverSendsALoginWithoutEncryption) {
  const test::TemporaryDirectory folder;
  test::write_file(folder.path("login"), "user\npassword\n");
  const test::SmtpServer server;
  EmailSettings s = account(server, EmailTls::starttls);
  s.login_file = folder.path("login");
  const Email email = event_email(event(7), "b");
  const DeliveryResult plain = send_email(s, "a@example.org", email, never);
  EXPECT_TRUE(has(plain.trouble, "offers no STARTTLS")) << plain.trouble;
  EXPECT_FALSE(plain.retry);
  s.tls = EmailTls::none;
  EXPECT_TRUE(has(send_email(s, "a@example.org", email, never).trouble, "a login needs tls"));
  EXPECT_FALSE(has(server.commands(), "AUTH"));
  EXPECT_EQ(server.message(1), "");
}

TEST(Email, ReportsMissingSecretsAndAnAbsentServer) {
  const test::TemporaryDirectory folder;
  EmailSettings s;
  {
    const test::SmtpServer server;
    s = account(server, EmailTls::starttls);
  }
  const Email email = event_email(event(7), "b");
  const DeliveryResult absent = send_email(s, "a@example.org", email, never);
  EXPECT_TRUE(absent.retry);
  EXPECT_TRUE(has(absent.trouble, "127.0.0.1")) << absent.trouble;
  EXPECT_FALSE(has(absent.trouble, " ms")) << absent.trouble;  // a repetition would be logged anew
  s.login_file = folder.path("none");
  EXPECT_TRUE(has(send_email(s, "a@example.org", email, never).trouble, "none: "));
  test::write_file(s.login_file, "user\n");
  EXPECT_TRUE(has(send_email(s, "a@example.org", email, never).trouble,
                  "the password is missing in line 2"));
}

TEST(Email, ARefusedAddressKeepsNobodyElseFromBeingTold) {
  const test::SmtpServer server({"--refuse", "gone@example.org"});
  EmailRound round;
  const DeliveryResult result =
      round.send(account(server), {"a@example.org", "gone@example.org", "b@example.org"},
                 event_email(event(7), "b"), never);
  EXPECT_TRUE(result.partly);
  EXPECT_FALSE(result.retry);
  EXPECT_TRUE(has(result.trouble, "gone@example.org: ")) << result.trouble;
  EXPECT_TRUE(has(result.trouble, "550 5.1.1 no such user")) << result.trouble;
  EXPECT_TRUE(has(server.message(1), "To: <a@example.org>"));
  EXPECT_TRUE(has(server.message(2), "To: <b@example.org>"));
  const DeliveryResult alone =
      round.send(account(server), {"gone@example.org"}, event_email(event(8), "b"), never);
  EXPECT_FALSE(alone.partly);
  EXPECT_FALSE(alone.retry);
}

TEST(Email, ADeferredOrCutOffMessageIsRepeatedForThoseWhoLackIt) {
  const test::SmtpServer server({"--defer", "1", "--cut", "1"});
  EmailRound round;
  const std::vector<std::string> people = {"a@example.org", "b@example.org", "c@example.org"};
  const Email email = event_email(event(7), "b");
  // a is deferred, b is cut off, c gets it.
  const DeliveryResult first = round.send(account(server), people, email, never);
  EXPECT_TRUE(first.retry);
  EXPECT_FALSE(first.partly);
  EXPECT_TRUE(has(first.trouble, "450 4.2.0 greylisted")) << first.trouble;
  EXPECT_TRUE(has(first.trouble, "b@example.org: ")) << first.trouble;
  EXPECT_TRUE(has(server.message(1), "To: <c@example.org>"));
  EXPECT_EQ(round.send(account(server), people, email, never).trouble, "");
  EXPECT_TRUE(has(server.message(2), "To: <a@example.org>"));
  EXPECT_TRUE(has(server.message(3), "To: <b@example.org>"));
  EXPECT_EQ(server.message(4), "");
}

}  // namespace email_test
}  // namespace framewatch::daemon
