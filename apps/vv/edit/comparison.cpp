#include "edit/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "holm.h"
#include "libpicture/false_colour.h"

namespace vv {

namespace {

uint8_t mixed(double from, double to, double part) {
  return uint8_t(std::lround(from + (to - from) * part));
}

} // namespace

ChangePicture compare(const picture::Picture& before, const picture::Picture& now) {
  ChangePicture out;
  out.width = now.width;
  out.height = now.height;
  out.changes.assign(size_t(now.width) * size_t(now.height), 0);
  std::vector<double> chances;
  std::vector<std::pair<size_t, float>> judged; // pixels and their changes
  const picture::PixelLights a(before), b(now);
  for (size_t pixel = 0; pixel < out.changes.size(); ++pixel) {
    if (!a.isTrusted(pixel) || !b.isTrusted(pixel)) continue;
    const Difference difference = differenceBetween(a.luminance(pixel), b.luminance(pixel));
    chances.push_back(difference.chance);
    judged.emplace_back(pixel, float(difference.value));
  }
  out.judged = judged.size();
  for (const size_t i : holm::significantOf(chances, changeLevel)) {
    const auto [pixel, change] = judged[i];
    out.changes[pixel] = change;
    out.most = std::max(out.most, change);
    out.least = std::min(out.least, change);
    ++out.significant;
  }
  return out;
}

float ChangePicture::at(double x, double y) const {
  const int column = std::clamp(int((1 + x) / 2 * width), 0, width - 1),
            row = std::clamp(int((1 - y) / 2 * height), 0, height - 1);
  return changes[size_t(row) * size_t(width) + size_t(column)];
}

std::vector<uint8_t> drawChanges(const ChangePicture& changes, const std::vector<uint8_t>& rgb) {
  constexpr double gain[] = {255, 150, 20}, loss[] = {70, 140, 255};
  constexpr double dimming = 0.45, weakest = 0.4; // the strength of the colour of a small change
  const double largest = double(std::max(changes.most, -changes.least));
  std::vector<uint8_t> out(rgb.size());
  for (size_t i = 0; i < changes.changes.size(); ++i) {
    const double grey =
        dimming * (.2126 * rgb[3 * i] + .7152 * rgb[3 * i + 1] + .0722 * rgb[3 * i + 2]);
    const auto change = double(changes.changes[i]);
    const double strength =
        change == 0 ? 0 : weakest + (1 - weakest) * std::sqrt(std::abs(change) / largest);
    for (size_t k = 0; k < 3; ++k)
      out[3 * i + k] = mixed(grey, change > 0 ? gain[k] : loss[k], strength);
  }
  return out;
}

void Comparison::ask(uint64_t changes, const EditView& view) {
  asked_ = {changes, view};
  frame_ = 0;
}

std::string Comparison::whyNot(const EditView& view, int width, int height) const {
  if (!hasA()) return "nothing is kept as A yet: B keeps the picture";
  if (view != view_)
    return "the view has changed since A: the pictures cannot be compared (B keeps a new A)";
  if (width != a_.width || height != a_.height)
    return fmt::format("A has {}x{} pixels, the window {}x{}: the pictures cannot be compared",
                       a_.width, a_.height, width, height);
  return "";
}

void Comparison::toggle(Shown what) {
  if (!hasA())
    throw xvrml::EditError(asked_ ? "A waits for a still picture with error bars"
                                  : "nothing is kept as A yet: B keeps the picture");
  if (what == Shown::difference && !a_.linear)
    throw xvrml::EditError("these pictures have no luminance (--colour vrml97)");
  shown_ = shown_ == what ? Shown::present : what;
  changes_.reset();
  setCover(0, 0, {});
  if (shown_ == Shown::a || shown_ == Shown::wiper) coverWithA();
}

bool Comparison::wantsPicture() const {
  return asked_.has_value() || (shown_ == Shown::difference && !changes_);
}

bool Comparison::take(const picture::Picture& picture, uint64_t frame, uint64_t changes,
                      const EditView& view, bool isFinished) {
  if (asked_) {
    const Asked asked = *std::exchange(asked_, std::nullopt);
    if (asked.changes == changes && asked.view == view) {
      frame_ = frame;
      isComplete_ = false;
      message_ = "A is kept";
    } else {
      message_ = "A was not kept: the world or the view has changed before its picture was there";
    }
  }
  const bool isA = isRefined(frame);
  if (isA) {
    a_ = picture;
    view_ = view;
    if (isFinished && !std::exchange(isComplete_, true))
      message_ = "A has all its samples: \\ shows it, W beside the picture, D what has changed";
    if (shown_ == Shown::a || shown_ == Shown::wiper) coverWithA();
  }
  if (shown_ == Shown::difference && whyNot(view, picture.width, picture.height).empty()) {
    changes_ = compare(a_, picture);
    setCover(picture.width, picture.height, drawChanges(*changes_, displayBytes(picture)));
  }
  return isA;
}

void Comparison::follow(const EditView& view, int width, int height, const Look& look,
                        bool isOutdated) {
  const bool isOther = look != look_;
  look_ = look;
  if (shown_ == Shown::present) return;
  if (std::string why = whyNot(view, width, height); !why.empty()) {
    toggle(shown_);
    message_ = std::move(why);
  } else if (shown_ != Shown::difference) {
    if (isOther) coverWithA();
  } else if (isOutdated && std::exchange(changes_, std::nullopt)) {
    setCover(0, 0, {});
  }
}

void Comparison::clear() {
  const uint64_t number = cover_.number;
  *this = {};
  cover_.number = number + 1;
}

void Comparison::setWiper(double x) { wiper_ = std::clamp(x, -1.0, 1.0); }

void Comparison::setCover(int width, int height, std::vector<uint8_t> rgb) {
  cover_ = {width, height, std::move(rgb), cover_.number + 1};
}

void Comparison::coverWithA() {
  picture::Picture shown = withChannels(a_, RT_RGBA);
  shown.view = look_.transform;
  if (look_.scaleEnd > 0 && shown.linear)
    shown = picture::falseColours(shown, look_.scaleEnd, picture::Legend::apart);
  setCover(shown.width, shown.height, displayBytes(shown));
}

} // namespace vv
