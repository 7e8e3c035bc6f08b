// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include <curl/curl.h>

#include "daemon/monitor/actions/notifier.h"

namespace framewatch::daemon {

struct CurlFree {
  void operator()(CURL* curl) const { ::curl_easy_cleanup(curl); }
  void operator()(curl_slist* list) const { ::curl_slist_free_all(list); }
  void operator()(curl_mime* mime) const { ::curl_mime_free(mime); }
};
using CurlLines = std::unique_ptr<curl_slist, CurlFree>;

/// Appends a line to a list of libcurl.
void add_line(CurlLines& lines, const std::string& line);

/// One transfer of libcurl after the other, each with a verified certificate and a time limit.
class CurlSession {
 public:
  /// `ca_file`: trusted certificates, empty for the system's. The transfers end when `abandoned`,
  /// which must outlive this, returns true.
  CurlSession(const std::string& ca_file, double timeout_s, const Abandoned& abandoned);

  /// Returns false if libcurl cannot start.
  bool good() const { return curl_ != nullptr; }
  CURL* get() { return curl_.get(); }
  template <typename Value>
  void set(CURLoption option, Value value) {
    ::curl_easy_setopt(curl_.get(), option, value);
  }
  /// Transfers. Returns an empty text, or the reason of a failure, equal for equal failures. Sets
  /// `code` to libcurl's result.
  std::string perform(CURLcode& code);
  /// Returns the status of the last transfer's answer: of HTTP or SMTP; 0 without an answer.
  long status();

 private:
  std::unique_ptr<CURL, CurlFree> curl_;
  std::array<char, CURL_ERROR_SIZE> error_{};
};

}  // namespace framewatch::daemon
