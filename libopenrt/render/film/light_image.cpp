#include "render/film/light_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/wave/light_stride.h"

namespace openrt {
namespace {

constexpr uint32_t smallest = 2, largest = 8; // reach of windows

} // namespace

uint32_t LightImage::partsOf(const edit::FrameSettingsT& frame) {
  constexpr uint32_t ofPreviews = 4;
  return lightStrideOf(frame) > 1 ? ofPreviews : parts;
}

LightImage::LightImage(uint32_t width, uint32_t height, uint32_t all, Kept kept)
    : width_(width), height_(height), all_(all), kept_(kept), waiting_(all) {
  const size_t pixels = size_t(width) * height;
  if (kept == Kept::means)
    means_.resize(pixels);
  else
    pixels_.resize(pixels);
}

void LightImage::add(uint32_t number, std::vector<float>&& part) {
  std::unique_lock turn(turn_);
  if (number >= waiting_.size()) waiting_.resize(number + 1);
  waiting_[number] = std::move(part);
  if (adding_) return; // another thread is adding parts and will find this one
  adding_ = true;
  for (uint32_t next; (next = added_) < waiting_.size() && !waiting_[next].empty();) {
    const std::vector<float> now = std::move(waiting_[next]);
    waiting_[next].clear();
    turn.unlock();
    addNow(now, next);
    turn.lock();
  }
  adding_ = false;
}

void LightImage::addNow(const std::vector<float>& part, double number) {
  std::unique_lock lock(sums_);
  for (size_t i = 0; i < means_.size(); i++)
    for (size_t k = 0; k < 3; k++) means_[i][k] += (part[3 * i + k] - means_[i][k]) / (number + 1);
  for (size_t i = 0; i < pixels_.size(); i++) // B. P. Welford, Technometrics 4(3), 1962
    for (int k = 0; k < 3; k++) {
      Pixel& p = pixels_[i];
      const double x = part[3 * i + size_t(k)], d = x - p.mean[k];
      p.mean[k] += d / (number + 1);
      p.squares[k] += d * (x - p.mean[k]);
    }
  added_.fetch_add(1, std::memory_order_release);
  if (kept_ == Kept::sensors) summarise();
}

// Computes what all cells have in common. If paths leave w each in a cell, and n of them cross it
// on average, mean and variance are n w and n w^2.
void LightImage::summarise() {
  double mean = 0, variances = 0;
  brightest_ = 0;
  for (const Pixel& p : pixels_) {
    mean += p.mean[0];
    variances += variance(p, 0);
    brightest_ = std::max(brightest_, p.mean[0]);
  }
  ofOnePath_ = mean > 0 && std::isfinite(variances) ? variances / mean : 0;
}

double LightImage::variance(const Pixel& pixel, int k) const {
  const double n = added_;
  return n > 1 ? pixel.squares[k] / (n * (n - 1)) : std::numeric_limits<double>::infinity();
}

// Writes the sums of a pixel and of the pixels around it. A pixel with few light paths has an
// unreliable variance (error.cpp): it uses the mean variance of its window if that is larger.
void LightImage::addWindow(uint32_t x, uint32_t y, const Window& window, LightSums& out) const {
  const auto [reach, colours] = window;
  double mean[3] = {}, variance[3] = {}, count = 0;
  for (uint32_t j = y - std::min(y, reach); j <= std::min(y + reach, height_ - 1); j++)
    for (uint32_t i = x - std::min(x, reach); i <= std::min(x + reach, width_ - 1); i++) {
      const Pixel& p = pixels_[size_t(j) * width_ + i];
      for (int k = 0; k < colours; k++) {
        mean[k] += p.mean[k];
        variance[k] += this->variance(p, k);
      }
      count++;
    }
  const Pixel& pixel = pixels_[size_t(y) * width_ + x];
  out.hits = std::numeric_limits<double>::infinity();
  out.window = count;
  for (int k = 0; k < colours; k++) {
    out.mean[k] = pixel.mean[k];
    out.variance[k] = std::max(variance[k] / count, this->variance(pixel, k));
    if (variance[k] > 0) out.hits = std::min(out.hits, mean[k] * mean[k] / variance[k]);
  }
}

// Where few light paths have come to the pixels around, the window grows until there are enough. If
// there are nowhere enough, the smallest one counts: the light of others must not make an interval
// wide that is not trusted, or that has hardly any light of such paths.
LightSums LightImage::at(uint32_t x, uint32_t y) const {
  LightSums out;
  out.parts = std::max(added(), parts);
  addWindow(x, y, {smallest, 3}, out);
  LightSums wider = out;
  for (uint32_t reach = 2 * smallest; reach <= largest && wider.hits < fewestPaths; reach *= 2)
    addWindow(x, y, {reach, 3}, wider);
  return wider.hits < fewestPaths ? out : wider;
}

// Returns the sums of a sensor. Its neighbours may stand in another light, so that its own variance
// counts if enough paths have crossed its cell, and that of the window otherwise. Where no path has
// crossed the window, the rule of three bounds what may be missing: 95 of 100 such cells get less
// than three times what one path brings.
LightSums LightImage::ofSensor(uint32_t x, uint32_t y) const {
  const Pixel& pixel = pixels_[size_t(y) * width_ + x];
  LightSums out;
  out.brightest = brightest_;
  out.parts = std::max(added(), parts);
  const double own = variance(pixel, 0);
  if (own > 0 && pixel.mean[0] * pixel.mean[0] > fewestPaths * own) {
    out.hits = pixel.mean[0] * pixel.mean[0] / own;
    out.variance[0] = own;
    out.mean[0] = pixel.mean[0];
  } else {
    addWindow(x, y, {smallest, 1}, out);
    if (!(out.variance[0] > 0) && ofOnePath_ > 0) {
      const double halfWidth = ruleOfThree * ofOnePath_;
      out.variance[0] = std::pow(halfWidth / student95(out.parts - 1), 2);
      out.hits = 0;
    }
  }
  for (int k = 1; k < 3; k++) { // all three colours of a sensor are the reading
    out.mean[k] = out.mean[0];
    out.variance[k] = out.variance[0];
  }
  return out;
}

LightImage::State LightImage::state() const {
  std::shared_lock lock(sums_);
  State out;
  out.added = added_;
  const bool squares = means_.empty();
  out.values.resize(squares ? pixels_.size() * 6 : means_.size() * 3);
  if (squares)
    std::memcpy(out.values.data(), pixels_.data(), out.values.size() * sizeof(double));
  else
    std::memcpy(out.values.data(), means_.data(), out.values.size() * sizeof(double));
  return out;
}

bool LightImage::restore(const State& state, bool complete) {
  std::unique_lock lock(sums_);
  const bool squares = means_.empty();
  if ((!complete && state.added > all_) ||
      state.values.size() != (squares ? pixels_.size() * 6 : means_.size() * 3))
    return false;
  if (squares)
    std::memcpy(static_cast<void*>(pixels_.data()), state.values.data(),
                state.values.size() * sizeof(double));
  else
    std::memcpy(means_.data(), state.values.data(), state.values.size() * sizeof(double));
  added_ = state.added;
  if (complete) all_ = state.added;
  if (kept_ == Kept::sensors && state.added > 0) summarise();
  return true;
}

// T. F. Chan, G. H. Golub, R. J. LeVeque, Updating formulae and a pairwise algorithm for computing
// sample variances, 1979.
void LightImage::merge(State& into, const State& more, Kept kept) {
  const double a = into.added, b = more.added;
  if (b == 0) return;
  const size_t each = kept == Kept::means ? 3 : 6;
  for (size_t i = 0; i < into.values.size(); i += each)
    for (size_t k = 0; k < 3; k++) {
      const double d = more.values[i + k] - into.values[i + k];
      into.values[i + k] += d * (b / (a + b));
      if (each == 6) into.values[i + 3 + k] += more.values[i + 3 + k] + d * d * (a * b / (a + b));
    }
  into.added += more.added;
}

void LightImage::read(const Tile& tile, std::vector<LightSums>& out) const {
  std::shared_lock lock(sums_);
  out.clear();
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++) {
      if (kept_ == Kept::means) {
        LightSums mean;
        std::copy_n(means_[size_t(y) * width_ + x].data(), 3, mean.mean);
        out.push_back(mean);
      } else {
        out.push_back(kept_ == Kept::sensors ? ofSensor(x, y) : at(x, y));
      }
    }
}

} // namespace openrt
