#pragma once

#include <string>

namespace framewatch::fleet {

/// "FILE expired: ..." when the certificate (PEM) is over, by openssl(1) and the host's clock; else
/// empty, also when it cannot be read. A hub that refuses it says nothing that reaches us.
std::string expired(const std::string& certificate);

}  // namespace framewatch::fleet
