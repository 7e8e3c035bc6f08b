#pragma once

#include <string>
#include <utility>
#include <vector>

namespace framewatch::fleet {

/// The authority that a hub and its buildings know each other by, with openssl(1): `ca.pem` and
/// `ca.key` of a directory. Every call returns an empty text, or why it failed; then nothing has
/// its final name.
class Authority {
 public:
  static constexpr int kDays = 825, kAuthorityDays = 3650;

  explicit Authority(std::string directory) : directory_(std::move(directory)) {}

  /// Makes ca.pem and ca.key; refuses where there are any.
  std::string make() const;
  /// NAME.pem and NAME.key: of a server of the hub, or of one of its own programs. hosts: names and
  /// addresses of a server; empty: it is none.
  std::string issue(const std::string& name, const std::vector<std::string>& hosts) const;
  /// Signs a building's request into `certificate`. The request must name the building, and nothing
  /// else: CN=`building`.
  std::string sign(const std::string& building, const std::string& request,
                   const std::string& certificate) const;

 private:
  std::string path(const std::string& name) const;
  std::string directory_;
};

/// In the building: a private key, for its owner alone, and a request that names the building.
std::string make_request(const std::string& building, const std::string& key,
                         const std::string& request);

/// Whether it may be the name of a server in a certificate: letters, digits, `.`, `-`, `:`.
bool is_host(const std::string& name);

}  // namespace framewatch::fleet
