#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

struct ServeArguments {
  std::string config;
  std::string url;  ///< LCM; empty: the configuration's
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string token_file;
  std::vector<std::string> hosts;
  std::string files;                  ///< folder with the page, for work on it
  std::string sessions = "sessions";  ///< folder of `framewatch record`
  int viewers = 500;                  ///< at once
  int viewers_per_address = 250;
  bool quiet = false;
};

/// framewatch serve: the live page, until SIGINT or SIGTERM. Exit code.
int serve(const ServeArguments& arguments);

}  // namespace framewatch::daemon
