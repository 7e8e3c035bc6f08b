// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

/// The hub servers and the certificates to use with them.
struct HubAccess {
  std::vector<std::string> hubs;  ///< tls://HOST:PORT
  std::string directory = ".";    ///< with ca.pem, and NAME.pem and NAME.key of this program
};

struct SetupArguments {
  HubAccess hub;
  int replicas = 3, buildings = 1000;
  bool only_look = false;
};

/// Runs `framewatch fleet setup`: creates and updates the streams and consumers of the hub. Returns
/// the exit status: 0 if they are correct now, 1 if only_look found differences, 2 on failure.
int setup_command(const SetupArguments& arguments);

struct AuthorityArguments {
  std::string directory = ".";
  std::vector<std::string> servers;  ///< NAME=HOST,HOST,... or NAME, if the host has that name
};

/// Runs `framewatch fleet authority`: creates the authority, the certificates of the servers and of
/// the hub's programs, and a users.conf without buildings. Keeps existing files. Returns the exit
/// status.
int authority_command(const AuthorityArguments& arguments);

struct RequestArguments {
  std::string building, key = "fleet.key", request = "fleet.csr";
};

/// Runs `framewatch fleet request` in a building: creates a private key and a certificate request.
/// Returns the exit status.
int request_command(const RequestArguments& arguments);

struct EnrollArguments {
  std::string building, request, certificate, directory = ".";
  std::vector<std::string> reload;  ///< files with the process ids of servers to send SIGHUP to
};

/// Run `framewatch fleet enroll` (signs the request and admits the building) and `revoke` (no
/// longer admits it) at the hub. Return the exit status.
int enroll_command(const EnrollArguments& arguments);
int revoke_command(const EnrollArguments& arguments);

}  // namespace framewatch::fleet
