// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/email.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include "daemon/base/base64.h"
#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/secret_file.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/actions/curl_session.h"
#include "daemon/monitor/actions/webhook_body.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxSubject = 180;   // bytes
constexpr std::size_t kEncodedChunk = 42;  // bytes in one encoded word, which has 75 letters
constexpr std::size_t kMaxReply = 300;     // bytes of the server's replies that are kept
constexpr long kRefusedForGood = 500;      // replies from here on are final
constexpr std::size_t kReplyCode = 3;      // digits
constexpr const char* kGoodbye = "221";
constexpr const char* kUser = "FRAMEWATCH_EMAIL_USER";
constexpr const char* kPassword = "FRAMEWATCH_EMAIL_PASSWORD";

struct Login {
  std::string user, password;
};

/// Returns the login of the file or the environment; empty texts without one. Returns nullopt, with
/// `trouble`, if the file lacks it.
std::optional<Login> login_of(const EmailSettings& s, std::string& trouble) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  if (s.login_file.empty()) return Login{variable(kUser), variable(kPassword)};
  const std::optional<std::string> user = read_secret(s.login_file, trouble);
  if (!user) return std::nullopt;
  std::string none;
  const std::string text = read_text_file(s.login_file, none).value_or("");
  const auto second = text.find('\n');
  std::string password = second == std::string::npos ? "" : text.substr(second + 1);
  password.resize(std::min(password.size(), password.find_first_of("\r\n")));
  if (password.empty()) {
    trouble = s.login_file + ": the password is missing in line 2";
    return std::nullopt;
  }
  return Login{*user, password};
}

std::string address_of(const EmailSettings& s) {
  const bool tls = s.tls == EmailTls::tls;
  const int usual = tls ? 465 : s.tls == EmailTls::starttls ? 587 : 25;
  return fmt::format("{}://{}:{}", tls ? "smtps" : "smtp", s.server, s.port == 0 ? usual : s.port);
}

/// Returns "Sat, 28 Nov 2026 14:06:54 +0000", in English whatever the locale.
std::string date_text(std::int64_t time_us) {
  constexpr std::array kDays = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                  "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::time_t seconds = time_us / kSecond_us;
  std::tm t{};
  ::gmtime_r(&seconds, &t);
  return fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} +0000",
                     kDays[static_cast<std::size_t>(t.tm_wday)], t.tm_mday,
                     kMonths[static_cast<std::size_t>(t.tm_mon)], 1900 + t.tm_year, t.tm_hour,
                     t.tm_min, t.tm_sec);
}

/// Returns "<ID@HOST>" of letters that every mail server accepts.
std::string message_id(const std::string& id, const std::string& from) {
  return fmt::format("<{}@{}>", sha256(id).substr(0, 32), from.substr(from.find('@') + 1));
}

CurlLines headers_of(const EmailSettings& s, const std::string& to, const Email& email) {
  CurlLines out;
  add_line(out, "Date: " + date_text(host_clock_us()));
  add_line(out, "From: framewatch <" + s.from + ">");
  add_line(out, "To: <" + to + ">");
  add_line(out, "Subject: " + header_value(printable(email.subject, kMaxSubject)));
  add_line(out, "Message-ID: " + message_id(email.id + to, s.from));
  if (!email.thread.empty()) add_line(out, "References: " + message_id(email.thread + to, s.from));
  add_line(out, "Auto-Submitted: auto-generated");
  return out;
}

std::string with_crlf(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') out += '\r';
    out += c;
  }
  return out;
}

