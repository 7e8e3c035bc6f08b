// SPDX-License-Identifier: MIT
// Requests of a browser, or of anything else, to the page's server over a connection.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <string_view>

#include "daemon/page/metrics/metrics.h"
#include "daemon/page/view/live_view.h"
#include "daemon/page/web/web_server.h"
#include "daemon/page/web/web_socket.h"
#include "daemon/tools/report/session_file.h"
#include "tests/fuzz/example_building.h"
#include "tests/fuzz/message_sequence.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

daemon::CommandAnswer no_daemon_behind(const std::string&, const daemon::CommandPacket&) {
  return {};
}

constexpr std::string_view kLastRequest =
    "\r\n\r\nGET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
constexpr std::string_view kSecret = "nobody may read this";

/// A server on a free port, with a session in its folder and a secret file beside it.
class Page {
 public:
  Page()
      : view_(
            example_building(), [](auto...) {}, no_daemon_behind),
        metrics_(example_building()),
        server_(settings(), view_) {
    for (const auto& [channel, payload] : example_messages())
      view_.message(channel, payload.data(), payload.size());
    std::string error;
    const int socket = daemon::listen_on("127.0.0.1", 0, error);
    require(socket >= 0 && server_.start(socket, error), error.c_str());
  }

  /// Returns the answer; of an event stream only the beginning. A last request asks the server to
  /// close.
  std::string ask(Bytes request) {
    const int s = connected();
    const timeval patience{0, 100'000};  // for a server that waits for the rest of a request
    ::setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    const std::string all = text_of(request) + std::string(kLastRequest);
    (void)::send(s, all.data(), all.size(), MSG_NOSIGNAL);
    ::shutdown(s, SHUT_WR);
    std::string answer;
    char part[4096];
    for (ssize_t got; answer.find("event-stream") == std::string::npos &&
                      (got = ::recv(s, part, sizeof part, 0)) > 0;)
      answer.append(part, static_cast<std::size_t>(got));
    const linger at_once{1, 0};  // frees the port
    ::setsockopt(s, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    ::close(s);
    view_.flush();
    server_.wake();
    return answer;
  }

 private:
  /// A host that lacks ports, or time to accept, is not a finding: the request is repeated.
  int connected() {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(server_.port()));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int i = 0; i < 500; ++i) {
      const int s = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      if (::connect(s, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return s;
      ::close(s);
      ::usleep(10'000);
    }
    require(false, "a connection");
    return -1;
  }

  daemon::WebSettings settings() {
    const std::string folder = scratch_folder() + "/sessions";
    std::filesystem::create_directories(folder + "/one");
    const std::string session = daemon::session_json({});
    write_scratch_file(folder + "/one/session.json", session.data(), session.size());
    write_scratch_file(folder + "/one/report.html", "report", 6);
    write_scratch_file(scratch_folder() + "/report.html", kSecret.data(), kSecret.size());
    daemon::WebSettings s;
    s.token = "0123456789abcdef";
    s.sessions = folder;
    s.metrics = [this](const daemon::PageUse& use) { return metrics_.text(0, use); };
    return s;
  }

  daemon::LiveView view_;
  daemon::Metrics metrics_;
  daemon::WebServer server_;
};

void ask_page(Bytes input) {
  static Page page;
  const std::string answer = page.ask(input);
  require(answer.empty() || answer.starts_with("HTTP/1."), "an answer of HTTP");
  require(answer.find(kSecret) == std::string::npos, "nothing of another folder");
}

std::vector<std::string> http_seeds() {
  const std::string head = " HTTP/1.1\r\nHost: localhost\r\n";
  const std::string token = "Authorization: Bearer 0123456789abcdef\r\n";
  std::vector<std::string> out{
      "GET /?token=0123456789abcdef" + head + "\r\n",
      "GET /" + head + "Cookie: a=b; framewatch=0123456789abcdef\r\n\r\n",
      "GET /" + head + "\r\nGET /page.js" + head + "\r\n",
      "POST /acknowledge?id=1" + head + token + "Origin: http://localhost\r\n\r\n",
      "POST /acknowledge?id=1" + head + token + "Content-Length: 5\r\n\r\nhello",
      "POST /baseline" + head + token + "Transfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n",
      "POST /session?verb=arm&test=a%20b&operator=me&length_s=60&trigger_mps2=0.1&pre_trigger_s=1" +
          head + token + "\r\n",
      "HEAD /" + head + "Connection: close\r\n\r\n"};
  for (const char* path :
       {"/events", "/building.json", "/sessions.json", "/session/one/report.html",
        "/session/one/session.json", "/session/../report.html", "/session/%2e%2e/report.html",
        "/metrics", "/healthz"})
    out.push_back("GET " + std::string(path) + head + token + "\r\n");
  return out;
}

}  // namespace

const FuzzTarget kHttpTarget{"http", &ask_page, &http_seeds};

}  // namespace framewatch::test
