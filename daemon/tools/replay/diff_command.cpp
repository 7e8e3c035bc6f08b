// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/diff_command.h"

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/json.h"
#include "daemon/base/printable.h"
#include "daemon/monitor/estimates/estimate_diff.h"
#include "drivers/files/input_file.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr int kDifferent = 1;

struct Estimate {
  std::vector<std::uint8_t> bytes;
  window_estimate_t message;
};

/// Reads the estimates of one log in order.
class EstimateReader {
 public:
  EstimateReader(std::string path, std::vector<std::string>& problems)
      : path_(std::move(path)), problems_(problems) {}

  bool open() {
    if (log_.open(path_)) return true;
    problems_.push_back(fmt::format("{}: {}", path_, log_.error()));
    return false;
  }

  /// Returns the channel and estimate that follow; nullopt at the end and after a problem.
  std::optional<std::pair<std::string, Estimate>> next() {
    for (;;) {
      const drivers::LogRead read = log_.next(event_);
      if (read == drivers::LogRead::end) return std::nullopt;
      if (read == drivers::LogRead::event) {
        if (auto found = decode()) return found;
        if (!problems_.empty()) return std::nullopt;
        continue;
      }
      problems_.push_back(read == drivers::LogRead::error
                              ? fmt::format("{}: {}", path_, log_.error())
                              : fmt::format("{}: byte {}: {}; `framewatch repair` copies the "
                                            "intact events",
                                            path_, log_.damage().offset, log_.damage().reason));
      return std::nullopt;
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  std::int64_t estimates() const { return estimates_; }
  const std::string& path() const { return path_; }

 private:
  /// Returns the estimate in event_, if it has one, and takes parameter names from it.
  std::optional<std::pair<std::string, Estimate>> decode() {
    const auto type = drivers::fingerprint(event_.data);
    if (type == parameter_table_t::getHash()) {
      if (const auto table = drivers::decoded<parameter_table_t>(event_.data)) names_ = table->name;
      return std::nullopt;
    }
    const char* by_channel = drivers::type_of_lcm_channel(event_.channel);
    const bool meant = by_channel != nullptr && by_channel == std::string("window_estimate_t");
    if (type != window_estimate_t::getHash() && !meant) return std::nullopt;
    auto message = drivers::decoded<window_estimate_t>(event_.data);
    if (!message) {
      problems_.push_back(fmt::format("{}: byte {}: {}: {}", path_, event_.offset, event_.channel,
                                      drivers::why_not("window_estimate_t", event_.data)));
      return std::nullopt;
    }
    ++estimates_;
    return std::pair(event_.channel, Estimate{event_.data, std::move(*message)});
  }

  std::string path_;
  std::vector<std::string>& problems_;
  drivers::LcmLogReader log_;
  drivers::LogEvent event_;
  std::vector<std::string> names_;
  std::int64_t estimates_ = 0;
};

struct Result {
  std::optional<EstimateDiff> diff;
  std::int64_t same_bytes = 0, only_a = 0, only_b = 0;
  std::int64_t first_only_us = 0;  ///< end of the first window that one log lacks
  bool tables_differ = false;
  bool same() const {
    return diff && diff->different() == 0 && same_bytes == diff->compared() && only_a == 0 &&
           only_b == 0 && !tables_differ;
  }
};

/// Pairs the windows of both logs, channel by channel, and compares them.
class Comparison {
 public:
  Comparison(EstimateReader& a, EstimateReader& b, Result& result)
      : a_(a), b_(b), result_(result) {}

  void run() {
    bool more_a = true, more_b = true;
    while (more_a || more_b) {
      more_a = more_a && take(a_, &Waiting::a);
      more_b = more_b && take(b_, &Waiting::b);
      // The other log has ended: these stay without a partner.
      for (auto& [channel, waiting] : waiting_) {
        for (; !more_b && !waiting.a.empty(); waiting.a.pop_front())
          only(waiting.a.front(), result_.only_a);
        for (; !more_a && !waiting.b.empty(); waiting.b.pop_front())
          only(waiting.b.front(), result_.only_b);
      }
    }
    if (!result_.diff) result_.diff.emplace(a_.names());
    result_.tables_differ = a_.names() != b_.names();
  }

 private:
  struct Waiting {
    std::deque<Estimate> a, b;
  };

  bool take(EstimateReader& reader, std::deque<Estimate> Waiting::*side) {
    auto next = reader.next();
    if (!next) return false;
    Waiting& waiting = waiting_[next->first];
    (waiting.*side).push_back(std::move(next->second));
    pair_up(next->first, waiting);
    return true;
  }

  void pair_up(const std::string& channel, Waiting& waiting) {
    while (!waiting.a.empty() && !waiting.b.empty()) {
      const Estimate& a = waiting.a.front();
      const Estimate& b = waiting.b.front();
      const std::int64_t of_a = a.message.window_end_us, of_b = b.message.window_end_us;
      if (of_a < of_b) {
        only(a, result_.only_a);
        waiting.a.pop_front();
      } else if (of_b < of_a) {
        only(b, result_.only_b);
        waiting.b.pop_front();
      } else {
        if (!result_.diff) result_.diff.emplace(a_.names());
        result_.same_bytes += a.bytes == b.bytes;
        result_.diff->compare(channel, a.message, b.message);
        waiting.a.pop_front();
        waiting.b.pop_front();
      }
    }
  }

  void only(const Estimate& e, std::int64_t& count) {
    if (result_.only_a + result_.only_b == 0 || e.message.window_end_us < result_.first_only_us)
      result_.first_only_us = e.message.window_end_us;
    ++count;
  }

  EstimateReader& a_;
  EstimateReader& b_;
  Result& result_;
  std::map<std::string, Waiting> waiting_;
};

/// Returns the offset of the first byte that differs; -1 if the files are identical.
std::int64_t first_different_byte(const std::string& a, const std::string& b) {
  drivers::InputFile files[2];
  std::vector<std::uint8_t> bytes[2];
  std::int64_t offset = 0, found = -1;
  bool readable = files[0].open(a) && files[1].open(b);
  while (readable && found < 0) {
    for (int i = 0; i < 2; ++i) {
      bytes[i].resize(1 << 20);
      const std::int64_t got = files[i].read(bytes[i].data(), std::ssize(bytes[i]), offset);
      readable = readable && got >= 0;
      bytes[i].resize(static_cast<std::size_t>(std::max<std::int64_t>(got, 0)));
    }
    const auto [at, other] =
        std::mismatch(bytes[0].begin(), bytes[0].end(), bytes[1].begin(), bytes[1].end());
    if (at != bytes[0].end() || other != bytes[1].end()) found = offset + (at - bytes[0].begin());
    if (bytes[0].empty()) break;
    offset += std::ssize(bytes[0]);
  }
  return found;
}

std::string seconds(std::int64_t time_us) {
  return fmt::format("{:.6f} s", static_cast<double>(time_us) * 1e-6);
}

std::string text_of(const FieldDifference& d) {
  return fmt::format("{} {} at {}: {:.17g} against {:.17g} ({:.3g} relative)", d.channel, d.field,
                     seconds(d.end_us), d.a, d.b, d.ratio());
}

void print_text(const Result& r, std::int64_t byte) {
  fmt::print("files: {}\n",
             byte < 0 ? "identical, byte by byte" : fmt::format("differ, first at byte {}", byte));
  fmt::print(
      "estimates: {} windows in both, {} identical byte by byte, {} differ; {} only in A, {} "
      "only in B\n",
      r.diff->compared(), r.same_bytes, r.diff->different(), r.only_a, r.only_b);
  if (r.only_a + r.only_b > 0)
    fmt::print("first window in only one of them: {}\n", seconds(r.first_only_us));
  if (r.tables_differ) fmt::print("parameters: the tables differ\n");
  for (const auto& [subject, fields] : r.diff->spans()) {
    const DifferenceSpan* worst = nullptr;
    const DifferenceSpan* first = nullptr;
    std::string list;
    for (const auto& [field, span] : fields) {
      list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", field, span.count);
      if (first == nullptr || span.first.end_us < first->first.end_us) first = &span;
      if (worst == nullptr || span.worst.ratio() > worst->worst.ratio()) worst = &span;
    }
    fmt::print("{}: {}\n  first: {}\n  worst: {}\n", printable(subject), printable(list),
               printable(text_of(first->first)), printable(text_of(worst->worst)));
  }
}

std::string json_of(const FieldDifference& d) {
  return fmt::format(
      "{{\"channel\": {}, \"window_end_us\": {}, \"a\": {}, \"b\": {}, \"ratio\": {}}}",
      json_text(d.channel), d.end_us, json_number(d.a), json_number(d.b), json_number(d.ratio()));
}

void print_json(const Result& r, std::int64_t byte) {
  fmt::print(
      "{{\"schema\": \"framewatch.diff/1\", \"same_estimates\": {}, \"same_files\": {}, "
      "\"first_different_byte\": {}, \"windows\": {}, \"identical\": {}, \"different\": {}, "
      "\"only_a\": {}, \"only_b\": {}, \"same_parameters\": {},\n \"differences\": [",
      r.same(), byte < 0, byte < 0 ? "null" : std::to_string(byte), r.diff->compared(),
      r.same_bytes, r.diff->different(), r.only_a, r.only_b, !r.tables_differ);
  const char* comma = "";
  for (const auto& [subject, fields] : r.diff->spans())
    for (const auto& [field, span] : fields) {
      fmt::print(
          "{}\n  {{\"subject\": {}, \"field\": {}, \"count\": {},\n   \"first\": {},\n   "
          "\"worst\": {}}}",
          comma, json_text(subject), json_text(field), span.count, json_of(span.first),
          json_of(span.worst));
      comma = ",";
    }
  fmt::print("]}}\n");
}

}  // namespace

int diff(const DiffArguments& arguments) {
  std::vector<std::string> problems;
  EstimateReader a(arguments.a, problems), b(arguments.b, problems);
  const bool opened_a = a.open(), opened_b = b.open();
  Result result;
  if (opened_a && opened_b) Comparison(a, b, result).run();
  for (const EstimateReader* reader : {&a, &b})
    if (problems.empty() && reader->estimates() == 0)
      problems.push_back(reader->path() + ": holds no window_estimate_t");
  for (const std::string& problem : problems)
    fmt::print(stderr, "framewatch diff: {}\n", printable_lines(problem));
  if (!problems.empty()) return kBadInput;
  const std::int64_t byte = first_different_byte(arguments.a, arguments.b);
  if (arguments.json)
    print_json(result, byte);
  else if (!arguments.quiet)
    print_text(result, byte);
  return result.same() ? 0 : kDifferent;
}

}  // namespace framewatch::daemon