/// Returns the parts of the message; null if memory is short.
std::unique_ptr<curl_mime, CurlFree> parts_of(CURL* curl, const Email& email) {
  std::unique_ptr<curl_mime, CurlFree> out(::curl_mime_init(curl));
  curl_mimepart* const text = ::curl_mime_addpart(out.get());
  const std::string body = with_crlf(email.body);
  bool good = ::curl_mime_data(text, body.c_str(), body.size()) == CURLE_OK &&
              ::curl_mime_type(text, "text/plain; charset=utf-8") == CURLE_OK &&
              ::curl_mime_encoder(text, "quoted-printable") == CURLE_OK;
  for (const EmailAttachment& a : email.attachments) {
    curl_mimepart* const part = ::curl_mime_addpart(out.get());
    good = good && ::curl_mime_data(part, a.bytes.data(), a.bytes.size()) == CURLE_OK &&
           ::curl_mime_type(part, a.type.c_str()) == CURLE_OK &&
           ::curl_mime_filename(part, a.name.c_str()) == CURLE_OK &&
           ::curl_mime_encoder(part, "base64") == CURLE_OK;
  }
  if (!good) out.reset();
  return out;
}

/// Keeps the newest reply of the server, without its line end. Leaves out the one to QUIT, which
/// libcurl also sends after a refusal.
std::size_t keep_reply(const char* data, std::size_t size, std::size_t count, void* into) {
  const std::string_view reply(data, std::min(size * count, kMaxReply));
  if (!reply.starts_with(kGoodbye))
    *static_cast<std::string*>(into) = reply.substr(0, reply.find_first_of("\r\n"));
  return size * count;
}

/// Returns the code of a reply, such as 550; 0 without one.
long code_of(const std::string& reply) {
  return std::strtol(reply.substr(0, kReplyCode).c_str(), nullptr, 10);
}

/// Returns what an operator can do about a failure, or an empty text.
std::string remedy(CURLcode code, long status, bool has_login) {
  switch (code) {
    case CURLE_LOGIN_DENIED:
      return has_login ? "check the user and the password in login_file"
                       : "the server wants a login: give login_file in [email]";
    case CURLE_USE_SSL_FAILED:
      return "the server offers no STARTTLS: set tls = \"tls\" if it has a port for it";
    case CURLE_SSL_CONNECT_ERROR:
      return "check port and tls: 587 is usual for starttls, 465 for tls";
    case CURLE_PEER_FAILED_VERIFICATION:
      return "check the name of the server, or name its certificate in ca_file";
    case CURLE_COULDNT_RESOLVE_HOST:
      return "check the name of the server";
    default:
      break;
  }
  if (status == 530) return "the server wants a login: give login_file in [email]";
  if (status == 552) return "the message is too large for the server";
  if (status >= kRefusedForGood)
    return "check the addresses in from and email, and the server's rules";
  return {};
}

}  // namespace

std::string header_value(const std::string& text) {
  const std::string line = printable(text);
  if (std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; }))
    return line;
  std::string out, chunk;
  const auto flush = [&] {
    if (!chunk.empty()) out += (out.empty() ? "=?UTF-8?B?" : " =?UTF-8?B?") + base64(chunk) + "?=";
    chunk.clear();
  };
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t bytes =
        std::max<std::size_t>(1, first_character(std::string_view(line).substr(at)).bytes);
    if (chunk.size() + bytes > kEncodedChunk) flush();
    chunk += line.substr(at, bytes);
    at += bytes;
  }
  flush();
  return out;
}

Email event_email(const event_t& e, const std::string& building) {
  Email out;
  out.subject = fmt::format("{}: {}: {}", building, state_words(e), e.message);
  out.id = fmt::format("{}/{}/{}/{}/{}", building, e.kind, e.id, e.time_us, e.state);
  out.thread = fmt::format("{}/{}/{}", building, e.kind, e.id);
  out.body = printable(e.message) + "\n\n";
  const auto line = [&](const char* name, const std::string& value) {
    if (!value.empty()) out.body += fmt::format("{:<10} {}\n", name, printable(value));
  };
  line("building", building);
  line("state", state_words(e));
  line("kind", e.kind);
  line("place", e.place);
  line("time", utc_text(e.time_us));
  if (!is_momentary(e)) line("since", utc_text(e.since_us));
  line("file", e.segment);
  if (e.state != event_state::cleared)
    out.body += fmt::format(
        "\nTo stop messages about this event until it clears, run on the building's machine:\n"
        "  framewatch acknowledge {} --comment \"what you found\"\n",
        e.id);
  return out;
}

