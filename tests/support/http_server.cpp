// SPDX-License-Identifier: MIT
#include "tests/support/http_server.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

namespace framewatch::test {

struct HttpServer::Callbacks {
  static MHD_Result header(void* into, MHD_ValueKind, const char* name, const char* value) {
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    (*static_cast<std::map<std::string, std::string>*>(into))[lower] = value;
    return MHD_YES;
  }

  static MHD_Result request(void* self, MHD_Connection* connection, const char* path,
                            const char* method, const char*, const char* data, std::size_t* size,
                            void** state) {
    auto* request = static_cast<HttpRequest*>(*state);
    if (request == nullptr) {
      *state = request = new HttpRequest{method, path, {}, {}};
      MHD_get_connection_values(connection, MHD_HEADER_KIND, &header, &request->headers);
      return MHD_YES;
    }
    if (*size > 0) {
      request->body.append(data, *size);
      *size = 0;
      return MHD_YES;
    }
    const std::unique_ptr<HttpRequest> whole(request);
    *state = nullptr;
    auto* const server = static_cast<HttpServer*>(self);
    unsigned status = 0;
    std::string text, retry_after;
    std::chrono::milliseconds delay{0};
    {
      const std::lock_guard<std::mutex> lock(server->mutex_);
      server->requests_.push_back(*whole);
      status = server->statuses_.front();
      if (server->statuses_.size() > 1) server->statuses_.erase(server->statuses_.begin());
      delay = server->delay_;
      text = server->text_;
      retry_after = server->retry_after_;
    }
    std::this_thread::sleep_for(delay);
    MHD_Response* response =
        MHD_create_response_from_buffer(text.size(), text.data(), MHD_RESPMEM_MUST_COPY);
    if (!retry_after.empty()) MHD_add_response_header(response, "Retry-After", retry_after.c_str());
    const MHD_Result result = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return result;
  }

  static void completed(void*, MHD_Connection*, void** state, MHD_RequestTerminationCode) {
    delete static_cast<HttpRequest*>(*state);
    *state = nullptr;
  }
};

HttpServer::HttpServer(int port, const std::string& certificate, const std::string& key) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::vector<MHD_OptionItem> options{
      {MHD_OPTION_NOTIFY_COMPLETED, reinterpret_cast<intptr_t>(&Callbacks::completed), nullptr},
      {MHD_OPTION_SOCK_ADDR, 0, &address}};
  unsigned flags = MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION;
  if (!certificate.empty()) {
    flags |= MHD_USE_TLS;
    options.push_back({MHD_OPTION_HTTPS_MEM_CERT, 0, const_cast<char*>(certificate.c_str())});
    options.push_back({MHD_OPTION_HTTPS_MEM_KEY, 0, const_cast<char*>(key.c_str())});
  }
  options.push_back({MHD_OPTION_END, 0, nullptr});
  daemon_ =
      MHD_start_daemon(flags, static_cast<std::uint16_t>(port), nullptr, nullptr,
                       &Callbacks::request, this, MHD_OPTION_ARRAY, options.data(), MHD_OPTION_END);
  if (daemon_ == nullptr) throw std::runtime_error("no web server can be started");
  port_ = MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_BIND_PORT)->port;
}

HttpServer::~HttpServer() {
  MHD_stop_daemon(daemon_);
}

void HttpServer::answer(std::vector<unsigned> statuses) {
  const std::lock_guard<std::mutex> lock(mutex_);
  statuses_ = std::move(statuses);
}

void HttpServer::say(const std::string& text, const std::string& retry_after) {
  const std::lock_guard<std::mutex> lock(mutex_);
  text_ = text;
  retry_after_ = retry_after;
}

void HttpServer::delay(std::chrono::milliseconds by) {
  const std::lock_guard<std::mutex> lock(mutex_);
  delay_ = by;
}

std::vector<HttpRequest> HttpServer::requests() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return requests_;
}

}  // namespace framewatch::test
