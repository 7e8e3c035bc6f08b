// SPDX-License-Identifier: MIT
// A state file with one changed section and a matching signature: the section is refused, or the
// estimation continues with it.
#include <optional>

#include "daemon/monitor/estimation/state_file.h"
#include "tests/fuzz/example_building.h"
#include "tests/fuzz/shaken.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

using daemon::Estimation;

constexpr int kInstantsBefore = 200, kInstantsAfter = 20;

void shake(Estimation& estimation, ShakenNodes& nodes, int instants) {
  nodes.shake(instants, [&](const auto& bytes) {
    (void)estimation.message("ACCEL", bytes.data(), bytes.size());
  });
}

/// Returns the state of an estimation that has seen the motion so far.
const daemon::SavedState& good_state() {
  static const daemon::SavedState state = [] {
    Estimation estimation(example_building(), {});
    ShakenNodes nodes;
    shake(estimation, nodes, kInstantsBefore);
    return daemon::saved_state(example_building(), estimation, 0);
  }();
  return state;
}

void load_changed(Bytes input) {
  Pieces pieces(input);
  daemon::SavedState state = good_state();
  std::vector<std::uint8_t>& section =
      state.sections[pieces.take<std::uint8_t>() % state.sections.size()].bytes;
  section = changed(section, pieces);
  const InputFile file(daemon::state_bytes(state));
  const auto ignore = [](auto...) {};
  std::optional<Estimation> estimation(std::in_place, example_building(), ignore);
  const daemon::LoadedState loaded = daemon::load_what_fits(
      file.path(), example_building(), *estimation,
      [&]() -> Estimation& { return estimation.emplace(example_building(), ignore); });
  require(loaded.problem.empty(), "a file with a sound head is read");
  ShakenNodes nodes;
  nodes.shake(kInstantsBefore, [](const auto&) {});
  shake(*estimation, nodes, kInstantsAfter);
  estimation->finish();
}

std::vector<std::string> state_seeds() {
  std::vector<std::string> out{""};
  for (std::size_t s = 0; s < good_state().sections.size(); ++s)
    for (std::uint32_t at = 8; at < good_state().sections[s].bytes.size(); at += 997) {
      PiecesWriter seed;
      const std::uint8_t bytes8 = 5 * 3;
      out.push_back(seed.put(static_cast<std::uint8_t>(s)).put(bytes8).put(at).put(1e300).text());
    }
  return out;
}

}  // namespace

const FuzzTarget kStateTarget{"state", &load_changed, &state_seeds};

}  // namespace framewatch::test
