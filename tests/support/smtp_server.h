// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/support/child.h"
#include "tests/support/temporary.h"

namespace framewatch::test {

/// A mail server on 127.0.0.1 with faults on demand: runs tests/support/smtp-server, which explains
/// the options.
class SmtpServer {
 public:
  explicit SmtpServer(const std::vector<std::string>& options = {});

  int port() const { return port_; }
  /// Returns a message that came, with its envelope in the first line; empty: it has not come.
  /// Messages count from 1.
  std::string message(int number) const {
    return read_file(folder_.path(std::to_string(number) + ".eml"));
  }
  /// Returns the commands that it got, one a line.
  std::string commands() const { return read_file(folder_.path("commands")); }

 private:
  TemporaryDirectory folder_;
  std::optional<Child> process_;
  int port_ = 0;
};

/// A certificate for 127.0.0.1 that no system trusts.
struct TestCertificate {
  /// Makes the files `certificate` and `key` in a folder. Throws if openssl fails.
  explicit TestCertificate(const TemporaryDirectory& folder);
  std::string certificate, key;  ///< paths
};

}  // namespace framewatch::test
