#include "run/view_requests.h"

#include <set>

#include <fmt/format.h>

#include "nearest.h"
#include "process/messages.h"
#include "report/describe.h"

namespace vv {

namespace {

// Returns the views of --from. After the first moment, the turntable needs its own side alone.
std::vector<PictureRequest> viewSides(const Options& options, const picture::View& view,
                                      bool first) {
  std::vector<PictureRequest> requests;
  for (const picture::Side side : options.from) {
    requests.push_back({view, {picture::sideName(side), {}}});
    requests.back().view.side = side;
    requests.back().view.turns = options.turntable > 0 && requests.size() == 1;
    if (options.turntable > 0 && !first) break;
  }
  return requests;
}

// Returns the views of --viewpoint all, with names that differ.
std::vector<PictureRequest> viewAllViewpoints(const picture::View& view,
                                              const std::vector<xvrml::ViewpointInfo>& viewpoints) {
  std::vector<PictureRequest> requests;
  std::set<std::string> taken;
  for (size_t i = 0; i < viewpoints.size(); ++i) {
    const xvrml::ViewpointInfo& v = viewpoints[i];
    std::string name = fileNamePart(v.name.empty() ? v.description : v.name);
    if (name.empty() || name.size() > 100 || taken.count(name))
      name = std::to_string(i) + (name.empty() || name.size() > 100 ? "" : "-" + name);
    taken.insert(name);
    requests.push_back({view, {name, {}}});
    requests.back().view.viewpoint = i;
  }
  return requests;
}

[[noreturn]] void refuseViewpoint(const std::string& wanted,
                                  const std::vector<xvrml::ViewpointInfo>& viewpoints) {
  std::string known;
  std::vector<std::string> names;
  for (size_t i = 0; i < viewpoints.size(); ++i) {
    const xvrml::ViewpointInfo& v = viewpoints[i];
    names.push_back(v.name);
    names.push_back(v.description);
    const std::string& shown = v.name.empty() ? v.description : v.name;
    if (i < 20)
      known += fmt::format("{}{}{}", i ? ", " : "", i, shown.empty() ? "" : " " + oneLine(shown));
  }
  const std::string near = nearest::word(wanted, names);
  throw Failure{exitUsage, fmt::format("--viewpoint: the world has no \"{}\"{}; {}", wanted,
                                       near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                                       viewpoints.empty() ? "it has no viewpoints"
                                                          : "its viewpoints are " + known)};
}

} // namespace

std::vector<PictureRequest> chooseRequests(const Options& options, const picture::View& view,
                                           const std::vector<xvrml::ViewpointInfo>& viewpoints,
                                           bool first) {
  if (options.from.size() > 1) return viewSides(options, view, first);
  if (options.viewpoint.empty() || (options.allViewpoints() && viewpoints.empty()))
    return {{view, {}}};
  if (options.allViewpoints()) return viewAllViewpoints(view, viewpoints);
  const int index = picture::findViewpoint(viewpoints, options.viewpoint);
  if (index < 0) refuseViewpoint(options.viewpoint, viewpoints);
  PictureRequest request{view, {}};
  request.view.viewpoint = size_t(index);
  return {request};
}

} // namespace vv
