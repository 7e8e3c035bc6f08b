// SPDX-License-Identifier: MIT
#include "drivers/mqtt/mqtt_source.h"

#include <mosquitto.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "drivers/files/caught.h"

namespace framewatch::drivers {
namespace {

using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

constexpr int kLoop_ms = 250;     // so often the thread looks if it should end
constexpr seconds kPatience{30};  // for the answer to a connection
constexpr seconds kLasting{60};   // a connection of this length begins the pauses anew
constexpr int kAtMostOnce = 0;    // quality of service
constexpr int kSubscriptionRefused = 128;
constexpr const char* kSystemCertificates = "/etc/ssl/certs";

/// Prepares the library once for the process.
void begin_library() {
  static const int begun = ::mosquitto_lib_init();
  (void)begun;
}

/// Keeps signals in the other threads, and a broken connection from ending the program.
void block_signals() {
  sigset_t all;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

/// Returns "FILE: cannot be read" for the first file that cannot be; empty if all can.
std::string unreadable(std::initializer_list<const std::string*> files) {
  for (const std::string* file : files)
    if (!file->empty() && !std::ifstream(*file)) return *file + ": cannot be read";
  return {};
}

const char* or_null(const std::string& text) {
  return text.empty() ? nullptr : text.c_str();
}

}  // namespace

MqttSource::MqttSource(MqttSettings settings, std::vector<std::string> topics, Secret password)
    : settings_(std::move(settings)),
      address_(mqtt_address(settings_.url).value_or(MqttAddress{})),
      topics_(std::move(topics)),
      password_(std::move(password)) {
  begin_library();
  thread_ = std::thread([this] { work(); });
}

MqttSource::~MqttSource() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

bool MqttSource::stopped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return stop_;
}

std::vector<MqttMessage> MqttSource::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<MqttMessage> out(std::make_move_iterator(waiting_.begin()),
                               std::make_move_iterator(waiting_.end()));
  waiting_.clear();
  return out;
}

MqttState MqttSource::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

void MqttSource::work() {
  block_signals();
  int pause_s = 1;
  while (!stopped()) {
    const Clock::time_point began = Clock::now();
    std::string trouble;
    const std::string thrown = caught([&] { trouble = stay_connected(); });
    std::unique_lock<std::mutex> lock(mutex_);
    state_.connected = false;
    state_.trouble = thrown.empty() ? trouble : thrown;
    if (Clock::now() - began >= kLasting) pause_s = 1;
    wake_.wait_for(lock, seconds(pause_s), [this] { return stop_; });
    pause_s = std::min(2 * pause_s, kLongestPause_s);
  }
}

/// Sets login and certificates. Returns what is wrong with them, or an empty text.
std::string MqttSource::prepare(mosquitto* client) {
  if (!settings_.user.empty()) {
    std::string trouble;
    std::optional<std::string> password;
    if (!settings_.password_file.empty()) {
      password = password_(trouble);
      if (!password) return trouble;
    }
    if (::mosquitto_username_pw_set(client, settings_.user.c_str(),
                                    password ? password->c_str() : nullptr) != MOSQ_ERR_SUCCESS)
      return "the user is not UTF-8";
  }
  if (!address_.tls) return {};
  if (std::string why =
          unreadable({&settings_.ca_file, &settings_.certificate_file, &settings_.key_file});
      !why.empty())
    return why;
  const int code = ::mosquitto_tls_set(
      client, or_null(settings_.ca_file), settings_.ca_file.empty() ? kSystemCertificates : nullptr,
      or_null(settings_.certificate_file), or_null(settings_.key_file), nullptr);
  return code == MOSQ_ERR_SUCCESS ? "" : fmt::format("TLS: {}", ::mosquitto_strerror(code));
}

/// Connects and receives until the connection ends. Returns why it ended; empty if it should.
std::string MqttSource::stay_connected() {
  requests_.clear();
  refused_.clear();
  complaint_.clear();
  const std::unique_ptr<mosquitto, void (*)(mosquitto*)> client(
      ::mosquitto_new(or_null(settings_.client_id), true, this), ::mosquitto_destroy);
  if (!client) return fmt::format("cannot begin: {}", std::strerror(errno));
  ::mosquitto_connect_callback_set(
      client.get(), [](mosquitto* c, void* self, int code) { of(self).answered(c, code); });
  ::mosquitto_subscribe_callback_set(
      client.get(), [](mosquitto*, void* self, int request, int count, const int* granted) {
        of(self).subscribed(request, count > 0 ? granted[0] : kSubscriptionRefused);
      });
  ::mosquitto_message_callback_set(
      client.get(),
      [](mosquitto*, void* self, const mosquitto_message* m) { of(self).received(*m); });
  ::mosquitto_log_callback_set(client.get(), [](mosquitto*, void* self, int level, const char* t) {
    if (level == MOSQ_LOG_ERR) of(self).complaint_ = t;
  });
  if (std::string why = prepare(client.get()); !why.empty()) return why;
  const Clock::time_point give_up = Clock::now() + kPatience;
  int code = ::mosquitto_connect_async(client.get(), address_.host.c_str(), address_.port,
                                       settings_.keepalive_s);
  while (code == MOSQ_ERR_SUCCESS && !stopped()) {
    code = ::mosquitto_loop(client.get(), kLoop_ms, 1);
    if (Clock::now() > give_up && !state().connected)
      return fmt::format("no answer for {} s", kPatience.count());
  }
  if (code != MOSQ_ERR_SUCCESS) return why_ended(code);
  ::mosquitto_disconnect(client.get());
  return {};
}

/// Returns the words for the end of a connection. `code` is of the library; uses errno.
std::string MqttSource::why_ended(int code) const {
  if (!complaint_.empty()) return complaint_;
  if (code == MOSQ_ERR_ERRNO) return std::strerror(errno);
  if (code == MOSQ_ERR_EAI) return address_.host + ": no such host";
  return ::mosquitto_strerror(code);
}

void MqttSource::answered(mosquitto* client, int code) {
  if (code != 0) {
    complaint_ = ::mosquitto_connack_string(code);
    return;
  }
  for (const std::string& topic : topics_) {
    int request = 0;
    if (::mosquitto_subscribe(client, &request, topic.c_str(), kAtMostOnce) == MOSQ_ERR_SUCCESS)
      requests_[request] = topic;
  }
  if (requests_.empty()) begin();
}

void MqttSource::subscribed(int request, int granted) {
  const auto topic = requests_.find(request);
  if (topic == requests_.end()) return;
  if (granted >= kSubscriptionRefused) refused_.insert(topic->second);
  requests_.erase(topic);
  if (requests_.empty()) begin();
}

/// Notes that the broker has answered everything.
void MqttSource::begin() {
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.connected = true;
  state_.trouble.clear();
  if (!refused_.empty())
    state_.trouble = fmt::format("the broker refuses the topic {}", fmt::join(refused_, ", "));
  ++state_.connections;
}

void MqttSource::received(const mosquitto_message& message) {
  const auto bytes = static_cast<std::size_t>(std::max(message.payloadlen, 0));
  const std::lock_guard<std::mutex> lock(mutex_);
  ++state_.messages;
  if (bytes > kMostPayload_bytes) {
    ++state_.too_long;
  } else if (waiting_.size() >= static_cast<std::size_t>(settings_.queue_capacity)) {
    ++state_.dropped;
  } else {
    const auto* text = static_cast<const char*>(message.payload);
    waiting_.push_back(
        {message.topic, text == nullptr ? "" : std::string(text, bytes), message.retain});
  }
}

}  // namespace framewatch::drivers
