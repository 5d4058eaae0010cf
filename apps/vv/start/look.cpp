#include "start/look.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "libpicture/bare_model.h"
#include "printable.h"
#include "process/messages.h"
#include "report/describe.h"
#include "start/world_start.h"

namespace vv {

namespace {

// PPM and PFM are for programs. EXR is both: it has the light of the studio, but no backdrop.
bool isForScreens(const Output& output) {
  if (output.film != picture::FilmKind::none) return true;
  const std::string_view name = output.format->name;
  return name != "PPM" && name != "PFM";
}

// Returns a name, or the beginning of a long one, in whole characters of UTF-8.
std::string beginningOf(std::string_view name) {
  constexpr size_t longest = 60;
  if (name.size() <= longest) return std::string(name);
  size_t end = 0;
  while (end < longest) end += std::max<size_t>(1, printable_text::utf8Length(name.substr(end)));
  return std::string(name.substr(0, end)) + "...";
}

} // namespace

void chooseLook(const Options& options, const xvrml::World& world,
                picture::RenderSettings& settings) {
  if (!picture::leavesLookOpen(options.render) || !options.compare.empty() || options.audit ||
      options.render.channels != RT_RGBA)
    return;
  if (!options.outputs.empty() &&
      std::none_of(options.outputs.begin(), options.outputs.end(), isForScreens))
    return;
  picture::Look look =
      picture::lookOf(world, !options.shaders.empty() && isOfCommandLine(options, world));
  if (look == picture::Look::studio && options.measures()) look = picture::Look::backdrop;
  const picture::ViewTransform view = settings.view;
  picture::choose(look, settings);
  if (options.viewGiven) settings.view = view;
}

void chooseView(const Options& options, const xvrml::World& world, picture::View& view) {
  if (options.viewpoint.empty() && options.from.empty() && picture::mayLeaveCameraOut(world, view))
    view.authored = picture::View::Authored::unlessCut;
}

void settleView(bool leavesOut, const std::vector<xvrml::ViewpointInfo>& viewpoints, bool quiet,
                picture::View& view) {
  using Authored = picture::View::Authored;
  view.authored = leavesOut ? Authored::leftOut : Authored::shown;
  if (!leavesOut || quiet || viewpoints.empty()) return;
  const std::string name = beginningOf(viewpoints.front().description);
  say(fmt::format("vv: the file's camera{} does not show all of the model, this view does; "
                  "--viewpoint 0 looks through that camera",
                  name.empty() ? "" : fmt::format(" \"{}\"", oneLine(name))));
}

} // namespace vv
