#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/structure/parameter_table.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/change_detector.h"
#include "estimator/watch/change_model.h"
#include "estimator/watch/change_record.h"
#include "estimator/watch/change_size.h"
#include "estimator/watch/change_time.h"
#include "estimator/watch/common_change.h"
#include "estimator/watch/usual_scatter.h"
#include "estimator/watch/window_history.h"

namespace framewatch::estimator {

/// What was taken off a deviation because the conditions may explain it, and a standard error of
/// that, relative to the baseline.
struct Explained {
  double off = 0, std_error = 0;
};

/// Finds lasting changes in the windows of every length and keeps the one record of each
/// (docs/equations.md, changes).
///
/// Detectors find that an element changes. Its record then says "is changing", and of the other
/// elements nothing is claimed while windows straddle the change: their evidence begins anew with
/// the windows behind it. The size follows from windows that lie wholly behind the change and do
/// not overlap, short ones first. It is told once it is worth a number, and again as it sharpens.
/// What most frames have in common is one change of its own, that of `ChangeRecord::kEverything`.
class ChangeBook {
 public:
  /// Size over its standard error from which on it is worth a number, and, without the model's
  /// error, below which it is none.
  static constexpr double kWorth = 2.2, kNothing = 2;

  /// watched: theta order. windows_s: lengths by WindowEstimate::window, the main one first; the
  /// next index is that of the long windows. threshold: of the detectors. model: of the elements,
  /// or empty: the usual one.
  ChangeBook(const ParameterTable& table, const std::vector<Watched>& watched,
             const std::vector<double>& windows_s, double long_window_s, double threshold,
             const ChangeModel& model);

  /// The baseline of ordinary windows from now on.
  void set_baseline(const Baseline& baseline);
  /// That of the long windows; evidence in them begins anew.
  void begin_long(const Baseline& baseline, const std::vector<Watched>& watched);

  bool takes(const WindowEstimate& estimate) const {
    return detectors_[static_cast<std::size_t>(estimate.window)].takes(estimate);
  }
  /// A window that takes() is true of, as it would be under the conditions of its baseline;
  /// explained: theta order. doubted: by element, 1: a gain is not to be believed now. The news it
  /// gives; valid until the next call.
  const std::vector<Alarm>& push(const WindowEstimate& judged,
                                 const std::vector<Explained>& explained,
                                 const std::vector<std::uint8_t>& doubted);

  /// Of an element or ChangeRecord::kEverything; null: it has none.
  const ChangeRecord* record(int parameter) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(detectors_, of_all_, histories_, scatter_, records_, gate_);
    a.within(last_id_, 0, a.kMaxCount);
    for (const Record& r : records_)
      if (r.detector >= detectors_.size()) a.refuse();
  }

 private:
  struct Record : ChangeRecord {
    std::size_t detector = 0;
    bool young = true;  ///< time and size are found anew from the histories
    ChangeSize size;
    double behind_s = 0;    ///< length of the windows in it
    Time until{};           ///< windows that begin before are in the size
    Time found{}, first{};  ///< end of the window that found it; where its detector saw it begin

    template <typename Archive>
    void archive(Archive& a) {
      a.within(id, 0, a.kMaxCount);
      a.within(state, 0, static_cast<double>(ChangeState::measured));
      a(parameter, change, detector, young, size, until, found, first);
      a.within(behind_s, 0, a.kMaxCount);
    }
  };
  std::size_t all() const { return elements_; }  ///< index of what everything has in common
  bool is_long(std::size_t window) const { return window + 1 == detectors_.size(); }
  const Baseline& baseline_of(std::size_t window) const {
    return is_long(window) ? long_baseline_ : baseline_;
  }
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
  void follow(Record& record);
  void find_time(Record& record);
  void size_anew(Record& record);
  bool size_on(Record& record);
  const WindowHistory* next_behind(const Record& record, std::size_t& at) const;
  /// Of the windows that a size is mostly made of.
  double length_s(const Record& record) const {
    return lengths_s_[is_long(record.detector) ? record.detector : 0];
  }
  Change measured(const Record& record) const;
  double model_error(const Record& record, double ratio) const;
  bool is_none(const Record& record) const;
  bool worth_a_number(const Record& record, const Change& change) const;
  void tell(Record& record, bool further);
  void find(const std::vector<std::uint8_t>& doubted);
  bool all_alike(std::size_t window, Time since);
  bool settled() const;
  void begin(std::size_t element, std::size_t window);
  void end(Record& record, ChangeReason reason);
  void forget(std::size_t element);
  void forget_others();
  void tolerate();

  std::size_t elements_;
  ChangeModel model_;
  std::vector<Watched> watched_;
  double least_of_all_ = 1;
  std::vector<std::uint8_t> frame_;  ///< by element: counts for what everything has in common
  std::vector<std::size_t> order_;   ///< of windows by which a size is taken first
  double threshold_;
  std::vector<double> lengths_s_;  ///< by window
  Baseline baseline_, long_baseline_;
  std::vector<ChangeDetector> detectors_;  ///< by window
  std::vector<ChangeDetector> of_all_;     ///< the same of what everything has in common
  std::vector<WindowHistory> histories_;
  std::vector<UsualScatter> scatter_;  ///< windows x (elements and everything)
  std::vector<Record> records_;        ///< by element, everything last
  Time gate_{};                        ///< windows that begin before say nothing of other elements
  std::int64_t last_id_ = 0;

  // Of the window that is being pushed.
  WindowEstimate judged_, common_;
  CommonChange median_;
  double common_off_ = 0, common_explained_ = 0;
  std::vector<std::uint8_t> held_;
  std::vector<std::pair<double, double>> alone_;  ///< of all_alike(): deviation and its error
  std::vector<const WindowHistory*> times_;
  std::vector<Alarm> news_;
};

}  // namespace framewatch::estimator
