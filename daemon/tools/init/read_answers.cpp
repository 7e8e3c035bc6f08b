#include "daemon/tools/init/read_answers.h"

#include "daemon/tools/init/channel_questions.h"
#include "daemon/tools/init/questions.h"

namespace framewatch::daemon {
namespace {

BuildingDraft first_draft(const InitAnswers& answers) {
  BuildingDraft d;
  d.record_arguments = answers.record;
  d.plan.structure.stories = 1;
  d.plan.structure.frames_x = {"y1", "y2"};  // until it is answered: most have spans both ways
  d.plan.structure.frames_y = {"x1", "x2"};
  return d;
}

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
        out.open.push_back({question.option, "", "", "does not apply to what else was said", {}});
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

}  // namespace framewatch::daemon
