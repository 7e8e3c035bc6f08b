#include "daemon/web/web_admission.h"

#include <algorithm>
#include <cctype>

namespace framewatch::daemon {
namespace {

constexpr std::size_t kShortestToken = 16;

/// Without its port: "[::1]:8080" is "::1".
std::string host_name(const std::string& host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string::npos ? "" : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

/// Compares in constant time, so that the time tells nothing about the token.
bool equal(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= a[i] == b[i] ? 0u : 1u;
  return difference == 0;
}

bool has_token(const WebSettings& s, const WebRequest& r) {
  if (s.token.empty()) return false;
  return equal(r.cookie, s.token) || equal(r.token, s.token) ||
         equal(r.authorization, "Bearer " + s.token);
}

}  // namespace

std::vector<std::string> problems(const WebSettings& s) {
  std::vector<std::string> out;
  if (!s.local() && s.token.empty())
    out.push_back(s.address +
                  ": others can reach this address, so a token is needed (--token-file)");
  if (!s.token.empty() && s.token.size() < kShortestToken)
    out.push_back("the token has fewer than 16 characters");
  if (std::any_of(s.token.begin(), s.token.end(),
                  [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_'; }))
    out.push_back("the token has other characters than letters, digits, - and _");
  return out;
}

Admission admit(const WebSettings& s, const WebRequest& r) {
  if (!r.path.starts_with('/') || r.hosts > 1) return Admission::malformed;
  const std::string host = host_name(r.host);
  const bool own = host == "127.0.0.1" || host == "localhost" || host == "::1";
  const bool named =
      host == s.address || std::find(s.hosts.begin(), s.hosts.end(), host) != s.hosts.end();
  if (host.empty() || !(own || named)) return Admission::wrong_host;
  const bool reads = r.method == "GET" || r.method == "HEAD";
  const bool verb = r.method == "POST" &&
                    (r.path == "/acknowledge" || r.path == "/baseline" || r.path == "/session");
  if (!reads && !verb) return Admission::wrong_method;
  const bool empty = r.content_length.empty() || r.content_length == "0";
  if (!empty || !r.transfer_encoding.empty()) return Admission::has_body;
  if (verb && !r.origin.empty() && r.origin != "http://" + r.host &&
      r.origin != "https://" + r.host)
    return Admission::wrong_origin;
  if ((verb || !s.local()) && !has_token(s, r)) return Admission::no_token;
  return Admission::served;
}

}  // namespace framewatch::daemon
