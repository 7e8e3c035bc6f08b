// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

struct MHD_Daemon;
struct MHD_Connection;

namespace framewatch::test {

/// A received request.
struct HttpRequest {
  std::string method, path, body;
  std::map<std::string, std::string> headers;  ///< names in lower case
};

/// A web server on 127.0.0.1 with answers that the test sets.
class HttpServer {
 public:
  /// port 0: any. With a certificate and its key, as PEM texts, it uses https.
  explicit HttpServer(int port = 0, const std::string& certificate = "",
                      const std::string& key = "");
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Sets the status of the next answers, one each. The last one stays.
  void answer(std::vector<unsigned> statuses);
  /// Sets the text of the next answers, and their header Retry-After; empty: none.
  void say(const std::string& text, const std::string& retry_after = "");
  /// Delays every answer by this time.
  void delay(std::chrono::milliseconds by);
  int port() const { return port_; }
  std::vector<HttpRequest> requests() const;

 private:
  struct Callbacks;

  mutable std::mutex mutex_;  ///< guards the members below
  std::vector<unsigned> statuses_{200};
  std::string text_, retry_after_;
  std::chrono::milliseconds delay_{0};
  std::vector<HttpRequest> requests_;
  MHD_Daemon* daemon_ = nullptr;
  int port_ = 0;
};

}  // namespace framewatch::test
