#pragma once

#include <memory>
#include <string>

#include "daemon/page/web/web_admission.h"

namespace framewatch::daemon {

class LiveView;

/// Serves the page, the building and the stream of events (docs/dashboard.md) on a thread of its
/// own, to as many at once as WebSettings::connections says. A viewer that does not read costs one
/// socket and one event of memory until it is ended.
class WebServer {
 public:
  /// `view` must outlive this.
  WebServer(const WebSettings& settings, LiveView& view);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Serves on `socket` (of listen_on()) and takes it over. False, with the reason, on failure.
  [[nodiscard]] bool start(int socket, std::string& error);
  int port() const;
  int viewers() const;
  /// New events have come: waiting viewers continue, and what is overdue is ended. To be called at
  /// least once a second.
  void wake();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace framewatch::daemon
