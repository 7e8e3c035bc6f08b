// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "drivers/files/descriptor.h"

namespace framewatch::test {

/// An MQTT 3.1.1 broker on 127.0.0.1 for one client, with faults on demand.
class MqttBroker {
 public:
  struct Faults {
    int answer = 0;                 ///< to CONNECT: 0 accepts, 5 refuses the login
    bool silent = false;            ///< never answers
    std::set<std::string> refused;  ///< topics that may not be subscribed
  };
  /// `port` 0: any free one.
  explicit MqttBroker(int port = 0);
  MqttBroker(int port, Faults faults);
  ~MqttBroker();
  MqttBroker(const MqttBroker&) = delete;
  MqttBroker& operator=(const MqttBroker&) = delete;

  int port() const { return port_; }
  std::string url() const { return "mqtt://127.0.0.1:" + std::to_string(port_); }
  /// Returns the topics that the client has subscribed in its present connection.
  std::vector<std::string> topics() const;
  std::string user() const;
  std::string password() const;
  int connections() const { return connections_; }
  /// Sends a message to the client.
  void publish(const std::string& topic, const std::string& payload, bool retained = false);
  /// Ends the connection of the client.
  void hang_up();

 private:
  void work();
  bool read_packet();
  void answer(std::uint8_t kind, const std::string& body);
  void send(const std::string& bytes);

  const Faults faults_;
  drivers::Descriptor listening_;
  int port_ = 0;
  std::atomic<bool> stop_{false};
  std::atomic<int> connections_{0};
  mutable std::mutex mutex_;  ///< guards the members below
  drivers::Descriptor client_;
  std::vector<std::string> topics_;
  std::string user_, password_;
  std::thread thread_;  ///< last, because it uses the members above
};

}  // namespace framewatch::test
