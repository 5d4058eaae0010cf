// gone.cpp: Finds what has vanished from the picture without having moved: another choice of a
// Switch, another level of detail, a node that was removed.
#include <algorithm>

#include "libpicture/live/stages.h"

namespace picture::live {

namespace {

// A shape of fewer pixels may only have been missed by the samples of this frame.
constexpr uint32_t leastPixels = 8;
// Numbers of shapes as RT_NAME has them: beyond, floats are not exact.
constexpr float mostNames = 1 << 24;

bool isNumber(float name) { return name >= 0 && name < mostNames; }

// Calls use(name, begin, end) for each run of pixels in a row that have one name.
template <class Use>
void forEachRun(const Layout& layout, const Plane& names, int y, const Use& use) {
  const size_t row = layout.row(y), end = row + size_t(layout.width);
  for (size_t i = row; i < end;) {
    const size_t begin = i;
    while (i < end && names[i] == names[begin]) i++;
    if (isNumber(names[begin])) use(size_t(names[begin]), begin, i);
    if (i == begin) i++; // a name that is not a number is not equal to itself
  }
}

// Counts the pixels of each shape.
void countNames(const Moment& moment, std::vector<uint32_t>& pixels) {
  std::fill(pixels.begin(), pixels.end(), 0);
  for (int y = 0; y < moment.layout.height; y++)
    forEachRun(moment.layout, moment.guides.name, y, [&](size_t name, size_t begin, size_t end) {
      if (name >= pixels.size()) pixels.resize(name + 1);
      pixels[name] += uint32_t(end - begin);
    });
}

} // namespace

void NamesSeen::markGone(const Moment& before, const Moment& now, Shown& shown) {
  countNames(before, before_);
  countNames(now, now_);
  now_.resize(std::max(now_.size(), before_.size()));
  const auto isGoneNow = [this](size_t name) {
    return name < before_.size() && before_[name] >= leastPixels && now_[name] == 0;
  };
  bool any = false;
  for (size_t name = 0; name < before_.size(); name++) any |= isGoneNow(name);
  if (!any) return;
  Surfaces& surfaces = shown.surfaces;
  for (int y = 0; y < shown.layout.height; y++)
    forEachRun(shown.layout, surfaces.name, y, [&](size_t name, size_t begin, size_t end) {
      if (isGoneNow(name))
        std::fill(surfaces.moves.begin() + ptrdiff_t(begin),
                  surfaces.moves.begin() + ptrdiff_t(end), isGone);
    });
}

} // namespace picture::live
