#include "daemon/live_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/acknowledge_command.h"
#include "daemon/estimation.h"
#include "daemon/event_words.h"
#include "daemon/heard_channels.h"
#include "drivers/encoded.h"
#include "drivers/message_check.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kRing = 256;         // 10 s of events
constexpr std::size_t kMostRows = 200;     // of one motion event
constexpr std::size_t kMostEvents = 1000;  // kept for viewers that come later
constexpr std::size_t kMostCommands = 16;  // that wait
constexpr int kFlushesPerBoxplot = 5;
constexpr double kMostRate_hz = 200;  // of the rows that go to the page
constexpr double kWatched_s = 2.5;

std::span<const std::uint8_t> bytes(const void* data, std::size_t size) {
  return {static_cast<const std::uint8_t*>(data), size};
}

/// "1.25,null,3"
template <typename Values>
std::string list(const Values& values, const char* format = "{}") {
  std::string out;
  for (const auto value : values) {
    if (!out.empty()) out += ',';
    if (std::isfinite(static_cast<double>(value)))
      fmt::format_to(std::back_inserter(out), fmt::runtime(format), value);
    else
      out += "null";
  }
  return "[" + out + "]";
}

std::string finite(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string gap_json(const gap_t& g) {
  Json names = Json::array();
  for (const std::string& name : g.name) names.push_back(name);
  return fmt::format(
      R"({{"start_us":{},"end_us":{},"overall":{},"noise_floor":{},"name":{},"nrmse":{},"floor":{}}})",
      g.window_start_us, g.window_end_us, finite(g.overall_nrmse), finite(g.noise_floor),
      dumped(names), list(g.nrmse, "{:.4g}"), list(g.floor, "{:.4g}"));
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string can_json(const can_status_t& s) {
  Json buses = Json::array();
  for (std::size_t i = 0; i < s.interface.size(); ++i)
    buses.push_back({{"interface", s.interface[i]},
                     {"state", s.state[i]},
                     {"frames_hz", number(s.frames_hz[i])},
                     {"load", number(s.load[i])},
                     {"expected_load", number(s.expected_load[i])},
                     {"error_frames", s.error_frames[i]},
                     {"bus_off", s.bus_off[i]},
                     {"bus_errors", s.bus_errors[i]},
                     {"overflow", s.overflow[i]}});
  return dumped({{"time_us", s.time_us}, {"dropped", s.dropped}, {"buses", buses}});
}

std::string session_json(const session_status_t& s) {
  Json channels = Json::array();
  for (std::size_t i = 0; i < s.name.size(); ++i)
    channels.push_back({{"name", s.name[i]},
                        {"noise", number(s.noise_mps2_per_rthz[i])},
                        {"rms", number(s.rms_mps2[i])},
                        {"offset", number(s.offset_mps2[i])},
                        {"peak", number(s.peak_mps2[i])},
                        {"range", number(s.range_mps2[i])},
                        {"saturated", s.saturated[i]},
                        {"polarity", s.polarity[i]},
                        {"problem", s.problem[i]}});
  // Ids are beyond what JavaScript counts exactly.
  return dumped({{"time_us", s.time_us},
                 {"state", s.state},
                 {"test", s.test},
                 {"session", s.session},
                 {"report", s.report},
                 {"message", s.message},
                 {"answered", std::to_string(s.answered)},
                 {"refused", s.refused},
                 {"elapsed_s", number(s.elapsed_s)},
                 {"length_s", number(s.length_s)},
                 {"trigger_mps2", number(s.trigger_mps2)},
                 {"messages", s.messages},
                 {"estimates", s.estimates},
                 {"lost", s.lost},
                 {"dropped", s.dropped},
                 {"bytes", s.bytes},
                 {"disk_free_bytes", s.disk_free_bytes},
                 {"channels", channels}});
}

std::string boxes_json(const window_estimate_t& e) {
  return fmt::format(
      R"({{"windows":{},"q1":{},"median":{},"q3":{},"low":{},"high":{},"outliers":{},"count":{}}})",
      e.boxplot_windows, list(e.q1, "{:.6g}"), list(e.median, "{:.6g}"), list(e.q3, "{:.6g}"),
      list(e.whisker_low, "{:.6g}"), list(e.whisker_high, "{:.6g}"), list(e.outliers),
      list(e.boxplot_count));
}

}  // namespace

LiveView::LiveView(const Config& config, MessageSink publish)
    : config_(config),
      publish_(std::move(publish)),
      acquisition_(config.pipeline.axes, config.pipeline.options,
                   [this](const SampleSet& set) { keep(set); }),
      intake_(wanted_axes(config),
              [this](const AccelSample& sample) { acquisition_.push(sample); }),
      ring_(kRing) {
  stride_ =
      std::max(1, static_cast<int>(std::ceil(config.pipeline.options.rate_hz / kMostRate_hz)));
}

std::vector<std::string> LiveView::channels() const {
  std::vector<std::string> out = sample_channels(config_);
  const std::string& prefix = config_.lcm.prefix;
  for (const char* name : {"PARAMETERS", "ESTIMATE", "STATUS", "EVENT", "GAP", "CAN", "SESSION",
                           "SERVICE", "ACKNOWLEDGED"})
    out.push_back(prefix + name);
  for (const double window_s : config_.pipeline.options.other_windows_s)
    if (std::abs(window_s - kWatched_s) < 1e-9)
      out.push_back(fmt::format("{}ESTIMATE_{:g}S", prefix, window_s));
  return out;
}

void LiveView::push(const std::string& name, const std::string& data) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ring_.push(name, data);
}

