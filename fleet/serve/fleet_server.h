#pragma once

#include <memory>
#include <string>

#include "daemon/page/web/web_admission.h"
#include "fleet/serve/fleet_pages.h"
#include "fleet/serve/people.h"

namespace framewatch::fleet {

struct FleetServerSettings {
  daemon::WebSettings web;  ///< address, port, hosts, files and limits; the rest is not used
  People people;            ///< nobody: who reaches the address, this machine alone, may look
};

/// Serves the page of many buildings on threads of its own. Admission is that of the page of one
/// building (daemon/page/web/web_admission.h), with a token for each person.
class FleetServer {
 public:
  static constexpr unsigned kThreads = 4;

  /// `pages` must outlive this.
  FleetServer(FleetServerSettings settings, FleetPages& pages);
  ~FleetServer();
  FleetServer(const FleetServer&) = delete;
  FleetServer& operator=(const FleetServer&) = delete;

  /// Serves on `socket` (of listen_on()) and takes it over. False, with the reason, on failure.
  [[nodiscard]] bool start(int socket, std::string& error);
  int port() const;
  /// Ends connections that are overdue. To be called at least once a second.
  void sweep();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace framewatch::fleet
