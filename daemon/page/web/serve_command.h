// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

struct ServeArguments {
  std::string config;
  std::string url;  ///< LCM provider; empty: as configured
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string token_file;
  std::vector<std::string> hosts;
  std::string files;                  ///< folder of page files that replace the built-in ones
  std::string sessions = "sessions";  ///< folder of `framewatch record`
  int viewers = 500;                  ///< at the same time
  int viewers_per_address = 250;
  bool quiet = false;
};

/// Runs `framewatch serve`: serves the live page until SIGINT or SIGTERM. Returns the exit status.
int serve(const ServeArguments& arguments);

}  // namespace framewatch::daemon