DeliveryResult send_email(const EmailSettings& s, const std::string& to, const Email& email,
                          const Abandoned& abandoned) {
  std::string trouble, reply;
  const std::optional<Login> login = login_of(s, trouble);
  if (!login) return {trouble, true};
  const bool has_login = !login->user.empty();
  if (has_login && s.tls == EmailTls::none)
    return {"a login needs tls = \"starttls\" or \"tls\" in [email]", false};
  CurlSession curl(s.ca_file, s.timeout_s, abandoned);
  if (!curl.good()) return {"libcurl cannot start", true};
  const CurlLines headers = headers_of(s, to, email);
  const auto parts = parts_of(curl.get(), email);
  if (!parts) return {"no memory for the message", true};
  CurlLines recipients;
  add_line(recipients, "<" + to + ">");
  const std::string url = address_of(s), from = "<" + s.from + ">";
  curl.set(CURLOPT_URL, url.c_str());
  curl.set(CURLOPT_PROTOCOLS_STR, "smtp,smtps");
  if (s.tls != EmailTls::none) curl.set(CURLOPT_USE_SSL, static_cast<long>(CURLUSESSL_ALL));
  if (has_login) {
    curl.set(CURLOPT_USERNAME, login->user.c_str());
    curl.set(CURLOPT_PASSWORD, login->password.c_str());
  }
  curl.set(CURLOPT_MAIL_FROM, from.c_str());
  curl.set(CURLOPT_MAIL_RCPT, recipients.get());
  curl.set(CURLOPT_HTTPHEADER, headers.get());
  curl.set(CURLOPT_MIMEPOST, parts.get());
  curl.set(CURLOPT_HEADERFUNCTION, &keep_reply);
  curl.set(CURLOPT_HEADERDATA, &reply);
  CURLcode code = CURLE_OK;
  trouble = curl.perform(code);
  DeliveryResult out;
  out.answer = printable(reply);
  if (code == CURLE_OK) return out;
  const long status = code_of(reply);
  const bool refused = status >= kRefusedForGood || code == CURLE_USE_SSL_FAILED ||
                       (code == CURLE_LOGIN_DENIED && status < 400);
  const std::string advice = remedy(code, status, has_login);
  out.trouble = fmt::format("{}: {}{}{}", to, trouble, status < 400 ? "" : " (" + out.answer + ")",
                            advice.empty() ? "" : ": " + advice);
  out.retry = !refused;
  return out;
}

DeliveryResult EmailRound::send(const EmailSettings& settings,
                                const std::vector<std::string>& people, const Email& email,
                                const Abandoned& abandoned) {
  if (people.empty()) return {"email was removed from [actions]", false};
  if (id_ != email.id) {
    id_ = email.id;
    done_.clear();
    refused_.clear();
  }
  DeliveryResult out;
  const auto add = [&out](const std::string& trouble) {
    out.trouble += (out.trouble.empty() ? "" : "; ") + trouble;
  };
  for (const std::string& to : people) {
    if (done_.contains(to)) continue;
    if (const auto refused = refused_.find(to); refused != refused_.end()) {
      add(refused->second);
      continue;
    }
    const DeliveryResult one = send_email(settings, to, email, abandoned);
    if (one.trouble.empty()) {
      done_.insert(to);
      out.answer = one.answer;
      continue;
    }
    if (!one.retry) refused_.emplace(to, one.trouble);
    out.retry = out.retry || one.retry;
    add(one.trouble);
  }
  out.partly = !out.trouble.empty() && !out.retry && !done_.empty();
  return out;
}

}  // namespace framewatch::daemon
