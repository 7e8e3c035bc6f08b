#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

/// Who talks to a hub, and where it is.
struct HubAccess {
  std::vector<std::string> hubs;  ///< tls://HOST:PORT
  std::string directory = ".";    ///< with ca.pem, and NAME.pem and NAME.key of who asks
};

struct SetupArguments {
  HubAccess hub;
  int replicas = 3, buildings = 1000;
  bool only_look = false;
};

/// `framewatch fleet setup`: streams and consumers of the hub as they should be. Returns the exit
/// status, here and below: 0 when they are, 1 when with only_look they are not, 2 for a failure.
int setup_command(const SetupArguments& arguments);

struct AuthorityArguments {
  std::string directory = ".";
  std::vector<std::string> servers;  ///< NAME=HOST,HOST,... or NAME: which is its host too
};

/// `framewatch fleet authority`: the authority, certificates of servers and of the hub's own
/// programs, and a users.conf that lets no building in. What is there already stays.
int authority_command(const AuthorityArguments& arguments);

struct RequestArguments {
  std::string building, key = "fleet.key", request = "fleet.csr";
};

/// `framewatch fleet request`, in the building: a private key and the request for a certificate.
int request_command(const RequestArguments& arguments);

struct EnrollArguments {
  std::string building, request, certificate, directory = ".";
  std::vector<std::string> reload;  ///< files with process ids of servers to tell (SIGHUP)
};

/// `framewatch fleet enroll` and `revoke`, at the hub: signs the request and lets the building in;
/// no longer lets it in.
int enroll_command(const EnrollArguments& arguments);
int revoke_command(const EnrollArguments& arguments);

}  // namespace framewatch::fleet
