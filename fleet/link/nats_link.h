// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fleet/link/link.h"

namespace framewatch::fleet {

struct NatsSettings {
  std::vector<std::string> hubs;     ///< tls://HOST:PORT
  std::string name;                  ///< name of the connection at the server and in inbox()
  std::string certificate, key, ca;  ///< files (PEM)
};

/// A link to NATS servers over TLS. Reconnects after a random 0.25 to 5 s.
class NatsLink : public Link {
 public:
  static constexpr std::size_t kMaxWaiting = 8192;  ///< messages waiting for take()

  /// Opens a link. Returns nullptr and sets `error` if the certificate, key or authority is
  /// unusable. Does not need a reachable hub.
  static std::unique_ptr<NatsLink> open(const NatsSettings& settings, std::string& error);
  ~NatsLink() override;
  NatsLink(const NatsLink&) = delete;
  NatsLink& operator=(const NatsLink&) = delete;

  [[nodiscard]] bool publish(const Message& message) override;
  void listen(const std::string& subject) override;
  std::vector<Message> take() override;
  std::int64_t connections() const override;
  bool is_connected() const override;
  std::string trouble() const override;
  std::string inbox() const override;

  /// Returns a descriptor for poll(), readable while messages wait or after the connection changed.
  int descriptor() const;
  /// Returns the number of messages dropped because take() was not called.
  std::int64_t dropped() const;
  /// Sends all messages that were handed over. Returns false if that takes longer than timeout_ms.
  [[nodiscard]] bool flush(int timeout_ms);
  /// Sends a request and waits for the first answer; for commands, not for loops. Returns nullopt
  /// and sets `error` on failure.
  std::optional<Message> request(const std::string& subject, const Bytes& bytes, int timeout_ms,
                                 std::string& error);

 private:
  struct State;
  explicit NatsLink(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace framewatch::fleet
