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

/// What one request brought.
struct HttpRequest {
  std::string method, path, body;
  std::map<std::string, std::string> headers;  ///< names in lower case
};

/// A web server on 127.0.0.1 that answers what it is told to.
class HttpServer {
 public:
  /// port 0: any. With a certificate and its key, as PEM texts, it speaks https.
  explicit HttpServer(int port = 0, const std::string& certificate = "",
                      const std::string& key = "");
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// The status of the next answers, one each; after them the last one stays.
  void answer(std::vector<unsigned> statuses);
  /// Every answer comes so much later.
  void delay(std::chrono::milliseconds by);
  int port() const { return port_; }
  std::vector<HttpRequest> requests() const;

 private:
  struct Callbacks;

  mutable std::mutex mutex_;  ///< guards what is below
  std::vector<unsigned> statuses_{200};
  std::chrono::milliseconds delay_{0};
  std::vector<HttpRequest> requests_;
  MHD_Daemon* daemon_ = nullptr;
  int port_ = 0;
};

}  // namespace framewatch::test
