// SPDX-License-Identifier: MIT
#include "fleet/link/nats_link.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <nats/nats.h>

#include "daemon/base/clocks.h"
#include "daemon/base/process.h"
#include "drivers/files/descriptor.h"
#include "fleet/message/message.h"

namespace framewatch::fleet {

/// Destroys an object of the NATS library together with its owner.
template <class Type, void (*destroy)(Type*)>
struct NatsDestroyer {
  void operator()(Type* object) const { destroy(object); }
};
using NatsOptions = std::unique_ptr<natsOptions, NatsDestroyer<natsOptions, natsOptions_Destroy>>;
using NatsConnection =
    std::unique_ptr<natsConnection, NatsDestroyer<natsConnection, natsConnection_Destroy>>;
using NatsSubscription =
    std::unique_ptr<natsSubscription, NatsDestroyer<natsSubscription, natsSubscription_Destroy>>;
using NatsMessage = std::unique_ptr<natsMsg, NatsDestroyer<natsMsg, natsMsg_Destroy>>;

namespace {

/// Converts a message of the library.
Message message_of(natsMsg* from) {
  Message out;
  out.subject = natsMsg_GetSubject(from);
  if (const char* reply = natsMsg_GetReply(from)) out.reply = reply;
  if (const int size = natsMsg_GetDataLength(from); size > 0) {
    const char* data = natsMsg_GetData(from);
    out.bytes.assign(data, data + size);
  }
  const char** names = nullptr;
  int count = 0;
  if (natsMsgHeader_Keys(from, &names, &count) == NATS_OK) {
    for (int i = 0; i < count; ++i)
      if (const char* value = nullptr; natsMsgHeader_Get(from, names[i], &value) == NATS_OK)
        out.headers[names[i]] = value;
    std::free(names);  // NOLINT: the library's rule
  }
  return out;
}

NatsMessage nats_message(const Message& from) {
  natsMsg* made = nullptr;
  if (natsMsg_Create(&made, from.subject.c_str(), from.reply.empty() ? nullptr : from.reply.c_str(),
                     reinterpret_cast<const char*>(from.bytes.data()),
                     static_cast<int>(from.bytes.size())) != NATS_OK)
    return nullptr;
  NatsMessage out(made);
  for (const auto& [name, value] : from.headers)
    if (natsMsgHeader_Set(out.get(), name.c_str(), value.c_str()) != NATS_OK) return nullptr;
  return out;
}

/// Returns the text of `status` with the library's details on the last failure of this thread.
std::string last_error(natsStatus status) {
  const char* detail = nats_GetLastError(nullptr);
  const std::string text = natsStatus_GetText(status);
  return detail == nullptr || *detail == '\0' ? text : fmt::format("{}: {}", text, detail);
}

constexpr const char* kOpenssl = "/usr/bin/openssl";
constexpr std::chrono::milliseconds kPause{2};
constexpr int kMaxLooks = 1000;

/// Returns "FILE expired ..." when openssl(1) finds that the certificate (PEM) is over by the
/// host's clock; else empty, also if it cannot be read. A hub that refuses it does not tell the
/// client why.
std::string expired(const std::string& certificate) {
  std::string error;
  auto process = daemon::ChildProcess::start(
      {"x509", "-in", certificate, "-noout", "-out", "/dev/null", "-checkend", "0"}, error,
      kOpenssl, "/dev/null");
  for (int i = 0; process && i < kMaxLooks; ++i) {
    if (const std::optional<int> status = process->ended())
      return *status == 1 ? fmt::format("{} expired, or the host's clock is wrong", certificate)
                          : "";
    std::this_thread::sleep_for(kPause);
  }
  return {};
}

constexpr std::int64_t kMinWait_ms = 250, kMaxWait_ms = 5000;
// Finds a silently dead connection within 12 s. More pings would cost more than the messages.
constexpr std::int64_t kPing_ms = 6000, kConnect_ms = 2000, kWrite_ms = 2000;
constexpr int kPingsWithoutAnswer = 1;
constexpr std::int64_t kAnew_us = 60'000'000;  // without a connection
constexpr std::chrono::milliseconds kLook{2};
constexpr int kLooks = 1000;
constexpr int kHeldWhileAway_bytes = 64 * 1024;

std::string letters(std::size_t count) {
  static constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device chance;
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += kLetters[chance() % 36];
  return out;
}

}  // namespace

struct NatsLink::State {
  NatsSettings settings;
  std::string inbox;
  drivers::Descriptor wake{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  std::vector<std::string> subjects;
  std::atomic<std::int64_t> connections{0}, dropped{0};
  std::atomic<bool> closed{false};
  std::atomic<int> listening{0};  ///< subscriptions whose thread may still call back
  std::int64_t open_again_us = INT64_MIN, seen_us = INT64_MIN;  ///< steady clock

  mutable std::mutex mutex;  ///< guards the members below, also against the library's threads
  std::vector<Message> waiting;
  std::string trouble, certificate_trouble;

  NatsConnection connection;  ///< after the members above, which its threads use
  std::vector<NatsSubscription> subscriptions;

  void ring() {
    const std::uint64_t one = 1;
    (void)!::write(wake.get(), &one, sizeof one);
  }
  void say(std::string why) {
    const std::lock_guard<std::mutex> lock(mutex);
    trouble = std::move(why);
  }
  std::string connect();
  [[nodiscard]] bool close();
  void listen(const std::string& subject);

  static void on_message(natsConnection*, natsSubscription*, natsMsg* message, void* self) {
    const NatsMessage owner(message);
    auto& state = *static_cast<State*>(self);
    {
      const std::lock_guard<std::mutex> lock(state.mutex);
      if (state.waiting.size() >= kMaxWaiting) {
        ++state.dropped;
        return;
      }
      state.waiting.push_back(message_of(message));
    }
    state.ring();
  }
  static void on_unsubscribed(void* self) { --static_cast<State*>(self)->listening; }
  static void on_connected(natsConnection*, void* self) {
    auto& state = *static_cast<State*>(self);
    ++state.connections;
    state.say("");
    state.ring();
  }
  static void on_disconnected(natsConnection* connection, void* self) {
    auto& state = *static_cast<State*>(self);
    const char* why = nullptr;
    (void)natsConnection_GetLastError(connection, &why);
    state.say(why == nullptr || *why == '\0' ? "connection lost" : why);
    state.ring();
  }
  static void on_closed(natsConnection*, void* self) {
    auto& state = *static_cast<State*>(self);
    state.closed = true;
    state.ring();
  }
  static void on_error(natsConnection* connection, natsSubscription*, natsStatus status,
                       void* self) {
    const char* why = nullptr;
    (void)natsConnection_GetLastError(connection, &why);
    static_cast<State*>(self)->say(why == nullptr || *why == '\0' ? natsStatus_GetText(status)
                                                                  : why);
  }
  static std::int64_t wait_before(natsConnection*, int, void*) {
    static thread_local std::mt19937 chance{std::random_device{}()};
    return std::uniform_int_distribution<std::int64_t>(kMinWait_ms, kMaxWait_ms)(chance);
  }
};

/// Reads the files again, so that it uses a renewed certificate.
std::string NatsLink::State::connect() {
  natsOptions* made = nullptr;
  if (const natsStatus s = natsOptions_Create(&made); s != NATS_OK) return last_error(s);
  const NatsOptions options(made);
  std::vector<const char*> urls;
  for (const std::string& url : settings.hubs) urls.push_back(url.c_str());
  const auto set = [&](natsStatus status, const std::string& what) {
    return status == NATS_OK ? "" : fmt::format("{}: {}", what, last_error(status));
  };
  for (const std::string& problem :
       {set(natsOptions_SetServers(made, urls.data(), static_cast<int>(urls.size())), "hubs"),
        set(natsOptions_SetSecure(made, true), "TLS"),
        set(natsOptions_LoadCATrustedCertificates(made, settings.ca.c_str()), settings.ca),
        set(natsOptions_LoadCertificatesChain(made, settings.certificate.c_str(),
                                              settings.key.c_str()),
            settings.certificate + ", " + settings.key)})
    if (!problem.empty()) return problem;
  std::string over = expired(settings.certificate);
  {
    const std::lock_guard<std::mutex> lock(mutex);
    certificate_trouble = std::move(over);
  }
  natsOptions_SetName(made, settings.name.c_str());
  natsOptions_SetCustomInboxPrefix(made, fmt::format("_INBOX_{}", settings.name).c_str());
  natsOptions_SetAllowReconnect(made, true);
  natsOptions_SetMaxReconnect(made, -1);
  natsOptions_SetCustomReconnectDelay(made, &State::wait_before, this);
  natsOptions_SetRetryOnFailedConnect(made, true, &State::on_connected, this);
  natsOptions_SetReconnectedCB(made, &State::on_connected, this);
  natsOptions_SetDisconnectedCB(made, &State::on_disconnected, this);
  natsOptions_SetClosedCB(made, &State::on_closed, this);
  natsOptions_SetErrorHandler(made, &State::on_error, this);
  natsOptions_SetPingInterval(made, kPing_ms);
  natsOptions_SetMaxPingsOut(made, kPingsWithoutAnswer);
  natsOptions_SetTimeout(made, kConnect_ms);
  natsOptions_SetWriteDeadline(made, kWrite_ms);
  natsOptions_SetReconnectBufSize(made, kHeldWhileAway_bytes);
  natsConnection* opened = nullptr;
  const natsStatus status = natsConnection_Connect(&opened, made);
  connection.reset(opened);
  if (status == NATS_OK) on_connected(opened, this);
  // A client that is refused now may be admitted later.
  if (status != NATS_OK && status != NATS_NOT_YET_CONNECTED) closed = true;
  if (status == NATS_NOT_YET_CONNECTED)
    say("no hub server answers, or the hub does not admit this certificate");
  else if (status != NATS_OK)
    say(last_error(status));
  for (const std::string& subject : subjects) listen(subject);
  return "";
}

/// Returns false when the library may still call back; then this object must not be destroyed.
bool NatsLink::State::close() {
  if (connection) {
    natsConnection_Close(connection.get());
    for (int i = 0; i < kLooks && !(closed && listening == 0); ++i)
      std::this_thread::sleep_for(kLook);
  }
  const bool quiet = !connection || (closed && listening == 0);
  subscriptions.clear();
  connection.reset();
  closed = false;
  return quiet;
}

void NatsLink::State::listen(const std::string& subject) {
  natsSubscription* made = nullptr;
  if (!connection || natsConnection_Subscribe(&made, connection.get(), subject.c_str(),
                                              &State::on_message, this) != NATS_OK)
    return;
  subscriptions.emplace_back(made);
  ++listening;
  if (natsSubscription_SetOnCompleteCB(made, &State::on_unsubscribed, this) != NATS_OK) --listening;
}

NatsLink::NatsLink(std::unique_ptr<State> state) : state_(std::move(state)) {}

NatsLink::~NatsLink() {
  if (!state_->close()) (void)state_.release();
}

std::unique_ptr<NatsLink> NatsLink::open(const NatsSettings& settings, std::string& error) {
  auto state = std::make_unique<State>();
  state->settings = settings;
  state->inbox = fmt::format("_INBOX_{}.{}", settings.name, letters(12));
  state->subjects = {state->inbox + ".>"};
  error = state->connect();
  if (!error.empty()) return nullptr;
  return std::unique_ptr<NatsLink>(new NatsLink(std::move(state)));
}

bool NatsLink::publish(const Message& message) {
  if (!is_connected()) return false;
  const NatsMessage out = nats_message(message);
  return out && natsConnection_PublishMsg(state_->connection.get(), out.get()) == NATS_OK;
}

void NatsLink::listen(const std::string& subject) {
  state_->subjects.push_back(subject);
  state_->listen(subject);
}

std::vector<Message> NatsLink::take() {
  std::uint64_t count = 0;
  (void)!::read(state_->wake.get(), &count, sizeof count);
  const std::int64_t now_us = daemon::steady_clock_us();
  if (is_connected() || state_->seen_us == INT64_MIN) state_->seen_us = now_us;
  // The library gives up for good after two refusals and never reads a renewed certificate. Opening
  // a new connection lets an admitted building back in without a restart.
  const bool anew = state_->closed || now_us - state_->seen_us > kAnew_us;
  if (anew && now_us >= state_->open_again_us) {
    state_->open_again_us = now_us + kMaxWait_ms * 1000;
    state_->seen_us = now_us;
    (void)state_->close();
    if (const std::string problem = state_->connect(); !problem.empty()) {
      state_->say(problem);
      state_->closed = true;
    }
  }
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return std::exchange(state_->waiting, {});
}

std::int64_t NatsLink::connections() const {
  return state_->connections;
}

bool NatsLink::is_connected() const {
  return state_->connection &&
         natsConnection_Status(state_->connection.get()) == NATS_CONN_STATUS_CONNECTED;
}

std::string NatsLink::trouble() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->certificate_trouble.empty() ? state_->trouble : state_->certificate_trouble;
}

std::string NatsLink::inbox() const {
  return state_->inbox;
}

int NatsLink::descriptor() const {
  return state_->wake.get();
}

std::int64_t NatsLink::dropped() const {
  return state_->dropped;
}

bool NatsLink::flush(int timeout_ms) {
  return is_connected() &&
         natsConnection_FlushTimeout(state_->connection.get(), timeout_ms) == NATS_OK;
}

std::optional<Message> NatsLink::request(const std::string& subject, const Bytes& bytes,
                                         int timeout_ms, std::string& error) {
  if (!state_->connection) {
    error = trouble();
    return std::nullopt;
  }
  Message ask;
  ask.subject = subject;
  ask.bytes = bytes;
  const NatsMessage out = nats_message(ask);
  natsMsg* answer = nullptr;
  const natsStatus status =
      out ? natsConnection_RequestMsg(&answer, state_->connection.get(), out.get(), timeout_ms)
          : NATS_NO_MEMORY;
  if (status != NATS_OK) {
    error = last_error(status);
    return std::nullopt;
  }
  const NatsMessage owner(answer);
  return message_of(answer);
}

}  // namespace framewatch::fleet
