#include "daemon/base/terminal_colour.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace framewatch::daemon {
namespace {

const char* escape_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "\x1b[32m";
    case Tone::doubtful:
      return "\x1b[33m";
    case Tone::bad:
      return "\x1b[31m";
    case Tone::strong:
      return "\x1b[1m";
  }
  return "";
}

}  // namespace

bool takes_colour(std::FILE* stream) {
  const char* const no_color = std::getenv("NO_COLOR");
  const char* const term = std::getenv("TERM");
  return (no_color == nullptr || *no_color == '\0') && term != nullptr &&
         std::string_view(term) != "dumb" && ::isatty(::fileno(stream)) == 1;
}

std::string toned(Tone tone, const std::string& text, std::FILE* stream) {
  return takes_colour(stream) ? escape_of(tone) + text + "\x1b[0m" : text;
}

}  // namespace framewatch::daemon