void LiveView::message(const std::string& channel, const void* data, std::size_t size) {
  const std::string& prefix = config_.lcm.prefix;
  if (!channel.starts_with(prefix)) {
    (void)intake_.message(channel, data, size);
  } else if (channel == prefix + "PARAMETERS") {
    parameters(data, size);
  } else if (channel.starts_with(prefix + "ESTIMATE")) {
    estimate(channel, data, size);
  } else if (channel == prefix + "EVENT") {
    if (const auto e = drivers::decode_event(bytes(data, size))) event(*e);
  } else if (channel == prefix + "SERVICE") {
    if (const auto s = drivers::decode_service(bytes(data, size))) still_raised(*s);
  } else if (channel == prefix + "ACKNOWLEDGED") {
    if (auto a = drivers::decode_acknowledged(bytes(data, size))) acknowledged(std::move(*a));
  } else if (channel == prefix + "STATUS") {
    if (const auto s = drivers::decode_status(bytes(data, size)))
      status("status", status_, status_json(*s));
  } else if (channel == prefix + "SESSION") {
    if (const auto s = drivers::decode_session_status(bytes(data, size)))
      status("session", session_, session_json(*s));
  } else if (channel == prefix + "CAN") {
    if (const auto s = drivers::decode_can_status(bytes(data, size)))
      status("can", can_, can_json(*s));
  } else if (channel == prefix + "GAP") {
    if (const auto gap = drivers::decode_gap(bytes(data, size)))
      status("gap", gap_, gap_json(*gap));
  }
}

/// What a viewer that comes later is to know at once.
void LiveView::status(const std::string& name, std::string& kept, std::string json) {
  const std::lock_guard<std::mutex> lock(mutex_);
  kept = std::move(json);
  ring_.push(name, kept);
}

bool LiveView::tell_recorder(const session_command_t& command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (commands_.size() == kMostCommands) return false;
  commands_.push_back(command);
  return true;
}

void LiveView::send_commands() {
  std::vector<session_command_t> commands;
  std::vector<acknowledge_t> requests;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    commands.swap(commands_);
    requests.swap(requests_);
  }
  for (const acknowledge_t& request : requests)
    publish_(0, config_.lcm.prefix + "ACKNOWLEDGE", drivers::encoded(request));
  for (const session_command_t& command : commands)
    publish_(0, config_.lcm.prefix + "SESSION_COMMAND", drivers::encoded(command));
}

void LiveView::keep(const SampleSet& set) {
  if (set.index % stride_ != 0) return;
  if (row_count_ == kMostRows) {
    ++rows_left_out_;
    return;
  }
  if (row_count_ == 0) first_row_us_ = to_microseconds(set.time);
  rows_ += fmt::format("{}[{},{}]", row_count_ == 0 ? "" : ",",
                       to_microseconds(set.time) - first_row_us_, list(set.accel, "{:.5g}"));
  ++row_count_;
}

void LiveView::parameters(const void* data, std::size_t size) {
  auto table = drivers::decode_parameter_table(bytes(data, size));
  if (!table) return;
  const bool same = table_ && table_->name == table->name;
  table_ = std::move(*table);
  if (same) return;
  watched_channel_ = config_.lcm.prefix + "ESTIMATE";
  double window_s = table_->window_rows / table_->rate_hz;
  for (std::size_t i = 0; i < table_->other_channel.size(); ++i) {
    const double other_s = table_->other_rows[i] / table_->rate_hz;
    if (std::abs(other_s - kWatched_s) > 0.2) continue;
    watched_channel_ = table_->other_channel[i];
    window_s = other_s;
  }
  watch_.emplace(*table_, window_s, std::max<std::int64_t>(1, table_->time_us));
}

