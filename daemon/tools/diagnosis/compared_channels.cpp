#include "daemon/tools/diagnosis/compared_channels.h"

#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {

ComparedChannels compared_channels(const Config& config, std::vector<DiagnoseRecord>& records) {
  ComparedChannels out;
  std::vector<int> new_place;
  std::vector<Eigen::Index> columns;
  for (const estimator::SensorAxis& axis : config.pipeline.axes) {
    new_place.push_back(axis.check ? -1 : static_cast<int>(out.axes.size()));
    if (axis.check) continue;
    columns.push_back(static_cast<Eigen::Index>(new_place.size()) - 1);
    out.axes.push_back(axis);
    out.axes.back().delay -= estimator::whole_delay_s(axis.delay, config.pipeline.options.rate_hz);
  }
  const auto moved = [&](int& channel) {
    if (channel >= 0) channel = new_place[static_cast<std::size_t>(channel)];
    return channel >= 0;
  };
  for (estimator::SensorAxis& axis : out.axes) moved(axis.cross);
  for (const estimator::Effect& effect : config.effects) {
    estimator::Effect known = effect;
    const bool own = effect.place.channel < 0 || moved(known.place.channel);
    const bool other = effect.place.with_channel < 0 || moved(known.place.with_channel);
    if (own && other) out.known.push_back(known);
  }
  const auto given = static_cast<Eigen::Index>(new_place.size());
  for (DiagnoseRecord& record : records) {
    std::vector<Eigen::Index> kept = columns;
    for (Eigen::Index c = given; c < record.samples.accel.cols(); ++c) kept.push_back(c);
    record.samples.accel = Eigen::MatrixXd(record.samples.accel(Eigen::all, kept));
  }
  return out;
}

}  // namespace framewatch::daemon
