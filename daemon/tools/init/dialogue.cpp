// SPDX-License-Identifier: MIT
#include "daemon/tools/init/dialogue.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/tools/init/channel_questions.h"
#include "daemon/tools/init/questions.h"
#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

BuildingDraft first_draft(const InitAnswers& answers) {
  BuildingDraft d;
  d.record_arguments = answers.record;
  if (const auto at = answers.by_option.find("per-level"); at != answers.by_option.end())
    d.wanted_per_level = at->second;
  d.wants_points =
      std::any_of(answers.channels.begin(), answers.channels.end(),
                  [](const std::string& text) { return text.find('@') != std::string::npos; });
  d.plan.structure.stories = 1;
  d.plan.structure.frames_x = {"y1",
                               "y2"};  // default: most buildings have spans in both directions
  d.plan.structure.frames_y = {"x1", "x2"};
  return d;
}

constexpr const char* kChannel = "channel";

/// Returns the first three lines of a list of problems, and the number of the others.
std::string first_lines(const std::string& text) {
  constexpr int kMax = 3;
  std::size_t at = 0;
  for (int line = 0; line < kMax && at != std::string::npos; ++line) at = text.find('\n', at + 1);
  if (at == std::string::npos) return text;
  return fmt::format("{}\n  and {} more like it", text.substr(0, at),
                     std::count(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), '\n'));
}

/// One dialogue and its current state.
class Dialogue {
 public:
  Dialogue(InitAnswers answers, std::string path, const Remarks& remarks, ColumnCache& files,
           const Terminal& terminal)
      : answers_(std::move(answers)),
        path_(std::move(path)),
        remarks_(remarks),
        files_(files),
        terminal_(terminal) {}

  std::optional<BuildingPlan> run() {
    terminal_.say(fmt::format(
        "Your answers describe a building in {}. Enter takes the answer in [brackets], back "
        "returns to\nthe previous question, quit ends without a file.\n",
        printable(path_)));
    while (!left_) {
      const InitReading reading = read_answers(answers_, false, files_);
      tell_understood(reading);
      if (!reading.open.empty())
        ask(reading.open.front());
      else if (agreed(reading))
        return reading.draft.plan;
    }
    return std::nullopt;
  }

 private:
  /// Returns nullopt if the person leaves.
  std::string line() {
    terminal_.say("> ");
    const auto text = terminal_.read_line();
    if (!text || drivers::trimmed(*text) == "quit") {
      left_ = true;
      return "";
    }
    return std::string(drivers::trimmed(*text));
  }

  void tell_understood(const InitReading& reading) {
    for (const UnderstoodAnswer& u : reading.understood)
      if (u.option == asked_ && u.text != answers_.by_option[asked_])
        terminal_.say(fmt::format("  = {}\n", printable(u.text)));
    asked_.clear();
    for (const std::string& note : reading.draft.notes)
      if (std::find(told_.begin(), told_.end(), note) == told_.end()) {
        terminal_.say(fmt::format("  {}\n", printable(note)));
        told_.push_back(note);
      }
  }

  void ask(const OpenQuestion& question) {
    if (!question.problem.empty()) {
      terminal_.say(fmt::format("  Please answer again: {}\n",
                                printable_lines(first_lines(question.problem))));
      if (question.answer.empty())
        forget(question.option);
      else
        std::erase(answers_.channels, question.answer);
      return;
    }
    const auto before = before_.find(question.option);
    const std::string initial = before != before_.end() ? before->second : question.initial;
    terminal_.say(fmt::format("\n{}{}\n", printable_lines(question.ask),
                              initial.empty() ? "" : fmt::format(" [{}]", printable(initial))));
    std::string answer = line();
    if (left_) return;
    if (answer == "back") return go_back();
    if (answer.empty()) answer = initial;
    if (answer.empty()) return terminal_.say("  This question has no default answer.\n");
    take(question, answer);
  }

  void take(const OpenQuestion& question, const std::string& answer) {
    history_.push_back(question.option);
    if (!question.column.empty()) {
      answers_.channels.push_back(question.column + "=" + answer);
      return;
    }
    if (question.place) {
      const InitReading reading = read_answers(answers_, false, files_);
      answers_.channels.push_back(answer + "=" +
                                  place_option(reading.draft.plan.structure, *question.place));
      return;
    }
    answers_.by_option[question.option] = answer;
    before_.erase(question.option);
    asked_ = question.option;
  }

