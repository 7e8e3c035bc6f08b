#include "daemon/tools/init/title_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<std::string_view, 10> kFloors = {"story", "storey", "floor", "level", "lvl",
                                                      "fl",    "f",      "s",     "l",     "a"};
constexpr std::array<std::string_view, 6> kBases = {"base",  "ground",     "gnd",
                                                    "table", "foundation", "shaketable"};
constexpr std::array<std::string_view, 2> kRoofs = {"roof", "top"};
constexpr std::array<std::string_view, 9> kFillers = {
    "acc", "accel", "acceleration", "abs", "absolute", "along", "dir", "direction", "axis"};
constexpr std::array<std::string_view, 4> kOrdinals = {"st", "nd", "rd", "th"};

template <std::size_t N>
bool is_one(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_number_word(std::string_view word) {
  return !word.empty() && std::isdigit(static_cast<unsigned char>(word.front()));
}

/// Runs of letters and of digits, lower case; a capital behind a small letter begins a new run, and
/// "basex" is "base" and "x". A run that follows the one before without anything between begins
/// with '+'.
std::vector<std::string> runs_of(const std::string& title) {
  std::vector<std::string> out;
  char before = ' ';
  for (const char c : title) {
    const auto byte = static_cast<unsigned char>(c);
    const auto last = static_cast<unsigned char>(before);
    if (std::isalnum(byte)) {
      const bool goes_on = std::isalnum(last) && !std::isdigit(byte) == !std::isdigit(last) &&
                           !(std::isupper(byte) && std::islower(last));
      if (!goes_on) out.emplace_back(std::isalnum(last) ? "+" : "");
      out.back() += static_cast<char>(std::tolower(byte));
    } else if (byte >= 0x80) {
      out.emplace_back("?");
    }
    before = c;
  }
  return out;
}

std::vector<std::string> split_joined(const std::vector<std::string>& runs) {
  std::vector<std::string> out;
  for (const std::string& run : runs) {
    const std::string_view word = std::string_view(run).substr(run.front() == '+' ? 1 : 0);
    const std::string_view stem = word.substr(0, word.size() - 1);
    const bool joined = word.size() > 2 && (word.back() == 'x' || word.back() == 'y') &&
                        (is_one(kBases, stem) || is_one(kRoofs, stem) || stem == "acc");
    out.push_back(joined ? run.substr(0, run.size() - 1) : run);
    if (joined) out.push_back(std::string("+") + word.back());
  }
  return out;
}

/// Walks over the words of one title.
class TitleWalk {
 public:
  explicit TitleWalk(const std::vector<std::string>& runs) {
    for (const std::string& run : runs) {
      joined_.push_back(run.front() == '+');
      words_.push_back(std::string_view(run).substr(run.front() == '+' ? 1 : 0));
    }
  }

  std::optional<TitleWords> walk() {
    while (at_ < words_.size())
      if (!step()) return std::nullopt;
    if (bare_a_ && out_.letter == 0)
      return std::nullopt;  // the number of a sensor, for all we know
    return out_;
  }

 private:
  std::string_view word(std::size_t ahead = 0) const {
    return at_ + ahead < words_.size() ? words_[at_ + ahead] : std::string_view();
  }
  bool joined(std::size_t ahead) const {
    return at_ + ahead < joined_.size() && joined_[at_ + ahead];
  }

  bool set_story(int story) {
    if (out_.story || out_.is_roof) return false;
    out_.story = story;
    return true;
  }

  bool step() {
    const std::string_view w = word();
    if (is_number_word(w)) return ordinal();
    if (w == "x" || w == "y") return letter(w.front());
    if (is_one(kFloors, w)) return floor(w);
    ++at_;
    if (is_one(kBases, w)) {
      if (word() == "floor" && !is_number_word(word(1))) ++at_;
      return set_story(0);
    }
    if (is_one(kRoofs, w)) {
      if (out_.story || out_.is_roof) return false;
      return out_.is_roof = true;
    }
    if (w == "frame") return out_.says_frame = true;
    return is_one(kFillers, w) && !is_number_word(word());
  }

  bool ordinal() {  // "2nd floor"
    const auto number = drivers::parse_integer(word());
    if (!number || *number > 1000 || !joined(1) || !is_one(kOrdinals, word(1)) ||
        !is_one(kFloors, word(2)) || word(2).size() < 3)
      return false;
    at_ += 3;
    return set_story(static_cast<int>(*number));
  }

  bool floor(std::string_view name) {
    const auto number = drivers::parse_integer(word(1));
    if (!number || *number > 1000 || (name.size() == 1 && !joined(1))) return false;
    bare_a_ = bare_a_ || name == "a";
    at_ += 2;
    return set_story(static_cast<int>(*number));
  }

  bool letter(char which) {
    const auto number = joined(1) ? drivers::parse_integer(word(1)) : std::nullopt;
    ++at_;
    if (!number) {
      if (out_.along != 0 || is_number_word(word())) return false;
      out_.along = which;
      return true;
    }
    if (out_.letter != 0 || *number > 1000) return false;
    out_.letter = which;
    out_.number = static_cast<int>(*number);
    ++at_;
    return true;
  }

  Words words_;
  std::vector<bool> joined_;
  std::size_t at_ = 0;
  bool bare_a_ = false;  ///< "A2": of an accelerometer, unless the rest says its frame
  TitleWords out_;
};

}  // namespace

std::optional<TitleWords> title_words(const std::string& title) {
  const std::vector<std::string> runs = split_joined(runs_of(title));
  if (runs.empty()) return std::nullopt;
  return TitleWalk(runs).walk();
}

}  // namespace framewatch::daemon
