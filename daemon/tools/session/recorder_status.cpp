#include <framewatch/session_status_t.hpp>

#include "daemon/base/process.h"
#include "daemon/tools/session/recorder.h"

namespace framewatch::daemon {

std::vector<ChannelResult> Recorder::channel_results() const {
  std::vector<ChannelResult> out =
      state_ == RecorderState::recording ? check_.results(acquisition_.counters()) : check_results_;
  for (std::size_t a = 0; a < out.size(); ++a) {
    out[a].polarity = polarity_[a];
    if (polarity_[a] < 0 && out[a].problem.empty())
      out[a].problem = "reversed: change its polarity in the configuration";
  }
  return out;
}

session_status_t Recorder::status(std::int64_t now_us) const {
  session_status_t s{};
  s.time_us = now_us;
  s.state = static_cast<std::int32_t>(state_);
  s.test = session_.request.test;
  s.session = folder_;
  s.report = report_;
  s.message = news_;
  s.answered = answered_;
  s.refused = refused_;
  const bool recording = state_ == RecorderState::recording;
  if (recording && session_.trigger_us != 0)
    s.elapsed_s = 1e-6 * static_cast<double>(newest_us_ - session_.trigger_us);
  s.length_s = session_.request.length_s;
  s.trigger_mps2 = session_.request.trigger_mps2;
  s.messages = log_ ? log_->messages() : session_.messages;
  s.estimates = session_.estimates;
  s.lost = log_ ? lost() - lost_before_ : session_.lost;
  s.dropped = log_ ? log_->dropped() : session_.dropped;
  s.bytes = log_ ? log_->bytes() : 0;
  s.disk_free_bytes = disk_free_bytes(sessions_);
  for (const ChannelResult& r : channel_results()) {
    s.name.push_back(r.name);
    s.noise_mps2_per_rthz.push_back(r.noise_density);
    s.rms_mps2.push_back(r.rms);
    s.offset_mps2.push_back(r.offset);
    s.peak_mps2.push_back(r.peak);
    s.range_mps2.push_back(r.range);
    s.saturated.push_back(r.saturated);
    s.polarity.push_back(r.polarity);
    s.problem.push_back(r.problem);
  }
  s.channels = static_cast<std::int32_t>(s.name.size());
  return s;
}

}  // namespace framewatch::daemon
