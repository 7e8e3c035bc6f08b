#pragma once

#include <microhttpd.h>

#include <cstddef>
#include <string>

#include "daemon/page/web/web_admission.h"

namespace framewatch::daemon {

class ConnectionGuard;

/// What may be loaded by a page, and by a report, which has its own styles and no script.
inline constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' "
    "data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
inline constexpr const char* kReportPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action "
    "'none'; frame-ancestors 'none'; sandbox";
inline constexpr const char* kPlainText = "text/plain; charset=utf-8";

int socket_of(MHD_Connection* connection);

/// A header, cookie or argument of the request; empty: there is none.
std::string header(MHD_Connection* connection, const char* name,
                   MHD_ValueKind kind = MHD_HEADER_KIND);
int count_of_header(MHD_Connection* connection, const char* name);
/// What decides on its admission; the token may be in a cookie of this name.
WebRequest web_request(MHD_Connection* connection, const std::string& method,
                       const std::string& path, const char* cookie);
/// The address that a request came from; behind a proxy the proxy's.
std::string viewer_of(MHD_Connection* connection);

/// Sends `response`, which is released, and ends the connection with it: a connection carries one
/// request, so that nothing hides behind its first one.
MHD_Result send_answer(MHD_Connection* connection, unsigned code, MHD_Response* response,
                       const char* policy = kPagePolicy);
/// The same of a text, of which the guard is told.
MHD_Result answer(ConnectionGuard& guard, MHD_Connection* connection, unsigned code,
                  const std::string& text, const char* type, const char* policy = kPagePolicy);

}  // namespace framewatch::daemon
