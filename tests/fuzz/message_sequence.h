// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/fuzz/input.h"

namespace framewatch::test {

/// Passes the messages of an input to `take`: each is the number of one of `channels` and a
/// payload with the fingerprint of the channel's type.
void take_messages(Pieces& input, const std::vector<std::string>& channels,
                   const std::function<void(const std::string& channel,
                                            const std::vector<std::uint8_t>& payload)>& take);

/// Returns an input with these messages, by channel and whole payload. Messages of other channels
/// are left out.
std::string message_sequence(
    const std::vector<std::string>& channels,
    const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& messages);

/// Returns one message of every type, by its channel.
std::vector<std::pair<std::string, std::vector<std::uint8_t>>> example_messages();

}  // namespace framewatch::test