  void forget(const std::string& option) {
    if (option == kChannel) {
      if (!answers_.channels.empty()) answers_.channels.pop_back();
    } else {
      answers_.by_option.erase(option);
    }
    if (!history_.empty() && history_.back() == option) history_.pop_back();
  }

  void go_back() {
    if (history_.empty()) return terminal_.say("  This is the first question.\n");
    forget(std::string(history_.back()));
  }

  bool agreed(const InitReading& reading) {
    terminal_.say("\nUnderstood:\n" + summary_text(reading));
    const std::string remarks = remarks_(reading.draft.plan);
    if (!remarks.empty()) terminal_.say("\nPlease check:\n" + remarks);
    terminal_.say(
        fmt::format("\nEnter writes {}; a number changes that answer; quit ends without a file.\n",
                    printable(path_)));
    const std::string answer = line();
    if (left_) return false;
    if (answer.empty()) return true;
    const auto number = drivers::parse_integer(answer);
    if (!number || *number < 1 || *number > static_cast<std::int64_t>(reading.understood.size()))
      terminal_.say("  Type a number of the list, Enter or quit.\n");
    else
      change(reading.understood[static_cast<std::size_t>(*number - 1)].option);
    return false;
  }

  void change(const std::string& option) {
    if (option != kChannel) {
      before_[option] = answers_.by_option[option];
      answers_.by_option.erase(option);
      return;
    }
    terminal_.say(
        "\nWrite NAME=PLACE, such as acc3=2:y1, or base_x=0:x for the base. For a station, write "
        "ch3=2, ch3=roof:x or ch3=unused.\n");
    const std::string answer = line();
    if (answer.empty()) return;
    const std::size_t equals = answer.rfind('=');
    std::erase_if(answers_.channels,
                  [&](const std::string& other) {  // answers about the same column or place
                    const std::size_t at = other.rfind('=');
                    return equals != std::string::npos && at != std::string::npos &&
                           (other.substr(0, at) == answer.substr(0, equals) ||
                            other.substr(at) == answer.substr(equals));
                  });
    answers_.channels.push_back(answer);
  }

  InitAnswers answers_;
  std::string path_;
  const Remarks& remarks_;
  ColumnCache& files_;
  const Terminal& terminal_;
  std::vector<std::string> history_;           ///< options in the order of the answers
  std::map<std::string, std::string> before_;  ///< previous values of answers being changed
  std::vector<std::string> told_;
  std::string asked_;  ///< the last question
  bool left_ = false;
};

}  // namespace

InitReading read_answers(const InitAnswers& answers, bool take_defaults, ColumnCache& files) {
  InitReading out;
  out.draft = first_draft(answers);
  BuildingDraft& d = out.draft;
  for (const InitQuestion& question : init_questions()) {
    const auto answer = answers.by_option.find(question.option);
    const bool answered = answer != answers.by_option.end();
    if (!question.applies(d)) {
      if (answered && take_defaults)
        out.open.push_back({question.option, "", "", "does not fit the other answers", {}});
      continue;
    }
    const std::string initial = question.initial(d);
    if (!answered && (initial.empty() || !take_defaults)) {
      out.open.push_back({question.option, question.ask(d), initial, "", {}});
      if (!take_defaults) return out;
      continue;
    }
    const std::string problem = question.take(answered ? answer->second : initial, d, files);
    if (!problem.empty())
      out.open.push_back({question.option, question.ask(d), initial, problem, {}});
    else if (out.open.empty())
      out.understood.push_back({question.option, question.title, question.understood(d)});
    if (!take_defaults && !out.open.empty()) return out;
  }
  if (out.open.empty()) place_channels(answers, out);
  return out;
}

std::string summary_text(const InitReading& reading) {
  std::string out;
  int number = 0;
  for (const UnderstoodAnswer& u : reading.understood)
    out += fmt::format("{:>3}  {:<19} {}\n", ++number, u.title, printable_lines(u.text));
  return out;
}

std::optional<BuildingPlan> ask_building(InitAnswers answers, const std::string& path,
                                         const Remarks& remarks, ColumnCache& files,
                                         const Terminal& terminal) {
  return Dialogue(std::move(answers), path, remarks, files, terminal).run();
}

}  // namespace framewatch::daemon
