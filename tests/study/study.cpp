// SPDX-License-Identifier: MIT
// diagnose_study: seeded cases for `framewatch diagnose`, and its results for them.
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "tests/study/practice.h"
#include "tests/study/sensitivity.h"
#include "tests/study/study_case.h"
#include "tests/study/study_score.h"

namespace framewatch::study {
namespace {

constexpr const char* kUsage =
    R"(usage: diagnose_study generate DIR [--each N] [--seed N] [--seconds S] [--building KIND]
                               [--group GROUP] [--effect NAME] [--flicker PERCENT]
                               [--mass-damping PERCENT]
       diagnose_study practice DIR [--data FOLDER]
       diagnose_study run DIR --program FRAMEWATCH [--taken-out N]
       diagnose_study table DIR
       diagnose_study sensitivity DIR --program FRAMEWATCH [--setting NAME]

generate  writes cases: config.toml, train.csv.gz, holdout.csv.gz, truth.json. Each effect N times (1)
          per building, noise 1, 2, 5 % in turn. Groups: catalogue, nothing (10 N per building),
          other_form, outside, two_effects (6 N per building), three_effects (3 N). Cases have mass
          damping (--mass-damping: ratio of the first mode, over 1 %; 20), noise that grows toward
          low frequencies (--flicker: share of its power; 30), and small errors of masses, gains
          and clocks.
practice  imports the practice cases of FOLDER (default: in the data folder), made with another program
run       runs `framewatch diagnose` on every case without a diagnosis, and the first N (0) of every
          effect and building again with the effect removed from the catalogue
table     prints rates, confusion, gaps and requirements of all finished cases as Markdown; exits
          with 1 if there is no case or a requirement is missed
sensitivity  diagnoses every case with each number of the search (or that called NAME) half and twice
          as large, and prints which results differ from the usual ones as Markdown
)";

struct Arguments {
  std::string action, directory;
  std::map<std::string, std::string> options;

