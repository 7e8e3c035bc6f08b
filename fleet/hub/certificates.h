// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace framewatch::fleet {

/// The certificate authority of a hub: `ca.pem` and `ca.key` in a directory, used with openssl(1).
/// Every call returns an empty text, or the problem; then no file has its final name.
class Authority {
 public:
  static constexpr int kDays = 825, kAuthorityDays = 3650;

  explicit Authority(std::string directory) : directory_(std::move(directory)) {}

  /// Creates ca.pem and ca.key. Fails if either exists.
  std::string make() const;
  /// Creates NAME.pem and NAME.key for a server or a program of the hub. hosts: names and addresses
  /// of a server; empty for a program.
  std::string issue(const std::string& name, const std::vector<std::string>& hosts) const;
  /// Signs a building's request into `certificate`. The subject of the request must be exactly
  /// CN=`building`.
  std::string sign(const std::string& building, const std::string& request,
                   const std::string& certificate) const;

 private:
  std::string path(const std::string& name) const;
  std::string directory_;
};

/// Creates a private key that only its owner can read, and a certificate request for the building.
std::string make_request(const std::string& building, const std::string& key,
                         const std::string& request);

/// Returns true for letters, digits, `.`, `-` and `:`, as server names in certificates have.
bool is_host(const std::string& name);

}  // namespace framewatch::fleet
