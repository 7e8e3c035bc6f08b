// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_answer.h"

#include <netdb.h>
#include <netinet/in.h>
#include <strings.h>
#include <sys/socket.h>

#include <utility>

#include "daemon/page/web/web_socket.h"

namespace framewatch::daemon {

int socket_of(MHD_Connection* c) {
  return MHD_get_connection_info(c, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
}

std::string header(MHD_Connection* c, const char* name, MHD_ValueKind kind) {
  const char* value = MHD_lookup_connection_value(c, kind, name);
  return value ? value : "";
}

int count_of_header(MHD_Connection* c, const char* name) {
  std::pair<const char*, int> counted{name, 0};
  MHD_get_connection_values(
      c, MHD_HEADER_KIND,
      [](void* of, MHD_ValueKind, const char* key, const char*) {
        auto& [wanted, count] = *static_cast<std::pair<const char*, int>*>(of);
        if (::strcasecmp(key, wanted) == 0) ++count;
        return MHD_YES;
      },
      &counted);
  return counted.second;
}

WebRequest web_request(MHD_Connection* c, const std::string& method, const std::string& path,
                       const char* cookie) {
  return {method,
          path,
          header(c, "Host"),
          header(c, "Origin"),
          header(c, cookie, MHD_COOKIE_KIND),
          header(c, "Authorization"),
          header(c, "token", MHD_GET_ARGUMENT_KIND),
          header(c, "Content-Length"),
          header(c, "Transfer-Encoding"),
          count_of_header(c, "Host")};
}

std::string viewer_of(MHD_Connection* c) {
  const MHD_ConnectionInfo* info = MHD_get_connection_info(c, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
  if (info == nullptr || info->client_addr == nullptr) return "an unknown address";
  char name[NI_MAXHOST];
  const socklen_t size =
      info->client_addr->sa_family == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
  if (::getnameinfo(info->client_addr, size, name, sizeof name, nullptr, 0, NI_NUMERICHOST) != 0)
    return "an unknown address";
  return name;
}

MHD_Result send_answer(MHD_Connection* c, unsigned code, MHD_Response* response,
                       const char* policy) {
  for (const auto& [name, value] :
       {std::pair{"Content-Security-Policy", policy},
        std::pair{"X-Content-Type-Options", "nosniff"}, std::pair{"Referrer-Policy", "no-referrer"},
        std::pair{"Cache-Control", "no-store"},
        std::pair{"Cross-Origin-Resource-Policy", "same-origin"},
        std::pair{MHD_HTTP_HEADER_CONNECTION, "close"}})
    MHD_add_response_header(response, name, value);
  const MHD_Result result = MHD_queue_response(c, code, response);
  MHD_destroy_response(response);
  return result;
}

MHD_Result answer(ConnectionGuard& guard, MHD_Connection* c, unsigned code, const std::string& text,
                  const char* type, const char* policy) {
  MHD_Response* response = MHD_create_response_from_buffer(
      text.size(), const_cast<char*>(text.data()), MHD_RESPMEM_MUST_COPY);
  if (!response) return MHD_NO;
  guard.answered(socket_of(c), text.size());
  MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, type);
  return send_answer(c, code, response, policy);
}

}  // namespace framewatch::daemon
