#pragma once

#include <cstdio>
#include <string>

namespace framewatch::daemon {

enum class Tone { good, doubtful, bad, strong };

/// Whether colours are for this stream: a terminal that has them (TERM is not "dumb"), and the
/// variable NO_COLOR is not set, or empty (https://no-color.org).
bool takes_colour(std::FILE* stream);

/// The text in the tone's colour when the stream takes colours, else the text. Its escapes are none
/// of printable()'s business: what comes from outside is made printable before.
std::string toned(Tone tone, const std::string& text, std::FILE* stream);

}  // namespace framewatch::daemon
