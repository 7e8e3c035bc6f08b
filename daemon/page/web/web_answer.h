// SPDX-License-Identifier: MIT
#pragma once

#include <microhttpd.h>

#include <string>

#include "daemon/page/web/web_admission.h"

namespace framewatch::daemon {

class ConnectionGuard;

/// Content security policies: for the page, and for reports, which have inline styles and no
/// scripts.
inline constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' "
    "data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
inline constexpr const char* kReportPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action "
    "'none'; frame-ancestors 'none'; sandbox";
inline constexpr const char* kPlainText = "text/plain; charset=utf-8";

int socket_of(MHD_Connection* connection);

/// Returns a header, cookie or argument of the request; empty if it is missing.
std::string header(MHD_Connection* connection, const char* name,
                   MHD_ValueKind kind = MHD_HEADER_KIND);
int count_of_header(MHD_Connection* connection, const char* name);
/// Returns the parts of the request that admit() checks. cookie: name of the token's cookie.
WebRequest web_request(MHD_Connection* connection, const std::string& method,
                       const std::string& path, const char* cookie);
/// Returns the address that the request came from; behind a proxy, the proxy's.
std::string viewer_of(MHD_Connection* connection);

/// Sends and releases `response`, then ends the connection. A connection carries one request, so
/// that no other request can hide behind it.
MHD_Result send_answer(MHD_Connection* connection, unsigned code, MHD_Response* response,
                       const char* policy = kPagePolicy);
/// Sends a text as send_answer() does and reports it to `guard`.
MHD_Result answer(ConnectionGuard& guard, MHD_Connection* connection, unsigned code,
                  const std::string& text, const char* type, const char* policy = kPagePolicy);

}  // namespace framewatch::daemon
