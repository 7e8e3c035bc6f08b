#include "fleet/link/nats_objects.h"

#include <cstdlib>

#include <fmt/core.h>

namespace framewatch::fleet {

Message message_of(natsMsg* from) {
  Message out;
  out.subject = natsMsg_GetSubject(from);
  if (const char* reply = natsMsg_GetReply(from)) out.reply = reply;
  if (const int size = natsMsg_GetDataLength(from); size > 0) {
    const char* data = natsMsg_GetData(from);
    out.bytes.assign(data, data + size);
  }
  const char** names = nullptr;
  int count = 0;
  if (natsMsgHeader_Keys(from, &names, &count) == NATS_OK) {
    for (int i = 0; i < count; ++i)
      if (const char* value = nullptr; natsMsgHeader_Get(from, names[i], &value) == NATS_OK)
        out.headers[names[i]] = value;
    std::free(names);  // NOLINT: the library's rule
  }
  return out;
}

NatsMessage nats_message(const Message& from) {
  natsMsg* made = nullptr;
  if (natsMsg_Create(&made, from.subject.c_str(), from.reply.empty() ? nullptr : from.reply.c_str(),
                     reinterpret_cast<const char*>(from.bytes.data()),
                     static_cast<int>(from.bytes.size())) != NATS_OK)
    return nullptr;
  NatsMessage out(made);
  for (const auto& [name, value] : from.headers)
    if (natsMsgHeader_Set(out.get(), name.c_str(), value.c_str()) != NATS_OK) return nullptr;
  return out;
}

std::string last_error(natsStatus status) {
  const char* detail = nats_GetLastError(nullptr);
  const std::string text = natsStatus_GetText(status);
  return detail == nullptr || *detail == '\0' ? text : fmt::format("{}: {}", text, detail);
}

}  // namespace framewatch::fleet
