// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_admission.h"

#include <algorithm>
#include <cctype>

namespace framewatch::daemon {
namespace {

constexpr std::size_t kShortestToken = 16;
constexpr std::string_view kVerbs[] = {"/acknowledge", "/baseline", "/session", "/weather"};

/// Removes the port and brackets: "[::1]:8080" becomes "::1".
std::string host_name(const std::string& host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string::npos ? "" : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

bool has_token(const WebSettings& s, const WebRequest& r) {
  if (s.token.empty()) return false;
  return same_token(r.cookie, s.token) || same_token(r.token, s.token) ||
         same_token(r.authorization, "Bearer " + s.token);
}

}  // namespace

std::vector<std::string> problems(const WebSettings& s) {
  std::vector<std::string> out;
  if (!s.local() && s.token.empty())
    out.push_back(s.address +
                  ": other machines can reach this address: set a token with --token-file");
  if (!s.token.empty() && s.token.size() < kShortestToken)
    out.push_back("the token must have at least 16 characters");
  if (std::any_of(s.token.begin(), s.token.end(),
                  [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_'; }))
    out.push_back("the token may contain only letters, digits, - and _");
  return out;
}

bool same_token(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= a[i] == b[i] ? 0u : 1u;
  return difference == 0;
}

Admission admit_form(const WebSettings& s, const WebRequest& r,
                     std::span<const std::string_view> verbs) {
  if (!r.path.starts_with('/') || r.hosts > 1) return Admission::malformed;
  const std::string host = host_name(r.host);
  const bool own = host == "127.0.0.1" || host == "localhost" || host == "::1";
  const bool named =
      host == s.address || std::find(s.hosts.begin(), s.hosts.end(), host) != s.hosts.end();
  if (host.empty() || !(own || named)) return Admission::wrong_host;
  const bool reads = r.method == "GET" || r.method == "HEAD";
  const bool verb =
      r.method == "POST" && std::find(verbs.begin(), verbs.end(), r.path) != verbs.end();
  if (!reads && !verb) return Admission::wrong_method;
  const bool empty = r.content_length.empty() || r.content_length == "0";
  if (!empty || !r.transfer_encoding.empty()) return Admission::has_body;
  if (verb && !r.origin.empty() && r.origin != "http://" + r.host &&
      r.origin != "https://" + r.host)
    return Admission::wrong_origin;
  return Admission::served;
}

Admission admit(const WebSettings& s, const WebRequest& r) {
  const Admission form = admit_form(s, r, kVerbs);
  if (form != Admission::served) return form;
  return (r.method == "POST" || !s.local()) && !has_token(s, r) ? Admission::no_token
                                                                : Admission::served;
}

Refusal refusal_of(Admission admission) {
  constexpr Refusal kRefusals[] = {{200, ""},
                                   {421, "this host name is not served: add it with --host"},
                                   {403, "open the address with its token: /?token=..."},
                                   {405, "only GET"},
                                   {403, "refused: the request comes from another page"},
                                   {400, "malformed request: no path, or several Host headers"},
                                   {413, "a request must not have a body"}};
  return kRefusals[static_cast<std::size_t>(admission)];
}

}  // namespace framewatch::daemon