  std::string text(const std::string& key, const std::string& usual) const {
    const auto at = options.find(key);
    return at == options.end() ? usual : at->second;
  }
  long number(const std::string& key, long usual) const {
    return std::strtol(text(key, std::to_string(usual)).c_str(), nullptr, 10);
  }
};

double percent(const Arguments& a, const std::string& key, double usual) {
  return a.options.contains(key) ? 0.01 * static_cast<double>(a.number(key, 0)) : usual;
}

struct Wanted {
  std::string group, name;
};

/// False for effects that equal a lower stiffness, and for those that belong to the linear model.
bool can_be_found(estimator::EffectKind kind) {
  return kind != estimator::EffectKind::p_delta && kind != estimator::EffectKind::modal_damping;
}

std::vector<Wanted> wanted_cases(long each) {
  std::vector<Wanted> out;
  for (long i = 0; i < each; ++i) {
    for (const estimator::EffectDescription& d : estimator::effect_catalogue())
      if (can_be_found(d.kind)) out.push_back({"catalogue", std::string(d.name)});
    for (const std::string& name : other_forms()) out.push_back({"other_form", name});
    for (const std::string& name : outsiders()) out.push_back({"outside", name});
    for (int n = 0; n < 10; ++n) out.push_back({"nothing", "none"});
    for (const char* pair : {"cubic_stiffness+gain_error", "bouc_wen+time_shift",
                             "coulomb_friction+stiffness_drop", "tuned_mass_damper+two_sided_gap",
                             "quadratic_damping+extra_mass", "unmeasured_force+cubic_stiffness"})
      out.push_back({"two_effects", pair});
    for (const char* three :
         {"cubic_stiffness+gain_error+extra_mass", "bouc_wen+time_shift+tuned_mass_damper",
          "coulomb_friction+two_sided_gap+gain_error"})
      out.push_back({"three_effects", three});
  }
  return out;
}

/// Makes a case. Tries less noise, and finally another building, if the effect does not exceed the
/// noise.
std::optional<StudyCase> make_showing(const Wanted& wanted, CaseOptions options, std::size_t noise,
                                      std::string& why) {
  constexpr double kNoise[] = {0.01, 0.02, 0.05};
  constexpr std::uint64_t kOtherSeed = 50000;
  for (const std::uint64_t more : {std::uint64_t{0}, kOtherSeed}) {
    options.seed += more;
    for (std::size_t level = noise + 1; level-- > 0;) {
      options.noise_ratio = kNoise[level];
      auto made = make_case(wanted.group, wanted.name, options, why);
      if (made) return made;
    }
  }
  return std::nullopt;
}

int generate(const Arguments& a) {
  int written = 0, skipped = 0;
  std::uint64_t number = 0;
  for (const std::string& building : building_kinds()) {
    for (const Wanted& wanted : wanted_cases(a.number("--each", 1))) {
      ++number;
      if (a.text("--building", building) != building ||
          a.text("--group", wanted.group) != wanted.group ||
          a.text("--effect", wanted.name) != wanted.name)
        continue;
      CaseOptions options;
      options.building = building;
      options.seconds = static_cast<double>(a.number("--seconds", 60));
      options.flicker_share = percent(a, "--flicker", options.flicker_share);
      options.mass_damping = percent(a, "--mass-damping", options.mass_damping);
      options.seed = static_cast<std::uint64_t>(a.number("--seed", 1)) * 100000 + number;
      std::string why;
      const auto made = make_showing(wanted, options, number % 3, why);
      std::string name = fmt::format("{:04d}-{}-{}", number, building, wanted.name);
      std::replace(name.begin(), name.end(), ' ', '_');
      if (!made) {
        ++skipped;
        fmt::print(stderr, "{}: skipped: {}\n", name, why);
        continue;
      }
      if (!write_case(*made, a.directory + "/" + name, why)) {
        fmt::print(stderr, "{}: {}\n", name, why);
        return 2;
      }
      ++written;
      fmt::print(stderr, "{}: gap {:.1f} times the noise floor\n", name, made->gap_over_floor);
    }
  }
  fmt::print("{} cases, {} skipped\n", written, skipped);
  return written > 0 ? 0 : 1;
}

std::vector<std::string> cases(const std::string& directory) {
  std::vector<std::string> out;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(directory, code))
    if (std::filesystem::exists(entry.path() / "truth.json")) out.push_back(entry.path().string());
  std::sort(out.begin(), out.end());
  return out;
}

int practice(const Arguments& a) {
  const char* data = std::getenv("FRAMEWATCH_DATA");
  const std::filesystem::path folder =
      a.text("--data", std::string(data ? data : FRAMEWATCH_DATA_DEFAULT) + "/practice");
  int imported = 0;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code)) {
    if (!entry.is_directory()) continue;
    const std::string name = entry.path().filename().string();
    std::string error;
    if (!import_practice(entry.path().string(), a.directory + "/" + name, error)) {
      fmt::print(stderr, "{}\n", error);
      return 2;
    }
    ++imported;
  }
  fmt::print("{} cases\n", imported);
  return imported > 0 ? 0 : 1;
}

std::string log_of(const std::string& directory, const std::string& folder) {
  return directory + (folder == "out" ? "/log.txt" : "/log-" + folder + ".txt");
}

/// Diagnoses one case unless its diagnosis exists. The log has another name until the case is done.
void diagnose_case(const std::string& program, const std::string& directory,
                   const std::string& folder, const std::string& more) {
  if (std::filesystem::exists(directory + "/" + folder + "/diagnosis.json")) return;
  const std::string log = log_of(directory, folder), running = log + ".running";
  const std::string command = fmt::format(
      "'{0}' diagnose '{1}/config.toml' --limit 0 --train '{1}/train.csv.gz' --holdout "
      "'{1}/holdout.csv.gz' --out '{1}/{2}' --quiet {3} >'{4}' 2>&1",
      program, directory, folder, more, running);
  const int status = std::system(command.c_str());
  std::error_code code;
  std::filesystem::rename(running, log, code);
  const bool done = WIFEXITED(status) && WEXITSTATUS(status) <= 1;  // 1: a gap remains
  fmt::print(stderr, "{}/{}: {}\n", directory, folder, done ? "done" : "not done, see " + log);
}

