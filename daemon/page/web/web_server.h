// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/page/web/web_admission.h"

namespace framewatch::daemon {

class LiveView;

/// Serves the page, the building and the event stream (docs/dashboard.md) in a separate thread,
/// within WebSettings::connections. A viewer that does not read costs one socket and the memory of
/// one event.
class WebServer {
 public:
  /// `view` must outlive this.
  WebServer(const WebSettings& settings, LiveView& view);
  ~WebServer();

  /// Serves on `socket` (from listen_on()) and takes ownership of it. Returns false and sets
  /// `error` on failure.
  [[nodiscard]] bool start(int socket, std::string& error);
  int port() const;
  int viewers() const;
  /// Wakes waiting viewers for new events and ends overdue connections. Call it at least once a
  /// second.
  void wake();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace framewatch::daemon
