// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/curl_session.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace framewatch::daemon {
namespace {

int should_stop(void* abandoned, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return (*static_cast<const Abandoned*>(abandoned))() ? 1 : 0;
}

/// Returns libcurl's reason without its " after 31 ms", which would make each repetition of a
/// failure a new line in the log.
std::string without_duration(std::string reason) {
  constexpr std::string_view kAfter = " after ";
  const std::size_t at = reason.find(kAfter);
  if (at == std::string::npos) return reason;
  const std::size_t number = at + kAfter.size();
  const std::size_t end = std::min(reason.find_first_not_of("0123456789", number), reason.size());
  for (const std::string_view unit : {" milliseconds", " ms"})
    if (end > number && std::string_view(reason).substr(end).starts_with(unit))
      return reason.erase(at, end + unit.size() - at);
  return reason;
}

}  // namespace

void add_line(CurlLines& lines, const std::string& line) {
  curl_slist* const longer = ::curl_slist_append(lines.get(), line.c_str());
  if (longer == nullptr) return;
  (void)lines.release();
  lines.reset(longer);
}

CurlSession::CurlSession(const std::string& ca_file, double timeout_s, const Abandoned& abandoned) {
  static const CURLcode ready = ::curl_global_init(CURL_GLOBAL_DEFAULT);
  if (ready != CURLE_OK) return;
  curl_.reset(::curl_easy_init());
  if (!curl_) return;
  const auto timeout_ms = static_cast<long>(1e3 * timeout_s);
  set(CURLOPT_SSL_VERIFYPEER, 1L);
  set(CURLOPT_SSL_VERIFYHOST, 2L);
  if (!ca_file.empty()) {
    set(CURLOPT_CAINFO, ca_file.c_str());
    set(CURLOPT_CAPATH, static_cast<const char*>(nullptr));
  }
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_QUICK_EXIT, 1L);  // a slow name server must not delay the end of the program
  set(CURLOPT_TIMEOUT_MS, timeout_ms);
  set(CURLOPT_CONNECTTIMEOUT_MS, timeout_ms);
  set(CURLOPT_NOPROGRESS, 0L);
  set(CURLOPT_XFERINFOFUNCTION, &should_stop);
  set(CURLOPT_XFERINFODATA, &abandoned);
  set(CURLOPT_ERRORBUFFER, error_.data());
}

std::string CurlSession::perform(CURLcode& code) {
  error_[0] = '\0';
  code = ::curl_easy_perform(curl_.get());
  if (code == CURLE_OK) return {};
  return without_duration(error_[0] != '\0' ? error_.data() : ::curl_easy_strerror(code));
}

long CurlSession::status() {
  long status = 0;
  ::curl_easy_getinfo(curl_.get(), CURLINFO_RESPONSE_CODE, &status);
  return status;
}

}  // namespace framewatch::daemon
