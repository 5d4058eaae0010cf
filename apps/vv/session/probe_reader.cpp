#include "session/probe_reader.h"

namespace vv {

bool ProbeReader::update(Session& session, Probes& probes, double seconds) {
  constexpr double interval = 0.25;
  if (probes.all().empty()) return false;
  const bool outdated = session.viewers().own().isOutdated();
  if (outdated) probes.expire();
  if (outdated || seconds < read_ + interval) return outdated;
  session.pictures().wantReadings();
  const uint64_t finished =
      session.pictures().isFinished(session.pilot()) ? session.pictures().number() : 0;
  if (finished != 0 && finished == finishedRead_ && !probes.isWaiting()) return false;
  picture::Picture picture;
  if (!session.pictures().copyStill(picture) || !picture.planes.contains(RT_ERROR)) return false;
  read_ = seconds;
  finishedRead_ = finished;
  probes.read(session.browser(), picture, {session.pilot().camera(), session.pilot().aspect()});
  return true;
}

} // namespace vv
