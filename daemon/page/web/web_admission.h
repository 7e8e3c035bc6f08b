// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/page/metrics/metrics.h"
#include "daemon/page/web/web_connections.h"

namespace framewatch::daemon {

/// Address, access and contents of the page.
struct WebSettings {
  std::string address = "127.0.0.1";
  int port = 8080;  ///< 0: any free port
  /// Required for every POST, and for every request unless local().
  std::string token;
  std::vector<std::string> hosts;  ///< further host names that requests may use
  std::string files;               ///< folder of page files that replace the built-in ones
  std::string sessions;            ///< folder of `framewatch record`; empty: not shown
  std::string event_reports;       ///< folder of [event_report]; empty: not shown
  /// Returns the text of /metrics; empty: /metrics does not exist.
  std::function<std::string(const PageUse&)> metrics;
  ConnectionLimits connections;

  bool local() const { return address == "127.0.0.1" || address == "::1"; }
};

/// Returns every reason why a page must not be served with these settings.
std::vector<std::string> problems(const WebSettings& settings);

/// The parts of a request that decide whether it is served.
struct WebRequest {
  std::string method, path;
  std::string host, origin, cookie, authorization, token;  ///< token: in the query
  std::string content_length = {}, transfer_encoding = {};
  int hosts = 1;  ///< number of Host headers
};

enum class Admission {
  served,
  wrong_host,
  no_token,
  wrong_method,
  wrong_origin,
  malformed,
  has_body
};
/// Checks everything except the token. verbs: paths that accept POST.
Admission admit_form(const WebSettings& settings, const WebRequest& request,
                     std::span<const std::string_view> verbs);
/// Checks a request to the page of `framewatch serve`, with its token.
Admission admit(const WebSettings& settings, const WebRequest& request);

/// Compares in constant time, so that the duration reveals nothing about the token.
bool same_token(const std::string& a, const std::string& b);

/// Status and text that answer a request; for `served` 200 and an empty text.
struct Refusal {
  unsigned code;
  const char* text;
};
Refusal refusal_of(Admission admission);

}  // namespace framewatch::daemon
