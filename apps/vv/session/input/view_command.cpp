#include "session/input/view_command.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "libpicture/shader_text.h"
#include "options/option_info.h"
#include "xvrml/nodes.h"

namespace vv {

namespace {

std::string quoted(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+,.:/@%";
  if (!word.empty() && word.find_first_not_of(plain) == word.npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// Tells whether a picture of the same view needs this option.
bool isKept(const OptionInfo& option) {
  const std::string_view group = option.group;
  return option.traits.inViews || group == "Change" || group == "Quality" || group == "Trust";
}

// Returns position, target and up vector. 17 digits reproduce the numbers exactly.
std::string placeOf(const xvrml::CameraSettings& camera) {
  const double* m = camera.matrix;
  const auto number = [](double v) {
    return std::abs(v) < 1e-15 ? std::string("0") : fmt::format("{}", v);
  };
  const auto triple = [&](double x, double y, double z) {
    return number(x) + "," + number(y) + "," + number(z);
  };
  return triple(m[12], m[13], m[14]) + ":" + triple(m[12] - m[8], m[13] - m[9], m[14] - m[10]) +
         ":" + triple(m[4], m[5], m[6]);
}

} // namespace

std::string viewCommand(const ShownView& view, const std::vector<std::string>& arguments) {
  std::string line = "vv " + quoted(view.world);
  line += fmt::format(" --size {}x{} --camera={}", view.width, view.height, placeOf(view.camera));
  if (view.camera.fovy > 0) {
    const double aspect = double(view.width) / view.height;
    const double smaller =
        aspect >= 1 ? view.camera.fovy : 2 * std::atan(std::tan(view.camera.fovy / 2) * aspect);
    line += fmt::format(" --fov {}", smaller * 180 / std::numbers::pi);
  } else {
    line += fmt::format(" --ortho {}", view.camera.height);
  }
  if (const auto* shader = xvrml::nodeCast<xvrml::nodes::ORTShader>(view.camera.shader))
    line += " --camera-shader " + quoted(picture::shaderText(*shader));
  if (view.headlight) line += *view.headlight ? " --headlight on" : " --headlight off";
  if (view.falseColour)
    line += *view.falseColour > 0 ? fmt::format(" --false-colour {}", *view.falseColour)
                                  : " --false-colour auto";
  else if (view.transform)
    line += fmt::format(" --exposure={} --view {}", view.transform->exposure,
                        picture::curveName(view.transform->curve));
  if (view.epoch) line += fmt::format(" --epoch {}", *view.epoch);
  if (view.time > 0) line += fmt::format(" --time {}", view.time);
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    const size_t equals = word.find('=');
    const OptionInfo* option =
        optionCalled(word.substr(0, word.starts_with("--") ? equals : word.npos));
    if (!option) continue;
    const bool takesNext = *option->argument && option->argument[0] != '[' &&
                           !(word.starts_with("--") && equals != word.npos);
    if (isKept(*option))
      line += " " + quoted(word) +
              (takesNext && i + 1 < arguments.size() ? " " + quoted(arguments[i + 1]) : "");
    if (takesNext) ++i;
  }
  return line + " -o view.png";
}

} // namespace vv
