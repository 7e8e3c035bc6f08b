// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "drivers/mqtt/mqtt_settings.h"

struct mosquitto;
struct mosquitto_message;

namespace framewatch::drivers {

/// A message of a subscribed topic.
struct MqttMessage {
  std::string topic;
  std::string payload;    ///< any bytes
  bool retained = false;  ///< the broker had kept it, so its age is unknown
};

/// The connection to the broker, and what came over it since the start.
struct MqttState {
  bool connected = false;
  std::string trouble;           ///< why it is not connected, or lacks a topic; empty: none so far
  std::int64_t connections = 0;  ///< that the broker accepted
  std::int64_t messages = 0;     ///< received
  std::int64_t dropped = 0;      ///< because MqttSettings::queue_capacity waited
  std::int64_t too_long = 0;     ///< beyond kMostPayload_bytes, ignored
};

/// Receives the messages of a few topics from an MQTT 3.1.1 broker (libmosquitto). A thread
/// connects, receives, and connects again after a failure, with pauses of 1, 2, 4 .. 60 s, for as
/// long as this object lives. The caller never waits, except in the destructor: up to 0.3 s, or as
/// long as the system looks for the broker's name.
class MqttSource {
 public:
  static constexpr std::size_t kMostPayload_bytes = 65536;
  static constexpr int kLongestPause_s = 60;

  /// Returns the password, or nullopt with `trouble`. It is called for each connection, in the
  /// thread of this object.
  using Secret = std::function<std::optional<std::string>(std::string& trouble)>;

  /// `settings` has a valid url. `password` is asked only if there is a password_file.
  MqttSource(MqttSettings settings, std::vector<std::string> topics, Secret password);
  ~MqttSource();
  MqttSource(const MqttSource&) = delete;
  MqttSource& operator=(const MqttSource&) = delete;

  /// Returns the messages that came since the last call, oldest first.
  std::vector<MqttMessage> take();
  MqttState state() const;
  const MqttSettings& settings() const { return settings_; }

 private:
  void work();
  std::string stay_connected();
  std::string prepare(mosquitto* client);
  std::string why_ended(int code) const;
  bool stopped() const;
  static MqttSource& of(void* self) { return *static_cast<MqttSource*>(self); }
  void answered(mosquitto* client, int code);
  void subscribed(int request, int granted);
  void begin();
  void received(const mosquitto_message& message);

  const MqttSettings settings_;
  const MqttAddress address_;
  const std::vector<std::string> topics_;
  const Secret password_;
  std::map<int, std::string> requests_;  ///< topics by the number of their SUBSCRIBE; of the thread
  std::set<std::string> refused_;        ///< topics; of the thread
  std::string complaint_;     ///< newest error of the library in this connection; of the thread
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable wake_;
  bool stop_ = false;
  MqttState state_;
  std::deque<MqttMessage> waiting_;
  std::thread thread_;  ///< last, because it uses the members above
};

}  // namespace framewatch::drivers
