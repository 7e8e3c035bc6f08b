// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/webhook.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <sstream>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/secret_file.h"
#include "daemon/monitor/actions/curl_session.h"
#include "daemon/monitor/actions/webhook_body.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kPagerDuty = "https://events.pagerduty.com/v2/enqueue";
constexpr std::size_t kMaxAnswer = 160;  // bytes of the answer that are kept

/// Adds one header per line; skips empty lines and comments (#).
void add_header_lines(CurlLines& headers, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (!line.empty() && line.front() != '#') add_line(headers, line);
  }
}

std::size_t keep_answer(const char* data, std::size_t size, std::size_t count, void* into) {
  auto& answer = *static_cast<std::string*>(into);
  answer.append(data, std::min(size * count, kMaxAnswer - std::min(kMaxAnswer, answer.size())));
  return size * count;
}

/// Returns true if another attempt may succeed after this HTTP status.
bool may_pass(long status) {
  constexpr std::array<long, 3> kLater = {408, 425, 429};
  return status >= 500 || std::find(kLater.begin(), kLater.end(), status) != kLater.end();
}

/// Returns what an operator can do about a refusal, or an empty text.
std::string remedy(long status, WebhookFormat format) {
  const bool pagerduty = format == WebhookFormat::pagerduty;
  if (status >= 300 && status < 400)
    return "framewatch follows no redirection: set webhook to the new address";
  switch (status) {
    case 400:
    case 422:
      return pagerduty ? "check the integration key in webhook_key_file"
                       : "check that webhook_format is that of the server";
    case 401:
    case 403:
    case 407:
      return "check the credentials: webhook_header_file, or the secret in the address";
    case 404:
    case 410:
      return "check the address: what it names does not exist any more";
    case 405:
    case 415:
      return "check the address and webhook_format: the server does not take a POST with JSON";
    default:
      return may_pass(status) ? "" : "ask the operator of the server";
  }
}

/// The address of the request, and the topic of ntfy.
struct Address {
  std::string url, topic;
};

/// Returns the address, or nullopt with `trouble`. ntfy takes JSON at the server's root.
std::optional<Address> address_of(const ActionSettings& s, std::string& trouble) {
  Address out{s.webhook, {}};
  if (!s.webhook_file.empty()) {
    const std::optional<std::string> line = read_secret(s.webhook_file, trouble);
    if (!line) return std::nullopt;
    out.url = *line;
  } else if (out.url.empty()) {
    out.url = kPagerDuty;
  }
  if (s.webhook_format != WebhookFormat::ntfy) return out;
  const auto scheme = out.url.find("://");
  const auto slash = scheme == std::string::npos ? scheme : out.url.find('/', scheme + 3);
  if (slash == std::string::npos || slash + 1 == out.url.size()) {
    trouble = s.webhook_file + ": the address must end with the topic of ntfy";
    return std::nullopt;
  }
  out.topic = out.url.substr(slash + 1);
  out.url.resize(slash + 1);
  return out;
}

/// Collects the headers of the request. Returns false, with `trouble`, if a file cannot be read.
bool collect_headers(const ActionSettings& s, CurlLines& headers, std::string& trouble) {
  add_line(headers, "Content-Type: application/json");
  add_line(headers, "Expect:");
  if (s.webhook_header_file.empty()) return true;
  const std::optional<std::string> text = read_text_file(s.webhook_header_file, trouble);
  if (!text) {
    trouble = s.webhook_header_file + ": " + trouble;
    return false;
  }
  add_header_lines(headers, *text);
  return true;
}

/// Returns the first line of the server's answer for people, in parentheses; may be empty.
std::string quoted(const std::string& answer) {
  const std::string line = printable(answer.substr(0, answer.find_first_of("\r\n")));
  return line.empty() ? "" : " (" + line + ")";
}

DeliveryResult judged(CurlSession& curl, const std::string& answer, WebhookFormat format) {
  const long status = curl.status();
  DeliveryResult out;
  out.answer = fmt::format("{}{}", status, quoted(answer));
  if (status >= 200 && status < 300) return out;
  const std::string advice = remedy(status, format);
  out.trouble =
      fmt::format("the server answers {}{}", out.answer, advice.empty() ? "" : ": " + advice);
  out.retry = may_pass(status);
  curl_off_t wait_s = 0;
  ::curl_easy_getinfo(curl.get(), CURLINFO_RETRY_AFTER, &wait_s);
  if (out.retry) out.retry_after_s = static_cast<double>(std::max<curl_off_t>(wait_s, 0));
  return out;
}

}  // namespace

DeliveryResult post_webhook(const ActionSettings& s, const event_t& event,
                            const std::string& building, const Abandoned& abandoned) {
  if (!s.has_webhook()) return {"the webhook was removed from [actions]", false};
  std::string trouble, key, answer;
  const std::optional<Address> address = address_of(s, trouble);
  if (!address) return {trouble, true};
  if (!s.webhook_key_file.empty()) {
    const std::optional<std::string> line = read_secret(s.webhook_key_file, trouble);
    if (!line) return {trouble, true};
    key = *line;
  }
  CurlLines headers;
  if (!collect_headers(s, headers, trouble)) return {trouble, true};
  CurlSession curl(s.webhook_ca_file, s.webhook_timeout_s, abandoned);
  if (!curl.good()) return {"libcurl cannot start", true};
  const std::string body = webhook_body(s.webhook_format, event, building, address->topic, key);
  curl.set(CURLOPT_URL, address->url.c_str());
  curl.set(CURLOPT_PROTOCOLS_STR, "http,https");
  curl.set(CURLOPT_FOLLOWLOCATION, 0L);
  curl.set(CURLOPT_USERAGENT, "framewatch/" FRAMEWATCH_VERSION);
  curl.set(CURLOPT_HTTPHEADER, headers.get());
  curl.set(CURLOPT_POSTFIELDSIZE, static_cast<long>(body.size()));
  curl.set(CURLOPT_POSTFIELDS, body.c_str());
  curl.set(CURLOPT_WRITEFUNCTION, &keep_answer);
  curl.set(CURLOPT_WRITEDATA, &answer);
  CURLcode code = CURLE_OK;
  trouble = curl.perform(code);
  if (code == CURLE_PEER_FAILED_VERIFICATION)
    trouble += ": check the address, or name the server's certificate in webhook_ca_file";
  if (code != CURLE_OK) return {trouble, true};
  return judged(curl, answer, s.webhook_format);
}

}  // namespace framewatch::daemon
