// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/monitor/actions/notifier.h"

namespace framewatch::daemon {

struct EmailAttachment {
  std::string name, type, bytes;  ///< type: "image/png"
};

/// A message in plain text. All texts may hold any characters; lines of `body` end with "\n".
struct Email {
  std::string subject, body;
  /// Identifies the message and the event that it is about, so that a mail server drops a message
  /// that came twice and mail programs show the messages of an event together.
  std::string id, thread;
  std::vector<EmailAttachment> attachments = {};
};

/// Sends an e-mail to one address once, by SMTP. Sets `retry` unless the server refuses for good
/// (5xx) or the settings cannot work; then `trouble` says what to mend. `answer` is the last reply
/// of the server.
DeliveryResult send_email(const EmailSettings& settings, const std::string& to, const Email& email,
                          const Abandoned& abandoned);

/// Sends an e-mail to several people, each by one message, so that the refusal of one address does
/// not keep the others from being told. A repetition leaves out those who have it already.
class EmailRound {
 public:
  /// Sends the e-mail to all `people` who do not have it. The result is `partly` if it reached
  /// somebody and the others were refused for good.
  DeliveryResult send(const EmailSettings& settings, const std::vector<std::string>& people,
                      const Email& email, const Abandoned& abandoned);

 private:
  std::string id_;                              ///< of the e-mail that the members below belong to
  std::set<std::string> done_;                  ///< addresses that have it
  std::map<std::string, std::string> refused_;  ///< why an address does not get it
};

/// Returns the e-mail about an event: a text with the message and what to do, and the name of its
/// subject. Without attachments.
Email event_email(const event_t& event, const std::string& building);

/// Returns a text as the value of a header: characters beyond ASCII are encoded (RFC 2047), line
/// breaks and other control characters are escaped.
std::string header_value(const std::string& text);

}  // namespace framewatch::daemon
