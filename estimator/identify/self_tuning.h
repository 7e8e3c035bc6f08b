#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/channel_noise.h"
#include "estimator/identify/design.h"
#include "estimator/identify/machine.h"

namespace framewatch {

/// Looks whether the row filters still fit what was identified and, when they do not, tunes a
/// second machine, lets it catch up through the motion ring and hands it over. All of it in slices,
/// a fixed amount of work per instant, in memory taken at the start.
class SelfTuning {
 public:
  /// spare: like the machine in service. fill: instants a motion needs to become valid.
  /// noise_known: see below, of the first machine.
  SelfTuning(const FloorLayout& layout, const ParameterTable& table, std::unique_ptr<Machine> spare,
             int blocks, int fill, bool noise_known);

  /// Instants the ring must hold for a machine that needs `warm_up` of them.
  static int ring_rows(int warm_up) { return 2 * warm_up + 2; }

  /// Input broke off: what was under way is given up.
  void restart() { phase_ = Phase::idle; }
  /// Once per completed pass of batch means: whether the filters should be looked at now. Every
  /// time until they were found right, then once a window.
  bool due();
  /// What the window says, internal order, relative to the machine's design; shown: whether it
  /// shows the unknown. noise: rows weighted by another one are formed anew.
  void look(const Machine& active, const std::vector<double>& ratio,
            const std::vector<double>& std_error, const std::vector<std::uint8_t>& shown,
            const ChannelNoise& noise);
  /// One instant's share of the work. True when `active` was exchanged for the newly tuned machine;
  /// before() is then the one that served.
  bool step(std::unique_ptr<Machine>& active, const MotionRing& ring);
  const Machine& before() const { return *spare_; }

  /// The noise that the machine in service weighs its rows by is known, of every axis.
  bool noise_known() const { return noise_known_; }
  /// A look has found the filters right.
  bool tuned() const { return tuned_; }
  std::int64_t retunes() const { return retunes_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(*spare_, phase_, tuned_, next_floor_, passes_, since_look_, detuning_, noise_known_);
    a(noise_measured_, noise_differs_, noise_, retunes_, design_);
  }

 private:
  enum class Phase { idle, looking, tuning, catching_up };
  void look_at_floors(Machine& active);
  void tune_floors(const MotionRing& ring);
  bool catch_up(const Machine& active, const MotionRing& ring);

  FloorLayout layout_;
  ParameterTable table_;
  std::unique_ptr<Machine> spare_;
  int blocks_, fill_, floors_per_instant_, catch_up_per_instant_;
  Phase phase_ = Phase::idle;
  bool tuned_ = false;
  int next_floor_ = 0, passes_ = 0, since_look_ = 0;
  double detuning_ = 0;
  bool noise_known_;
  bool noise_measured_ = false;  ///< noise_ is known of every axis
  bool noise_differs_ = false;
  std::vector<double> noise_;
  std::int64_t retunes_ = 0;
  RetuningWork work_;
  Eigen::VectorXd design_;
};

}  // namespace framewatch