void LiveView::estimate(const std::string& channel, const void* data, std::size_t size) {
  const bool main = channel == config_.lcm.prefix + "ESTIMATE";
  if (!main && channel != watched_channel_) return;
  auto found = drivers::decode_window_estimate(bytes(data, size));
  if (!found) return;
  if (channel == watched_channel_ && watch_) {
    bool renew = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      std::swap(renew, renew_);
    }
    if (renew) watch_->renew();
    for (const event_t& e : watch_->observe(*found)) {
      if (config_.watch) continue;  // the estimator's own alarms come over LCM
      publish_(e.time_us, config_.lcm.prefix + "EVENT", drivers::encoded(e));
    }
  }
  if (!main) return;
  ++estimates_;
  newest_ = std::move(*found);
}

void LiveView::event(const event_t& e) {
  const std::lock_guard<std::mutex> lock(mutex_);
  events_[e.id] = e;
  if (e.state == event_state::cleared) acknowledged_here_.erase(e.id);
  if (events_.size() > kMostEvents) {
    // What is still raised would be brought back by the next service_t.
    auto gone = std::find_if(events_.begin(), events_.end(), [](const auto& known) {
      return known.second.state == event_state::cleared;
    });
    if (gone == events_.end()) gone = events_.begin();
    acknowledged_here_.erase(gone->first);
    events_.erase(gone);
  }
  ring_.push("alarm", event_json(e));
}

/// What was raised before this began to listen.
void LiveView::still_raised(const service_t& s) {
  for (std::size_t i = 0; i < s.event_id.size(); ++i) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (events_.contains(s.event_id[i])) continue;
    }
    event_t e{};
    e.id = s.event_id[i];
    e.time_us = e.since_us = s.event_since_us[i];
    e.state = event_state::raised;
    e.severity = s.event_severity[i];
    e.kind = s.event_kind[i];
    e.place = s.event_place[i];
    e.value = e.std_error = std::numeric_limits<double>::quiet_NaN();
    e.message = s.event_message[i];
    event(e);
  }
}

void LiveView::acknowledged(acknowledged_t news) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (acknowledged_ && acknowledged_->id == news.id && acknowledged_->since_us == news.since_us)
    return;
  std::set<std::int64_t> touched(news.id.begin(), news.id.end());
  if (acknowledged_) touched.insert(acknowledged_->id.begin(), acknowledged_->id.end());
  acknowledged_ = std::move(news);
  for (const std::int64_t id : touched)
    if (const auto found = events_.find(id); found != events_.end())
      ring_.push("alarm", event_json(found->second));
}

void LiveView::flush() {
  send_commands();
  if (row_count_ > 0)
    push("motion", fmt::format(R"({{"first_us":{},"rows":[{}],"left_out":{}}})", first_row_us_,
                               rows_, rows_left_out_));
  row_count_ = 0;
  rows_.clear();
  if (++flushes_ % 20 == 0) {
    const std::string baseline = baseline_json();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (baseline != baseline_) ring_.push("baseline", baseline);
    baseline_ = baseline;
    ring_.push("alive", "{}");
  }
  if (!newest_) return;
  if (estimates_ > 0)
    push("estimate",
         fmt::format(R"({{"start_us":{},"end_us":{},"sequence":{},"status":{},"rows":{},)"
                     R"("residual":{},"value":{},"error":{},"reason":{},"snr":{}}})",
                     newest_->window_start_us, newest_->window_end_us, newest_->sequence,
                     newest_->status, newest_->rows, finite(newest_->residual_ratio),
                     list(newest_->value), list(newest_->std_error, "{:.4g}"),
                     list(newest_->reason), list(newest_->snr, "{:.3g}")));
  estimates_ = 0;
  if (flushes_ % kFlushesPerBoxplot == 0 && newest_->boxplots > 0)
    push("boxes", boxes_json(*newest_));
}

std::string LiveView::status_json(const status_t& s) const {
  Json channels = Json::array();
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    Json one{{"name", s.name[i]},   {"received", s.received[i]}, {"lost", s.lost[i]},
             {"late", s.late[i]},   {"repaired", s.repaired[i]}, {"rejected", s.rejected[i]},
             {"stuck", s.stuck[i]}, {"clipped", s.clipped[i]}};
    const double noise = s.noise_mps2_per_rthz[i];
    one["noise"] = std::isfinite(noise) ? Json(noise) : Json(nullptr);
    channels.push_back(std::move(one));
  }
  return dumped({{"time_us", s.time_us},
                 {"windows", s.windows},
                 {"sets", s.sample_sets},
                 {"gaps", s.gaps},
                 {"refused", s.rejected_messages},
                 {"queue_high", s.queue_high_water},
                 {"queue_dropped", s.queue_dropped},
                 {"latency_s", s.latency_s},
                 {"same_config", s.config_sha256 == config_.sha256},
                 {"channels", channels}});
}

