#include "estimator/identify/window/window_series.h"

namespace framewatch::estimator {

WindowSeries::WindowSeries(const Structure& structure, const FloorLayout& layout,
                           const ParameterTable& table, const EstimatorOptions& options,
                           double warm, const std::vector<int>& other_blocks, int block_rows)
    : main_(structure, layout, table, options, kCompensatedShare, warm),
      others_(structure, layout, table, options, other_blocks, block_rows),
      steps_per_instant_((main_.error_steps() + block_rows - 2) / (block_rows - 1)) {}

void WindowSeries::restart() {
  main_.restart();
  others_.restart();
}

void WindowSeries::retuned() {
  main_.retuned();
  others_.retuned();
}

void WindowSeries::hold(int unknown, double ratio, double std_error) {
  main_.hold(unknown, ratio, std_error);
  others_.hold(unknown, ratio, std_error);
}

WindowSeries::Done WindowSeries::advance(TunedRegression& regression, const Instant& now) {
  const std::int64_t instant = regression.next();
  const std::vector<std::uint8_t>& known = now.ring->at(instant).known;
  regression.advance(*now.ring);
  if (regression.suffices() && (now.due || regression.closes_block()))
    main_.solve(regression.sums().window(), regression.rows(), now.trust,
                regression.closes_block());
  Done done;
  done.block = regression.finish(*now.ring);
  done.closed = done.block && regression.suffices();
  if (done.closed) {
    main_.begin_errors(regression.sums(), main_);
    others_.block_closed(regression.sums(), now.window_end);
    return done;
  }
  done.errors_new = main_.advance_errors(steps_per_instant_);
  done.other = others_.advance({&regression, &main_, &known, now.trust, now.tuned, now.drift});
  return done;
}

}  // namespace framewatch::estimator
