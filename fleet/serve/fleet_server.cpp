// SPDX-License-Identifier: MIT
#include "fleet/serve/fleet_server.h"

#include <microhttpd.h>
#include <unistd.h>

#include <map>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/served_file.h"
#include "daemon/page/web/web_admission.h"
#include "daemon/page/web/web_answer.h"
#include "daemon/page/web/web_files.h"
#include "daemon/page/web/web_socket.h"
#include "drivers/files/caught.h"
#include "fleet/serve/fleet_files.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kCookie = "framewatch_fleet";
constexpr std::string_view kPostPaths[] = {"/command"};
constexpr std::string_view kBearer = "Bearer ";
constexpr int kOtherDescriptors = 64;  // the hub, the database, logs
// Shared with the page of one building.
constexpr const char* kShared[] = {"/page.css", "/words.js", "/icon.svg", "/uPlot.iife.min.js",
                                   "/uPlot.min.css"};

std::map<std::string, std::string> arguments_of(MHD_Connection* c) {
  std::map<std::string, std::string> out;
  MHD_get_connection_values(
      c, MHD_GET_ARGUMENT_KIND,
      [](void* of, MHD_ValueKind, const char* name, const char* value) {
        static_cast<std::map<std::string, std::string>*>(of)->emplace(name, value ? value : "");
        return MHD_YES;
      },
      &out);
  return out;
}

const daemon::WebFile* file_of(const std::string& path) {
  const auto own = fleet_files().find(path);
  if (own != fleet_files().end()) return &own->second;
  for (const char* shared : kShared)
    if (path == shared) return &daemon::page_files().at(path);
  return nullptr;
}

}  // namespace

class FleetServer::Implementation {
 public:
  Implementation(FleetServerSettings settings, FleetPages& pages)
      : settings_(std::move(settings)), pages_(pages), guard_(settings_.web.connections) {}
  ~Implementation() {
    if (daemon_) MHD_stop_daemon(daemon_);
  }

  bool start(int socket, std::string& error) {
    const int most = settings_.web.connections.connections();
    if (daemon::allow_descriptors(most + kOtherDescriptors, error)) {
      daemon_ = MHD_start_daemon(
          MHD_USE_AUTO_INTERNAL_THREAD, 0, nullptr, nullptr, &Implementation::handle, this,
          MHD_OPTION_LISTEN_SOCKET, socket, MHD_OPTION_CONNECTION_LIMIT,
          static_cast<unsigned>(most), MHD_OPTION_CONNECTION_TIMEOUT,
          settings_.web.connections.idle_s, MHD_OPTION_THREAD_POOL_SIZE, kThreads,
          MHD_OPTION_NOTIFY_CONNECTION, &Implementation::notify, this, MHD_OPTION_END);
      if (!daemon_) error = "libmicrohttpd cannot start";
    }
    if (!daemon_) ::close(socket);
    return daemon_ != nullptr;
  }
  int port() const { return MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_BIND_PORT)->port; }
  void sweep() { guard_.sweep(); }

 private:
  static void notify(void* self, MHD_Connection* c, void**, MHD_ConnectionNotificationCode what) {
    daemon::ConnectionGuard& guard = static_cast<Implementation*>(self)->guard_;
    if (what == MHD_CONNECTION_NOTIFY_STARTED)
      guard.opened(daemon::socket_of(c));
    else
      guard.closed(daemon::socket_of(c));
  }

  static MHD_Result handle(void* of, MHD_Connection* c, const char* url, const char* method,
                           const char*, const char*, std::size_t*, void**) {
    auto& self = *static_cast<Implementation*>(of);
    self.guard_.asked(daemon::socket_of(c));
    MHD_Result result = MHD_NO;
    const std::string thrown = drivers::caught([&] { result = self.respond(c, method, url); });
    if (thrown.empty()) return result;
    self.failures_(daemon::steady_clock_us(), thrown);
    return self.plain(c, 500, "internal error: see the log of framewatch fleet serve");
  }

  MHD_Result plain(MHD_Connection* c, unsigned code, const std::string& text) {
    return daemon::answer(guard_, c, code, text + "\n", daemon::kPlainText);
  }

  /// Returns the person who asks; nullptr if not admitted. Without people, this machine may view.
  const Person* person_of(const daemon::WebRequest& r) const {
    static const Person kAnybody{"anyone on this machine", Role::viewer, ""};
    if (settings_.people.all().empty()) return settings_.web.local() ? &kAnybody : nullptr;
    const std::string bearer = r.authorization.starts_with(kBearer)
                                   ? r.authorization.substr(kBearer.size())
                                   : std::string();
    for (const std::string& token : {r.cookie, bearer, r.token})
      if (const Person* person = settings_.people.of_token(token)) return person;
    return nullptr;
  }

  MHD_Result respond(MHD_Connection* c, const std::string& method, const std::string& path) {
    const daemon::WebRequest request = daemon::web_request(c, method, path, kCookie);
    const daemon::Admission admission = daemon::admit_form(settings_.web, request, kPostPaths);
    if (admission != daemon::Admission::served) {
      const daemon::Refusal refusal = daemon::refusal_of(admission);
      return plain(c, refusal.code, refusal.text);
    }
    if (path == "/healthz") return plain(c, 200, "ok");
    const Person* const person = person_of(request);
    if (person == nullptr)
      return plain(c, 403,
                   "open the address with your token: /?token=... (framewatch fleet person)");
    if (path == "/" && !request.token.empty()) return exchange(c, request.token);
    if (method != "POST" && !path.ends_with(".json"))
      return file(c, path == "/" ? "/index.html" : path);
    const PageAnswer made =
        pages_.answer({method, path, arguments_of(c), person->name, person->role});
    return daemon::answer(guard_, c, made.code, made.text, made.type.c_str());
  }

  /// Replaces the token in the address with a cookie that scripts cannot read.
  MHD_Result exchange(MHD_Connection* c, const std::string& token) {
    MHD_Response* response = MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT);
    if (!response) return MHD_NO;
    MHD_add_response_header(response, "Location", "/");
    if (settings_.people.of_token(token) != nullptr)
      MHD_add_response_header(
          response, "Set-Cookie",
          fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", kCookie, token).c_str());
    return daemon::send_answer(c, 303, response);
  }

  MHD_Result file(MHD_Connection* c, const std::string& path) {
    const daemon::WebFile* const found = file_of(path);
    if (found == nullptr) return plain(c, 404, "not found");
    if (!settings_.web.files.empty())
      if (const auto text = daemon::read_served_file(settings_.web.files, {path.substr(1)}))
        return daemon::answer(guard_, c, 200, *text, found->type.c_str());
    return daemon::answer(guard_, c, 200, found->content, found->type.c_str());
  }

  const FleetServerSettings settings_;
  FleetPages& pages_;
  daemon::ConnectionGuard guard_;
  daemon::RateLimitedLog failures_{daemon::LogLevel::error};
  MHD_Daemon* daemon_ = nullptr;
};

FleetServer::FleetServer(FleetServerSettings settings, FleetPages& pages)
    : implementation_(std::make_unique<Implementation>(std::move(settings), pages)) {}
FleetServer::~FleetServer() = default;
bool FleetServer::start(int socket, std::string& error) {
  return implementation_->start(socket, error);
}
int FleetServer::port() const {
  return implementation_->port();
}
void FleetServer::sweep() {
  implementation_->sweep();
}

}  // namespace framewatch::fleet
