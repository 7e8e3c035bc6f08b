#pragma once

#include <string>

#include "daemon/page/web/web_connections.h"
#include "daemon/page/web/web_settings.h"

namespace framewatch::daemon {

/// A socket that listens on the address; -1, with the reason, when that fails. The kernel holds at
/// most 256 KiB to be sent and 64 KiB received of a connection.
int listen_on(const std::string& address, int port, std::string& error);

/// Where a connected socket leads.
PeerAddress peer_of(int socket);

/// Lets the process have so many files open. False, with the reason, when the machine forbids it.
[[nodiscard]] bool allow_descriptors(int count, std::string& error);

/// "http://127.0.0.1:8080/", with ?token= unless `token` is empty.
std::string page_address(const WebSettings& settings, int port, const std::string& token);

/// 32 hexadecimal digits from the operating system's random numbers.
std::string random_token();

}  // namespace framewatch::daemon
