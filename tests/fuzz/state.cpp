// A state file that somebody changed and signed again: refused, or an estimation that goes on.
#include "daemon/base/file_digest.h"
#include "daemon/estimation/state_file.h"
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

/// Of an estimation that has seen the motion so far.
const std::vector<std::uint8_t>& good_state() {
  static const std::vector<std::uint8_t> state = [] {
    Estimation estimation(example_building(), {});
    ShakenNodes nodes;
    shake(estimation, nodes, kInstantsBefore);
    return daemon::state_bytes(example_building(), estimation, 0);
  }();
  return state;
}

void load_changed(Bytes input) {
  Pieces pieces(input);
  std::vector<std::uint8_t> state = changed(good_state(), pieces);
  const std::string digest = daemon::sha256({state.begin(), state.end()});
  state.insert(state.end(), digest.begin(), digest.end());
  const InputFile file(state);
  Estimation estimation(example_building(), [](auto...) {});
  bool touched = false;
  const daemon::LoadedState loaded =
      daemon::load_state(file.path(), example_building(), estimation, touched);
  if (!loaded.problem.empty() && touched) return;
  ShakenNodes nodes;
  nodes.shake(kInstantsBefore, [](const auto&) {});
  shake(estimation, nodes, kInstantsAfter);
  estimation.finish();
}

std::vector<std::string> state_seeds() {
  std::vector<std::string> out{""};
  for (std::uint32_t at = 100; at < good_state().size(); at += 997) {
    PiecesWriter seed;
    const std::uint8_t bytes8 = 5 * 3;
    out.push_back(seed.put(bytes8).put(at).put(1e300).text());
  }
  return out;
}

}  // namespace

const FuzzTarget kStateTarget{"state", &load_changed, &state_seeds};

}  // namespace framewatch::test
