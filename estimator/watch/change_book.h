// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/structure/parameter_table.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/change_detector.h"
#include "estimator/watch/change_record.h"
#include "estimator/watch/change_size.h"
#include "estimator/watch/window_history.h"

namespace framewatch::estimator {

/// The part of a deviation that the conditions may explain, and its standard error, relative to the
/// baseline.
struct Explained {
  double off = 0, std_error = 0;
};

/// Finds lasting changes in the windows of every length and keeps the one record of each
/// (docs/equations.md, changes).
///
/// Detectors find that an element changes, and its record begins in
/// state changing. While windows straddle the change the other elements are not judged; their
/// evidence restarts with the windows behind it. The size follows from windows that lie wholly
/// behind the change and do not overlap, short ones first. It is published once it is significant,
/// and again as it sharpens. A change that most frames share has a record with parameter
/// `ChangeRecord::kEverything`.
class ChangeBook {
 public:
  /// A size of at least kWorth standard errors is published. Below kNothing errors, not counting
  /// the model's, there is no change.
  static constexpr double kWorth = 2.2, kNothing = 2;

  /// watched: theta order. windows_s: lengths by WindowEstimate::window, the main one first; the
  /// next index is that of the long windows. threshold: of the detectors, see ChangeDetector.
  /// model: an empty one selects the defaults.
  ChangeBook(const ParameterTable& table, const std::vector<Watched>& watched,
             const std::vector<double>& windows_s, double long_window_s, double threshold,
             const ChangeModel& model);

  /// Sets the baseline of ordinary windows from now on.
  void set_baseline(const Baseline& baseline);
  /// Sets the baseline of the long windows and restarts the evidence in them.
  void begin_long(const Baseline& baseline, const std::vector<Watched>& watched);

  bool takes(const WindowEstimate& estimate) const {
    return detectors_[static_cast<std::size_t>(estimate.window)].takes(estimate);
  }
  /// Takes a window for which takes() is true, corrected to the conditions of its baseline.
  /// explained: theta order. doubted: by element; 1: a gain is not credible now. Returns the
  /// transitions of records, valid until the next call.
  const std::vector<Alarm>& push(const WindowEstimate& judged,
                                 const std::vector<Explained>& explained,
                                 const std::vector<std::uint8_t>& doubted);

  /// Returns the record of an element or of ChangeRecord::kEverything; null if it has no record.
  const ChangeRecord* record(int parameter) const;

  void archive(auto& a) {
    a(detectors_, of_all_, histories_, scatter_, records_, gate_);
    a.within(last_id_, 0, a.kMaxCount);
    for (const Record& r : records_)
      if (r.detector >= detectors_.size()) a.refuse();
  }

 private:
  struct Record : ChangeRecord {
    std::size_t detector = 0;
    bool young = true;  ///< time and size are recomputed from the histories
    ChangeSize size;
    double behind_s = 0;    ///< length of the windows in it
    Time until{};           ///< windows that begin before are in the size
    Time found{}, first{};  ///< end of the window that found it; start of the evidence

    void archive(auto& a) {
      a.within(id, 0, a.kMaxCount);
      a.within(state, 0, static_cast<double>(ChangeState::measured));
      a(parameter, change, detector, young, size, until, found, first);
      a.within(behind_s, 0, a.kMaxCount);
    }
  };
  std::size_t all() const { return elements_; }  ///< index of the common change
  bool is_long(std::size_t window) const { return window + 1 == detectors_.size(); }
  const Baseline& baseline_of(std::size_t window) const {
    return is_long(window) ? long_baseline_ : baseline_;
  }
  Baseline common_baseline(std::size_t window) const;
  double baseline_error(std::size_t window, std::size_t element) const;
  ChangeDetector& detector_of(std::size_t window, std::size_t element);
  int in_detector(std::size_t element) const {
    return element == all() ? 0 : static_cast<int>(element);
  }
  std::size_t index_of(const Record& record) const {
    return record.parameter == ChangeRecord::kEverything
               ? all()
               : static_cast<std::size_t>(record.parameter);
  }
  double least_change(std::size_t element) const {
    return element == all() ? least_of_all_ : watched_[element].least_change;
  }
  double usual_error(std::size_t window, std::size_t element, double own) const;

  void find_common(const std::vector<Explained>& explained);
  void remember(const std::vector<Explained>& explained);
  void update(Record& record);
  void refine_time(Record& record);
  void refit_size(Record& record);
  bool extend_size(Record& record);
  const WindowHistory* next_behind(const Record& record, std::size_t& at) const;
  /// Returns the length of the windows that mostly determine the size.
  double length_s(const Record& record) const {
    return lengths_s_[is_long(record.detector) ? record.detector : 0];
  }
  Change measured(const Record& record) const;
  double model_error(const Record& record, double ratio) const;
  bool is_refuted(const Record& record) const;
  bool is_significant(const Record& record, const Change& change) const;
  void publish(Record& record, bool further);
  void find(const std::vector<std::uint8_t>& doubted);
  bool all_alike(std::size_t window, Time since);
  bool settled() const;
  void begin(std::size_t element, std::size_t window);
  void announce(const Record& record, AlarmState state, ChangeReason reason);
  void end(Record& record, ChangeReason reason);
  void forget(std::size_t element);
  void forget_others();
  void tolerate();

  std::size_t elements_;
  ChangeModel model_;
  std::vector<Watched> watched_;
  double least_of_all_ = 1;
  std::vector<std::uint8_t> frame_;  ///< by element: takes part in the common change
  std::vector<std::size_t> order_;   ///< of windows by which a size is computed first
  double threshold_;
  std::vector<double> lengths_s_;  ///< by window
  Baseline baseline_, long_baseline_;
  std::vector<ChangeDetector> detectors_;  ///< by window
  std::vector<ChangeDetector> of_all_;     ///< of the common change, by window
  std::vector<WindowHistory> histories_;
  std::vector<UsualScatter> scatter_;  ///< windows x (elements and the common change)
  std::vector<Record> records_;        ///< by element, the common change last
  Time gate_{};  ///< windows that begin before do not count for other elements
  std::int64_t last_id_ = 0;

  // Scratch of push().
  WindowEstimate judged_, common_;
  CommonChange median_;
  double common_off_ = 0, common_explained_ = 0;
  std::vector<std::uint8_t> held_;
  std::vector<Deviation> alone_;  ///< for all_alike()
  std::vector<const WindowHistory*> times_;
  std::vector<Alarm> news_;
};

}  // namespace framewatch::estimator
