#pragma once

#include <memory>
#include <string>

#include <nats/nats.h>

#include "fleet/message/message.h"

namespace framewatch::fleet {

// Objects of the library, destroyed when their owner is.
template <class Type, void (*destroy)(Type*)>
struct NatsDestroyer {
  void operator()(Type* object) const { destroy(object); }
};
using NatsOptions = std::unique_ptr<natsOptions, NatsDestroyer<natsOptions, natsOptions_Destroy>>;
using NatsConnection =
    std::unique_ptr<natsConnection, NatsDestroyer<natsConnection, natsConnection_Destroy>>;
using NatsSubscription =
    std::unique_ptr<natsSubscription, NatsDestroyer<natsSubscription, natsSubscription_Destroy>>;
using NatsMessage = std::unique_ptr<natsMsg, NatsDestroyer<natsMsg, natsMsg_Destroy>>;

/// A message of the library as ours, and the other way round; null for want of memory.
Message message_of(natsMsg* from);
NatsMessage nats_message(const Message& from);

/// What the library says of a failure on this thread.
std::string last_error(natsStatus status);

}  // namespace framewatch::fleet
