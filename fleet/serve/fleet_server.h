// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/page/web/web_admission.h"
#include "fleet/serve/fleet_pages.h"
#include "fleet/serve/people.h"

namespace framewatch::fleet {

struct FleetServerSettings {
  daemon::WebSettings web;  ///< uses address, port, hosts, files and limits only
  People people;            ///< empty: only this machine may view
};

/// Serves the page of many buildings in separate threads. Admits requests as the page of one
/// building does (daemon/page/web/web_admission.h), with a token for each person.
class FleetServer {
 public:
  static constexpr unsigned kThreads = 4;

  /// `pages` must outlive this.
  FleetServer(FleetServerSettings settings, FleetPages& pages);
  ~FleetServer();
  FleetServer(const FleetServer&) = delete;
  FleetServer& operator=(const FleetServer&) = delete;

  /// Serves on `socket` (from listen_on()) and takes ownership of it. Returns false and sets
  /// `error` on failure.
  [[nodiscard]] bool start(int socket, std::string& error);
  int port() const;
  /// Ends overdue connections. Call it at least once a second.
  void sweep();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace framewatch::fleet
