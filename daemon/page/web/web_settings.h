#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/page/metrics/page_use.h"
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

}  // namespace framewatch::daemon
