#pragma once

#include <string>
#include <vector>

#include "daemon/web/web_settings.h"

namespace framewatch::daemon {

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
Admission admit(const WebSettings& settings, const WebRequest& request);

}  // namespace framewatch::daemon
