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
  int port = 8080;  ///< 0: a free one
  /// Required for every request on an address that other machines reach, and for every POST.
  std::string token;
  std::vector<std::string> hosts;  ///< further names that requests may come under
  std::string files;               ///< folder to read the page from instead of the built-in one
  std::string sessions;            ///< folder of `framewatch record`; empty: none is shown
  std::string event_reports;       ///< folder of [event_report]; empty: none is shown
  /// Text of /metrics; empty: /metrics does not exist.
  std::function<std::string(const PageUse&)> metrics;
  ConnectionLimits connections;

  bool local() const { return address == "127.0.0.1" || address == "::1"; }
};

/// Every reason why a page must not be served with these settings; empty: none.
std::vector<std::string> problems(const WebSettings& settings);

/// The parts of a request that decide on its admission.
struct WebRequest {
  std::string method, path;
  std::string host, origin, cookie, authorization, token;  ///< token: of the query
  std::string content_length = {}, transfer_encoding = {};
  int hosts = 1;  ///< Host headers
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
/// By everything but the token. `verbs`: paths that may be posted to.
Admission admit_form(const WebSettings& settings, const WebRequest& request,
                     std::span<const std::string_view> verbs);
/// To this program's own page, with its token.
Admission admit(const WebSettings& settings, const WebRequest& request);

/// Compares in constant time, so that the time tells nothing about the token.
bool same_token(const std::string& a, const std::string& b);

/// What a request that is not served is told; `served`: 200 and nothing.
struct Refusal {
  unsigned code;
  const char* text;
};
Refusal refusal_of(Admission admission);

}  // namespace framewatch::daemon
