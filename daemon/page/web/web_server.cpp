// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_server.h"

#include <microhttpd.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/served_file.h"
#include "daemon/base/utc_time.h"
#include "daemon/page/view/live_view.h"
#include "daemon/page/view/years_desk.h"
#include "daemon/page/web/session_playback.h"
#include "daemon/page/web/web_answer.h"
#include "daemon/page/web/web_files.h"
#include "daemon/page/web/web_sessions.h"
#include "daemon/page/web/web_socket.h"
#include "daemon/tools/session/session_desk.h"
#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";
constexpr const char* kJson = "application/json";
constexpr const char* kSessionPath = "/session/";
constexpr const char* kPlayback = "/playback";
constexpr const char* kEventReportPath = "/event-report/";
constexpr std::size_t kBlock = 32768;
constexpr int kMaxPlaybacks = 4;                 // at once: each decodes a log
constexpr std::size_t kPlaybackBytes = 4 << 20;  // of memory, for the limits of answers
constexpr int kOtherDescriptors = 64;            // LCM, the history's files, logs

const char* type_of(const std::string& path) {
  return path.ends_with(".js")    ? "text/javascript; charset=utf-8"
         : path.ends_with(".css") ? "text/css; charset=utf-8"
         : path.ends_with(".svg") ? "image/svg+xml"
                                  : "text/html; charset=utf-8";
}

}  // namespace

class WebServer::Implementation {
 public:
  Implementation(const WebSettings& settings, LiveView& view)
      : settings_(settings), view_(view), guard_(settings.connections) {
    if (view.config().history) desk_.emplace(view.config());
  }

  ~Implementation() {
    stopping_ = true;
    if (desk_) desk_->close();
    wake();
    if (daemon_) MHD_stop_daemon(daemon_);
  }

  bool start(int socket, std::string& error) {
    const int most = settings_.connections.connections();
    if (allow_descriptors(most + kOtherDescriptors, error)) {
      daemon_ = MHD_start_daemon(
          MHD_USE_AUTO_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME, 0, nullptr, nullptr,
          &Implementation::handle, this, MHD_OPTION_LISTEN_SOCKET, socket,
          MHD_OPTION_CONNECTION_LIMIT, static_cast<unsigned>(most), MHD_OPTION_CONNECTION_TIMEOUT,
          settings_.connections.idle_s, MHD_OPTION_NOTIFY_CONNECTION, &Implementation::notify, this,
          MHD_OPTION_NOTIFY_COMPLETED, &Implementation::completed, nullptr, MHD_OPTION_END);
      if (!daemon_) error = "cannot start libmicrohttpd";
    }
    if (!daemon_) {
      ::close(socket);
      return false;
    }
    return true;
  }

