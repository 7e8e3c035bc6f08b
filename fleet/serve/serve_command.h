#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

struct FleetServeArguments {
  std::string database;           ///< connection string or URI of libpq
  std::vector<std::string> hubs;  ///< tls://HOST:PORT; none: no commands
  std::string directory = ".";    ///< with page.pem, page.key and ca.pem
  std::string people;             ///< file; empty: this machine alone may look
  std::string address = "127.0.0.1";
  int port = 8090;
  std::vector<std::string> hosts;
  std::string files;  ///< folder with the page, for work on it
  bool quiet = false;
};

/// framewatch fleet serve: the page of many buildings, until SIGINT or SIGTERM. Exit code.
int fleet_serve_command(const FleetServeArguments& arguments);

}  // namespace framewatch::fleet
