#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/page/web/web_settings.h"

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
