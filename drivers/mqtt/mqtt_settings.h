// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace framewatch::drivers {

/// [mqtt]: the broker that sends readings of weather.
struct MqttSettings {
  std::string url;               ///< see mqtt_address()
  std::string ca_file;           ///< trusted certificates (PEM); empty for the system's
  std::string certificate_file;  ///< the client's certificate (PEM); empty: none
  std::string key_file;          ///< its key
  std::string user;              ///< empty: no login
  std::string password_file;     ///< file with the password in its first line; empty: none
  std::string client_id;         ///< empty: a random one for each connection
  int keepalive_s = 60;          ///< the broker is asked for a sign of life after this silence
  int queue_capacity = 1000;     ///< messages that may wait
};

/// Address at which a broker listens.
struct MqttAddress {
  std::string host;  ///< name or address, an IPv6 address without brackets
  int port = 0;
  bool tls = false;
};

/// Parses mqtt://HOST[:PORT] or mqtts://HOST[:PORT]; the ports are 1883 and 8883 by default.
/// Returns nullopt for other texts, also for those with a user, a password or a path.
std::optional<MqttAddress> mqtt_address(const std::string& url);

/// Returns true if the host is this machine: then messages do not cross a network.
bool is_this_machine(const MqttAddress& address);

}  // namespace framewatch::drivers