  int port() const { return MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_BIND_PORT)->port; }
  int viewers() const { return guard_.use().viewers; }

  void wake() {
    guard_.sweep();
    const std::lock_guard<std::mutex> lock(mutex_);
    for (MHD_Connection* waiting : waiting_) MHD_resume_connection(waiting);
    waiting_.clear();
  }

 private:
  /// One open stream of events.
  struct Viewer {
    Implementation* server;
    MHD_Connection* connection;
    EventRing::Cursor cursor;
  };

  static void notify(void* self, MHD_Connection* c, void**, MHD_ConnectionNotificationCode what) {
    ConnectionGuard& guard = static_cast<Implementation*>(self)->guard_;
    if (what == MHD_CONNECTION_NOTIFY_STARTED)
      guard.opened(socket_of(c));
    else
      guard.closed(socket_of(c));
  }

  /// A request about the history. Its connection is suspended until there is an answer.
  struct Asked {
    YearsAnswer answer;
  };

  static void completed(void*, MHD_Connection*, void** asked, MHD_RequestTerminationCode) {
    const std::unique_ptr<Asked> ended(static_cast<Asked*>(*asked));
    *asked = nullptr;
  }

  /// Handles a request when its head is complete, and once more when an answer that it waited for
  /// has come. Never waits for a body.
  static MHD_Result handle(void* of, MHD_Connection* c, const char* url, const char* method,
                           const char*, const char*, std::size_t*, void** asked) {
    auto& self = *static_cast<Implementation*>(of);
    if (*asked != nullptr) return self.answer_asked(c, *static_cast<Asked*>(*asked));
    self.guard_.asked(socket_of(c));
    return self.respond(c, method, url, asked);
  }

  MHD_Result text(MHD_Connection* c, const std::string& content, const char* type,
                  const char* policy = kPagePolicy) {
    return answer(guard_, c, MHD_HTTP_OK, content, type, policy);
  }

  MHD_Result plain(MHD_Connection* c, unsigned code, const std::string& content) {
    return answer(guard_, c, code, content + "\n", kPlainText);
  }

  MHD_Result report(MHD_Connection* c, const std::optional<WebFile>& found) {
    if (!found) return plain(c, MHD_HTTP_NOT_FOUND, "not here");
    return text(c, found->content, found->type.c_str(), kReportPolicy);
  }

  MHD_Result respond(MHD_Connection* c, const std::string& method, const std::string& path,
                     void** asked) {
    const WebRequest request = web_request(c, method, path, "framewatch");
    if (const Admission admission = admit(settings_, request); admission != Admission::served) {
      const Refusal refusal = refusal_of(admission);
      return plain(c, refusal.code, refusal.text);
    }
    if (method == "POST") return act(c, path);
    if (path == "/" && !request.token.empty()) return exchange(c, request.token);
    if (path == "/events") return stream(c);
    if (path == "/building.json") return text(c, view_.building_json(), kJson);
    if (path == "/years.json") return ask_years(c, asked);
    if (path == "/history.json") return text(c, view_.history_json(), kJson);
    if (path == "/sessions.json")
      return text(c, settings_.sessions.empty() ? "null" : sessions_json(settings_.sessions),
                  kJson);
    if (path == "/event-reports.json")
      return text(
          c, settings_.event_reports.empty() ? "null" : event_reports_json(settings_.event_reports),
          kJson);
    if (path.starts_with(kSessionPath) && path.ends_with(kPlayback)) return play(c, path);
    if (path.starts_with(kSessionPath))
      return report(c,
                    session_document(settings_.sessions, path.substr(std::strlen(kSessionPath))));
    if (path.starts_with(kEventReportPath))
      return report(c, event_report_document(settings_.event_reports,
                                             path.substr(std::strlen(kEventReportPath))));
    if (path == "/metrics" && settings_.metrics)
      return text(c, settings_.metrics(guard_.use()), kMetricsType);
    if (path == "/healthz") return plain(c, MHD_HTTP_OK, "ok");
    return file(c, path == "/" ? "/index.html" : path);
  }

  /// Suspends the connection until the desk has an answer.
  MHD_Result ask_years(MHD_Connection* c, void** asked) {
    if (!desk_)
      return plain(c, MHD_HTTP_NOT_FOUND, "the configuration has no [history], so nothing is kept");
    const auto text = [c](const char* name) { return header(c, name, MHD_GET_ARGUMENT_KIND); };
    std::string problem;
    std::optional<YearsRequest> request = read_years_request(
        text("from"), text("to"), text("last"), text("elements"), text("only"), problem);
    if (!request) return plain(c, MHD_HTTP_BAD_REQUEST, problem);
    auto waiting = std::make_unique<Asked>();
    MHD_suspend_connection(c);
    const bool taken =
        desk_->ask(std::move(*request), [c, waits = waiting.get()](YearsAnswer answer) {
          waits->answer = std::move(answer);
          MHD_resume_connection(c);
        });
    if (!taken) {
      waiting->answer = {MHD_HTTP_SERVICE_UNAVAILABLE,
                         "too many requests about the history are waiting: try again later"};
      MHD_resume_connection(c);
    }
    *asked = waiting.release();  // completed() owns it now
    return MHD_YES;
  }

  MHD_Result answer_asked(MHD_Connection* c, const Asked& asked) {
    return asked.answer.code == MHD_HTTP_OK ? text(c, asked.answer.text, kJson)
                                            : plain(c, asked.answer.code, asked.answer.text);
  }

  MHD_Result act(MHD_Connection* c, const std::string& path) {
    if (path == "/baseline") {
      if (!view_.renew_baseline())
        return plain(c, MHD_HTTP_CONFLICT,
                     "framewatch run keeps the baseline, because the configuration has [watch]");
      return plain(c, MHD_HTTP_OK, "the baseline is learned anew from the next seconds");
    }
    if (path == "/session") return tell_recorder(c);
    if (path == "/weather") return take_reading(c);
    const std::string text = header(c, "id", MHD_GET_ARGUMENT_KIND);
    std::int64_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    const bool number = error == std::errc() && end == text.data() + text.size();
    const auto asked = number ? view_.acknowledge(id, "the page at " + viewer_of(c)) : std::nullopt;
    if (!asked) return plain(c, MHD_HTTP_NOT_FOUND, "no such event");
    wake();
    return *asked == 0 ? plain(c, MHD_HTTP_OK, "acknowledged")
                       : plain(c, MHD_HTTP_ACCEPTED, std::to_string(*asked));
  }

  /// Takes a reading of weather for `framewatch run`.
  MHD_Result take_reading(MHD_Connection* c) {
    const auto text = [c](const char* name) { return header(c, name, MHD_GET_ARGUMENT_KIND); };
    const std::string name = text("name"), time = text("time");
    const std::optional<double> value = drivers::parse_number(text("value"));
    if (!value || !std::isfinite(*value))
      return plain(c, MHD_HTTP_BAD_REQUEST, "value: is not a number");
    const std::optional<std::int64_t> time_us = read_utc(time);
    if (!time.empty() && !time_us)
      return plain(c, MHD_HTTP_BAD_REQUEST,
                   "time: is not a time in UTC such as 2026-01-31T12:00:00Z");
    switch (view_.reading(name, *value, time.empty() ? std::nullopt : time_us)) {
      case LiveView::ReadingOutcome::unknown_name:
        return plain(c, MHD_HTTP_NOT_FOUND, "no [[weather]] of the configuration has this name");
      case LiveView::ReadingOutcome::no_time:
        return plain(c, MHD_HTTP_CONFLICT,
                     "framewatch run has published nothing yet: give the sensors' time");
      case LiveView::ReadingOutcome::full:
        return plain(c, MHD_HTTP_SERVICE_UNAVAILABLE,
                     "too many readings are waiting: try again later");
      case LiveView::ReadingOutcome::taken:
        break;
    }
    return plain(c, MHD_HTTP_ACCEPTED, "taken");
  }

  /// Answers with the id of the command. The recorder's answer comes later as an event with that
  /// id.
  MHD_Result tell_recorder(MHD_Connection* c) {
    const auto text = [c](const char* name) { return header(c, name, MHD_GET_ARGUMENT_KIND); };
    SessionRequest request{text("test"), text("operator"), text("notes")};
    for (const auto& [name, value] : {std::pair{"length_s", &request.length_s},
                                      std::pair{"trigger_mps2", &request.trigger_mps2},
                                      std::pair{"pre_trigger_s", &request.pre_trigger_s}}) {
      const std::string given = text(name);
      const char* const end = given.data() + given.size();
      const auto [parsed, error] = std::from_chars(given.data(), end, *value);
      if (!given.empty() && (error != std::errc() || parsed != end))
        return plain(c, MHD_HTTP_BAD_REQUEST, std::string(name) + ": is not a number");
    }
    for (const std::string& problem : problems(request))
      return plain(c, MHD_HTTP_BAD_REQUEST, problem);
    const session_command_t command = session_command(text("verb"), request);
    if (!view_.tell_recorder(command))
      return plain(c, MHD_HTTP_SERVICE_UNAVAILABLE,
                   "too many commands are waiting: try again later");
    return plain(c, MHD_HTTP_ACCEPTED, std::to_string(command.id));
  }

  /// Replaces the token in the address with a cookie that scripts cannot read.
  MHD_Result exchange(MHD_Connection* c, const std::string& token) {
    MHD_Response* response = MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT);
    if (!response) return MHD_NO;
    MHD_add_response_header(response, "Location", "/");
    if (!settings_.token.empty() && token == settings_.token)
      MHD_add_response_header(
          response, "Set-Cookie",
          ("framewatch=" + settings_.token + "; HttpOnly; SameSite=Strict; Path=/").c_str());
    return send_answer(c, MHD_HTTP_SEE_OTHER, response);
  }

  MHD_Result file(MHD_Connection* c, const std::string& path) {
    const auto found = page_files().find(path);
    if (found == page_files().end()) return plain(c, MHD_HTTP_NOT_FOUND, "not here");
    if (settings_.files.empty()) return text(c, found->second.content, found->second.type.c_str());
    const auto content = read_served_file(settings_.files, {path.substr(1)});
    return content ? text(c, *content, type_of(path)) : plain(c, MHD_HTTP_NOT_FOUND, "not here");
  }

  MHD_Result stream(MHD_Connection* c) {
    if (!guard_.watches(socket_of(c)))
      return plain(c, MHD_HTTP_SERVICE_UNAVAILABLE, "too many viewers: try again later");
    auto viewer = std::make_unique<Viewer>(Viewer{this, c, view_.join()});
    MHD_Response* response = MHD_create_response_from_callback(
        MHD_SIZE_UNKNOWN, kBlock, &Implementation::read, viewer.get(), &Implementation::leave);
    if (!response) return MHD_NO;
    (void)viewer.release();  // leave() owns it now
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, "text/event-stream");
    return send_answer(c, MHD_HTTP_OK, response);
  }

  static ssize_t read(void* of, std::uint64_t, char* buffer, std::size_t size) {
    auto& viewer = *static_cast<Viewer*>(of);
    Implementation& server = *viewer.server;
    const std::lock_guard<std::mutex> lock(server.mutex_);
    if (server.stopping_) return MHD_CONTENT_READER_END_OF_STREAM;
    const std::size_t copied = server.view_.read(viewer.cursor, buffer, size);
    if (copied == 0) {
      server.waiting_.insert(viewer.connection);
      MHD_suspend_connection(viewer.connection);
    }
    return static_cast<ssize_t>(copied);
  }

  static void leave(void* of) {
    const std::unique_ptr<Viewer> viewer(static_cast<Viewer*>(of));
    const std::lock_guard<std::mutex> lock(viewer->server->mutex_);
    viewer->server->waiting_.erase(viewer->connection);
  }

  /// A session that a viewer plays.
  struct Player {
    Implementation* server;
    std::unique_ptr<SessionPlayback> playback;
  };

  MHD_Result play(MHD_Connection* c, const std::string& path) {
    const std::size_t from = std::strlen(kSessionPath);
    const std::string name = path.substr(from, path.size() - from - std::strlen(kPlayback));
    if (playing_ >= kMaxPlaybacks)
      return plain(c, MHD_HTTP_SERVICE_UNAVAILABLE,
                   "too many sessions are being played: try again later");
    std::string why;
    auto playback = SessionPlayback::open(view_.config(), settings_.sessions, name, why);
    if (!playback) return plain(c, MHD_HTTP_CONFLICT, why);
    auto player = std::make_unique<Player>(Player{this, std::move(playback)});
    MHD_Response* response = MHD_create_response_from_callback(
        MHD_SIZE_UNKNOWN, kBlock,
        [](void* of, std::uint64_t, char* buffer, std::size_t size) {
          const std::size_t copied = static_cast<Player*>(of)->playback->read(buffer, size);
          return copied == 0 ? MHD_CONTENT_READER_END_OF_STREAM : static_cast<ssize_t>(copied);
        },
        player.get(),
        [](void* of) {
          const std::unique_ptr<Player> ended(static_cast<Player*>(of));
          --ended->server->playing_;
        });
    if (!response) return MHD_NO;
    ++playing_;
    (void)player.release();  // the response owns it now
    guard_.answered(socket_of(c), kPlaybackBytes);
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, "text/event-stream");
    return send_answer(c, MHD_HTTP_OK, response);
  }

  const WebSettings settings_;
  LiveView& view_;
  ConnectionGuard guard_;
  MHD_Daemon* daemon_ = nullptr;
  std::mutex mutex_;
  std::set<MHD_Connection*> waiting_;  ///< suspended until new events come
  std::atomic<bool> stopping_ = false;
  int playing_ = 0;                ///< used by the thread of libmicrohttpd only
  std::optional<YearsDesk> desk_;  ///< with [history]
};

WebServer::WebServer(const WebSettings& settings, LiveView& view)
    : implementation_(std::make_unique<Implementation>(settings, view)) {}
WebServer::~WebServer() = default;
bool WebServer::start(int socket, std::string& error) {
  return implementation_->start(socket, error);
}
int WebServer::port() const {
  return implementation_->port();
}
int WebServer::viewers() const {
  return implementation_->viewers();
}
void WebServer::wake() {
  implementation_->wake();
}

}  // namespace framewatch::daemon
