#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fleet/link/link.h"

namespace framewatch::fleet {

struct NatsSettings {
  std::vector<std::string> hubs;  ///< tls://HOST:PORT
  std::string name;               ///< what the server calls this connection, and whose inbox it is
  std::string certificate, key, ca;  ///< files (PEM)
};

/// A line to NATS servers over TLS. Connections come back after 0.25 to 5 s at random.
class NatsLink : public Link {
 public:
  static constexpr std::size_t kMaxWaiting = 8192;  ///< messages that take() has not fetched

  /// Null, with the reason, when certificate, key or authority cannot be used. No hub need be
  /// there.
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

  /// Readable while messages wait or the connection has changed: for poll().
  int descriptor() const;
  /// Messages that were lost because take() was not called for long.
  std::int64_t dropped() const;
  /// Gives what was handed over to the network; waits at most so long. False: it was not taken.
  [[nodiscard]] bool flush(int timeout_ms);
  /// Asks and waits for the first answer; for commands, not for loops. Empty, with the reason.
  std::optional<Message> request(const std::string& subject, const Bytes& bytes, int timeout_ms,
                                 std::string& error);

 private:
  struct State;
  explicit NatsLink(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace framewatch::fleet
