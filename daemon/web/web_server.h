#pragma once

#include <memory>
#include <string>

#include "daemon/web/web_settings.h"

namespace framewatch::daemon {

class LiveView;

/// Serves the page, the building and the stream of events (docs/dashboard.md) on a thread of its
/// own. A viewer that does not read costs one socket and one event of memory.
class WebServer {
 public:
  static constexpr unsigned kMostConnections = 1000;

  /// `view` must outlive this.
  WebServer(const WebSettings& settings, LiveView& view);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Serves on `socket` (of listen_on()) and takes it over. False, with the reason, on failure.
  [[nodiscard]] bool start(int socket, std::string& error);
  int port() const;
  int viewers() const;
  /// New events have come: waiting viewers continue.
  void wake();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace framewatch::daemon