std::string LiveView::event_json(const event_t& e) const {
  std::string who, comment;
  bool known = acknowledged_here_.contains(e.id);
  if (acknowledged_ && e.state != event_state::cleared) {
    const std::vector<std::int64_t>& ids = acknowledged_->id;
    if (const auto at = std::find(ids.begin(), ids.end(), e.id); at != ids.end()) {
      known = true;
      who = acknowledged_->who[static_cast<std::size_t>(at - ids.begin())];
      comment = acknowledged_->comment[static_cast<std::size_t>(at - ids.begin())];
    }
  }
  return dumped({{"id", e.id},
                 {"time_us", e.time_us},
                 {"since_us", e.since_us},
                 {"state", e.state},
                 {"severity", e.severity},
                 {"kind", e.kind},
                 {"place", e.place},
                 {"value", std::isfinite(e.value) ? Json(e.value) : Json(nullptr)},
                 {"error", std::isfinite(e.std_error) ? Json(e.std_error) : Json(nullptr)},
                 {"unit", e.unit},
                 {"message", e.message},
                 {"acknowledged", known},
                 {"who", who},
                 {"comment", comment}});
}

std::string LiveView::baseline_json() const {
  return watch_ ? "{\"value\":" + list(watch_->baseline()) + "}" : "{\"value\":[]}";
}

std::string LiveView::building_json() const {
  const Structure& s = config_.pipeline.structure;
  const ParameterTable table(s);
  Json parameters = Json::array();
  const Eigen::VectorXd& design = config_.pipeline.design;
  for (int p = 0; p < table.size(); ++p)
    parameters.push_back({{"name", table[p].name},
                          {"unit", table[p].unit},
                          {"kind", static_cast<int>(table[p].kind)},
                          {"story", table[p].story},
                          {"frame", table[p].frame},
                          {"panel", table[p].panel},
                          {"design", design.size() > p ? Json(design[p]) : Json(nullptr)}});
  Json axes = Json::array();
  for (const SensorAxis& a : config_.pipeline.axes)
    axes.push_back({{"name", a.name},
                    {"story", a.story},
                    {"direction", a.direction == Direction::x ? "x" : "y"},
                    {"frame", a.frame}});
  const EstimatorOptions& o = config_.pipeline.options;
  return dumped({{"name", s.name},
                 {"stories", s.stories},
                 {"frames_x", s.frames_x},
                 {"frames_y", s.frames_y},
                 {"span_x_m", s.span_x},
                 {"span_y_m", s.span_y},
                 {"story_height_m", s.story_height},
                 {"rigid", s.floor == FloorModel::rigid},
                 {"parameters", parameters},
                 {"axes", axes},
                 {"rate_hz", o.rate_hz / stride_},
                 {"window_s", o.window_s},
                 {"high_pass_hz", o.high_pass_hz},
                 {"version", FRAMEWATCH_VERSION},
                 {"config_sha256", config_.sha256}});
}

EventRing::Cursor LiveView::join() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string first = "retry: 1000\n\n";
  if (!status_.empty()) first += EventRing::text("status", status_);
  if (!baseline_.empty()) first += EventRing::text("baseline", baseline_);
  if (!session_.empty()) first += EventRing::text("session", session_);
  if (!can_.empty()) first += EventRing::text("can", can_);
  if (!gap_.empty()) first += EventRing::text("gap", gap_);
  for (const auto& [id, e] : events_) first += EventRing::text("alarm", event_json(e));
  return ring_.join(std::move(first));
}

std::size_t LiveView::read(EventRing::Cursor& cursor, char* buffer, std::size_t size) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ring_.read(cursor, buffer, size);
}

bool LiveView::acknowledge(std::int64_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = events_.find(id);
  if (found == events_.end()) return false;
  // Its own events nobody else knows of.
  const bool found_here = !config_.watch && found->second.kind == "stiffness_change";
  if (acknowledged_ && !found_here) {
    if (requests_.size() == kMostCommands) return false;
    requests_.push_back(acknowledge_request(id, "the page", ""));
    return true;
  }
  acknowledged_here_.insert(id);
  ring_.push("alarm", event_json(found->second));
  return true;
}

void LiveView::renew_baseline() {
  const std::lock_guard<std::mutex> lock(mutex_);
  renew_ = true;
}

}  // namespace framewatch::daemon
