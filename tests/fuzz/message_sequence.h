// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/fuzz/input.h"

namespace framewatch::test {

/// Gives the messages of an input to `take`: each is the number of one of `channels` and a payload,
/// whose fingerprint is that of the channel's type.
void take_messages(Pieces& input, const std::vector<std::string>& channels,
                   const std::function<void(const std::string& channel,
                                            const std::vector<std::uint8_t>& payload)>& take);

/// An input with these messages, by channel and whole payload; those of other channels are left
/// out.
std::string message_sequence(
    const std::vector<std::string>& channels,
    const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& messages);

/// One message of every type, by its channel.
std::vector<std::pair<std::string, std::vector<std::uint8_t>>> example_messages();

}  // namespace framewatch::test
