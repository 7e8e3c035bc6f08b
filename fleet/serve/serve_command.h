// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

struct FleetServeArguments {
  std::string database;           ///< connection string or URI of libpq
  std::vector<std::string> hubs;  ///< tls://HOST:PORT; empty: the page gives no commands
  std::string directory = ".";    ///< with page.pem, page.key and ca.pem
  std::string people;             ///< file of People; empty: only this machine may view
  std::string address = "127.0.0.1";
  int port = 8090;
  std::vector<std::string> hosts;
  std::string files;  ///< folder of page files that replace the built-in ones
  bool quiet = false;
};

/// Runs `framewatch fleet serve`: serves the page of many buildings until SIGINT or SIGTERM.
/// Returns the exit status.
int fleet_serve_command(const FleetServeArguments& arguments);

}  // namespace framewatch::fleet
