#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/live_view.h"

namespace framewatch::daemon {

/// Where a page is served and to whom.
struct WebSettings {
  std::string address = "127.0.0.1";
  int port = 8080;  ///< 0: a free one
  /// Needed for any address that is not this machine's own, and for what changes anything.
  std::string token;
  std::vector<std::string> hosts;  ///< further names that requests may come under
  std::string files;               ///< folder to read the page from instead of the built-in one
  std::string sessions;            ///< folder of `framewatch record`; empty: none is shown
  /// Text of /metrics, given the number of viewers; none: there is none.
  std::function<std::string(int viewers)> metrics;

  bool local() const { return address == "127.0.0.1" || address == "::1"; }
};

/// Every reason why a page must not be served like this.
std::vector<std::string> problems(const WebSettings& settings);

/// A socket that listens there; -1 with the reason.
int listen_on(const std::string& address, int port, std::string& error);

/// "http://127.0.0.1:8080/", with ?token= unless `token` is empty.
std::string page_address(const WebSettings& settings, int port, const std::string& token);

/// 32 hexadecimal digits from the operating system's random numbers.
std::string random_token();

/// One request, as far as it decides anything.
struct WebRequest {
  std::string method, path;
  std::string host, origin, cookie, authorization, token;  ///< token: of the query
};

enum class Admission { served, wrong_host, no_token, wrong_method, wrong_origin };
Admission admit(const WebSettings& settings, const WebRequest& request);

struct WebFile {
  std::string type;
  std::string content;
};
/// The built-in page, by path.
const std::map<std::string, WebFile>& page_files();

/// The page, the building and the stream of events (docs/dashboard.md), on a thread of its own. A
/// viewer that does not read costs one socket and one event of memory.
class WebServer {
 public:
  static constexpr unsigned kMostConnections = 1000;

  /// `view` must outlive this.
  WebServer(const WebSettings& settings, LiveView& view);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Serves on `socket` (listen_on()), which it owns from now on. False with the reason.
  [[nodiscard]] bool start(int socket, std::string& error);
  int port() const;
  int viewers() const;
  /// New events are there: viewers that wait go on.
  void wake();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace framewatch::daemon
