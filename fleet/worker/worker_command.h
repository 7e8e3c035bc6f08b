#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

struct WorkerArguments {
  std::vector<std::string> hubs;  ///< tls://HOST:PORT
  std::string directory = ".";    ///< with worker.pem, worker.key and ca.pem
  std::string database;           ///< connection string or URI of libpq
  bool quiet = false;
};

/// framewatch fleet worker: runs until SIGINT or SIGTERM.
int worker_command(const WorkerArguments& arguments);

}  // namespace framewatch::fleet
