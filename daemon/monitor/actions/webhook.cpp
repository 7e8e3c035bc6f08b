#include "daemon/monitor/actions/webhook.h"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"

namespace framewatch::daemon {
namespace {

struct Free {
  void operator()(CURL* curl) const { ::curl_easy_cleanup(curl); }
  void operator()(curl_slist* list) const { ::curl_slist_free_all(list); }
};
using Headers = std::unique_ptr<curl_slist, Free>;

void add(Headers& headers, const std::string& line) {
  curl_slist* const longer = ::curl_slist_append(headers.get(), line.c_str());
  if (longer == nullptr) return;
  (void)headers.release();
  headers.reset(longer);
}

std::size_t ignore_body(const char*, std::size_t size, std::size_t count, void*) {
  return size * count;
}

int should_stop(void* abandoned, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return (*static_cast<const Abandoned*>(abandoned))() ? 1 : 0;
}

/// Adds one header per line; skips empty lines and comments (#).
void add_lines(Headers& headers, const std::string& text) {
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, to - from);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (!line.empty() && line.front() != '#') add(headers, line);
    from = to + 1;
  }
}

/// Whether another attempt may succeed after this HTTP status.
bool may_pass(long status) {
  constexpr std::array<long, 3> kLater = {408, 425, 429};
  return status >= 500 || std::find(kLater.begin(), kLater.end(), status) != kLater.end();
}

}  // namespace

DeliveryResult post_webhook(const ActionSettings& settings, const std::string& json,
                            const Abandoned& abandoned) {
  if (settings.webhook.empty()) return {"no webhook is configured any more", false};
  Headers headers;
  add(headers, "Content-Type: application/json");
  add(headers, "Expect:");
  if (!settings.webhook_header_file.empty()) {
    std::string trouble;
    const std::optional<std::string> text = read_text_file(settings.webhook_header_file, trouble);
    if (!text) return {settings.webhook_header_file + ": " + trouble, true};
    add_lines(headers, *text);
  }
  static const CURLcode ready = ::curl_global_init(CURL_GLOBAL_DEFAULT);
  std::array<char, CURL_ERROR_SIZE> error{};
  const std::unique_ptr<CURL, Free> curl(ready == CURLE_OK ? ::curl_easy_init() : nullptr);
  if (!curl) return {"libcurl cannot begin", true};
  const auto set = [&](CURLoption option, auto value) {
    ::curl_easy_setopt(curl.get(), option, value);
  };
  const auto timeout_ms = static_cast<long>(1e3 * settings.webhook_timeout_s);
  set(CURLOPT_URL, settings.webhook.c_str());
  set(CURLOPT_PROTOCOLS_STR, "http,https");
  set(CURLOPT_FOLLOWLOCATION, 0L);
  set(CURLOPT_SSL_VERIFYPEER, 1L);
  set(CURLOPT_SSL_VERIFYHOST, 2L);
  if (!settings.webhook_ca_file.empty()) {
    set(CURLOPT_CAINFO, settings.webhook_ca_file.c_str());
    set(CURLOPT_CAPATH, static_cast<const char*>(nullptr));
  }
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_QUICK_EXIT, 1L);  // a silent name server does not delay the end of the program
  set(CURLOPT_TIMEOUT_MS, timeout_ms);
  set(CURLOPT_CONNECTTIMEOUT_MS, timeout_ms);
  set(CURLOPT_USERAGENT, "framewatch/" FRAMEWATCH_VERSION);
  set(CURLOPT_HTTPHEADER, headers.get());
  set(CURLOPT_POSTFIELDSIZE, static_cast<long>(json.size()));
  set(CURLOPT_POSTFIELDS, json.c_str());
  set(CURLOPT_WRITEFUNCTION, &ignore_body);
  set(CURLOPT_NOPROGRESS, 0L);
  set(CURLOPT_XFERINFOFUNCTION, &should_stop);
  set(CURLOPT_XFERINFODATA, &abandoned);
  set(CURLOPT_ERRORBUFFER, error.data());
  const CURLcode result = ::curl_easy_perform(curl.get());
  if (result != CURLE_OK)
    return {error[0] != '\0' ? error.data() : ::curl_easy_strerror(result), true};
  long status = 0;
  ::curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &status);
  if (status >= 200 && status < 300) return {};
  return {fmt::format("the server answers {}", status), may_pass(status)};
}

}  // namespace framewatch::daemon
