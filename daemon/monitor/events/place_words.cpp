#include "daemon/monitor/events/place_words.h"

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

struct PlaceOfName {
  char quantity = 'k', direction = 'x';
  std::string stories;  ///< "story 1", "stories 6 to 12", "floor 2"; empty: of the building
  std::string where;    ///< frames or panel; empty: all of a direction
};

PlaceOfName place_of(const std::string& name) {
  PlaceOfName out;
  const std::size_t at = name.find('_');
  out.quantity = name.empty() ? 'k' : name.front();
  out.direction =
      at == 0 || name.empty() ? 'x' : name[at == std::string::npos ? name.size() - 1 : at - 1];
  if (at == std::string::npos) return out;
  const std::size_t next = name.find('_', at + 1);
  const std::string stories = name.substr(at + 1, next == std::string::npos ? next : next - at - 1);
  const std::size_t to = stories.find("to");
  out.stories = to != std::string::npos
                    ? fmt::format("stories {} to {}", stories.substr(0, to), stories.substr(to + 2))
                    : (out.quantity == 'G' ? "floor " : "story ") + stories;
  if (next != std::string::npos) out.where = name.substr(next + 1);
  return out;
}

const char* frame_word(const PlaceOfName& place) {
  return place.where.find('+') == std::string::npos ? "frame" : "frames";
}

}  // namespace

std::string place_words(const std::string& parameter) {
  const PlaceOfName p = place_of(parameter);
  if (p.stories.empty()) return fmt::format("frames along {}", p.direction);
  if (p.where.empty()) return fmt::format("{}, along {}", p.stories, p.direction);
  return fmt::format("{}, {} {}", p.stories, p.quantity == 'G' ? "panel" : frame_word(p), p.where);
}

std::string element_words(const std::string& parameter) {
  const PlaceOfName p = place_of(parameter);
  if (p.stories.empty()) return fmt::format("bending of frames along {}", p.direction);
  if (p.where.empty()) return fmt::format("{} along {}", p.stories, p.direction);
  return fmt::format("{} {} of {}", p.quantity == 'G' ? "floor panel" : frame_word(p), p.where,
                     p.stories);
}

}  // namespace framewatch::daemon