int run(const Arguments& a) {
  const std::string program = a.text("--program", "framewatch");
  const long taken_out = a.number("--taken-out", 0);
  std::map<std::string, long> seen;
  const std::vector<std::string> all = cases(a.directory);
  if (all.empty()) {
    fmt::print(stderr, "no cases in {}\n", a.directory);
    return 2;
  }
  for (const std::string& directory : all) {
    diagnose_case(program, directory, "out", "");
    const auto outcome = score(directory);
    if (outcome && outcome->group == "catalogue" &&
        seen[outcome->building + outcome->hidden]++ < taken_out)
      diagnose_case(program, directory, kTakenOut, "--without " + outcome->hidden);
  }
  return 0;
}

int table(const Arguments& a) {
  std::vector<Outcome> outcomes;
  int waiting = 0;
  for (const std::string& directory : cases(a.directory)) {
    if (!std::filesystem::exists(directory + "/log.txt"))
      ++waiting;
    else if (const auto outcome = score(directory))
      outcomes.push_back(*outcome);
    if (!std::filesystem::exists(log_of(directory, kTakenOut))) continue;
    if (const auto outcome = score(directory, kTakenOut)) outcomes.push_back(*outcome);
  }
  fmt::print("{}", tables(outcomes));
  if (waiting > 0) fmt::print("\n{} cases have not been run.\n", waiting);
  const std::vector<Bound> bounds = bounds_of(outcomes);
  const bool good =
      std::all_of(bounds.begin(), bounds.end(), [](const Bound& b) { return b.holds; });
  return good && !outcomes.empty() ? 0 : 1;
}

int sensitivity(const Arguments& a) {
  const std::string program = a.text("--program", "framewatch"), only = a.text("--setting", "");
  const std::vector<std::string> all = cases(a.directory);
  const std::vector<ChangedSetting> changed = changed_settings(only);
  if (all.empty()) fmt::print(stderr, "no cases in {}\n", a.directory);
  if (changed.empty()) fmt::print(stderr, "the search has no number called {}\n", only);
  if (all.empty() || changed.empty()) return 2;
  for (const std::string& directory : all) diagnose_case(program, directory, "out", "");
  for (const ChangedSetting& one : changed)
    for (const std::string& directory : all)
      diagnose_case(program, directory, one.text(), "--setting " + one.text());
  fmt::print("{}", sensitivity_table(all, only));
  return 0;
}

}  // namespace

int main_of(int argc, char** argv) {
  Arguments a;
  if (argc >= 3) a = {argv[1], argv[2], {}};
  for (int i = 1; i < argc; ++i)
    if (argv[i] == std::string("--help")) {
      fmt::print("{}", kUsage);
      return 0;
    }
  bool good = argc >= 3 && argc % 2 == 1;
  for (int i = 3; i + 1 < argc; i += 2) {
    const std::string key = argv[i];
    const std::vector<std::string> known{"--each",      "--seed",    "--seconds",      "--building",
                                         "--group",     "--effect",  "--program",      "--data",
                                         "--taken-out", "--flicker", "--mass-damping", "--setting"};
    good = good && std::find(known.begin(), known.end(), key) != known.end();
    a.options[key] = argv[i + 1];
  }
  if (good && a.action == "generate") return generate(a);
  if (good && a.action == "practice") return practice(a);
  if (good && a.action == "run") return run(a);
  if (good && a.action == "table") return table(a);
  if (good && a.action == "sensitivity") return sensitivity(a);
  fmt::print(stderr, "{}", kUsage);
  return 2;
}

}  // namespace framewatch::study

int main(int argc, char** argv) {
  return framewatch::study::main_of(argc, argv);
}
