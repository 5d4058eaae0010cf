#include "render/lights/sky_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "render/lights/luminance.h"
#include "render/wave/batch.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr uint32_t coarsest = 512, finest = 4096; // columns
// A sky is not sampled if less than this share of its light is above the mean, and no cell is
// brighter than `mostContrast` times the mean. BSDF sampling finds such a sky with little noise. It
// would rarely find a small sun, however little of the light that sends.
constexpr double leastShare = 1.0 / 64, mostContrast = 4;
// The sun are the cells that are so many times brighter than the mean, and so at most an eighth of
// the sphere. There is none if they have less than this share of the light: light paths that start
// there would bring little.
constexpr double sunContrast = 8, leastSun = 1.0 / 16;

// Returns the number of columns: as many as the widest texture has texels around the horizon. A
// single texture covers the whole horizon, one of several covers a quarter.
uint32_t columnsFor(const RenderScene& scene) {
  const ShaderSlot& environment = scene.environment.shader;
  uint32_t widest = 0, pictures = 0;
  for (uint32_t i = 0; i < environment.shaderClass->paramCount; i++) {
    const RtsParam& param = environment.shaderClass->params[i];
    if (param.type != RTS_TEXTURE) continue;
    RtsTexture number;
    std::memcpy(&number, static_cast<const char*>(environment.params) + param.offset,
                sizeof number);
    if (number == 0 || number >= scene.textures->size()) continue;
    widest = std::max(widest, (*scene.textures)[number].width());
    pictures++;
  }
  return std::bit_ceil(
      std::clamp((pictures > 1 ? 4 : 1) * std::min(widest, finest), coarsest, finest));
}

} // namespace

double SkySampler::solidAngle(uint32_t row) const {
  return 2 * M_PI / columns_ * (edge_[row] - edge_[row + 1]);
}

// Evaluates the environment in four directions of each cell.
double SkySampler::measure(const RenderScene& scene, std::vector<float>& cells) const {
  const ShaderSlot& environment = scene.environment.shader;
  Arena arena;
  const uint32_t n = 4 * columns_;
  float *d[3], *rgba[4];
  for (auto& a : d) a = arena.take<float>(n);
  for (auto& a : rgba) a = arena.take<float>(n);
  std::vector<double> turn(2 * size_t(n));
  for (uint32_t i = 0; i < n; i++) {
    const double phi = 2 * M_PI * (i / 4 + (i / 2 % 2 ? 0.75 : 0.25)) / columns_;
    turn[2 * i] = std::cos(phi);
    turn[2 * i + 1] = std::sin(phi);
  }
  RayCounters counters;
  double brightest = 0;
  for (uint32_t row = 0; row < rows_; row++) {
    ArenaScope scope(arena);
    RtsBatch batch({scene, arena, counters});
    batch.lanes.count = n;
    const double theta[2] = {M_PI * (row + 0.25) / rows_, M_PI * (row + 0.75) / rows_};
    const double sine[2] = {std::sin(theta[0]), std::sin(theta[1])},
                 cosine[2] = {std::cos(theta[0]), std::cos(theta[1])};
    for (uint32_t i = 0; i < n; i++) {
      d[0][i] = float(sine[i % 2] * turn[2 * i]);
      d[1][i] = float(cosine[i % 2]);
      d[2][i] = float(sine[i % 2] * turn[2 * i + 1]);
    }
    for (auto& a : rgba) std::fill_n(a, n, 0.0f);
    const float* directions[3] = {d[0], d[1], d[2]};
    {
      const RunningShader running(*environment.shaderClass);
      environment.shaderClass->miss(&scene.host, &batch, environment.params, n, directions, rgba);
    }
    for (uint32_t column = 0; column < columns_; column++) {
      double mean = 0, sum = 0;
      for (uint32_t i = 4 * column; i < 4 * column + 4; i++) {
        const Vec3f c = load(rgba, i);
        mean += luminance(c) / 4;
        sum += (double(c[0]) + double(c[1]) + double(c[2])) / 4;
      }
      if (std::isfinite(sum)) brightest = std::max(brightest, sum);
      cells[size_t(row) * columns_ + column] = float(mean);
    }
  }
  return brightest;
}

bool SkySampler::shines(const RenderScene& scene) {
  SkySampler coarse;
  coarse.columns_ = 64;
  coarse.rows_ = 8; // measure() takes four directions in each cell
  std::vector<float> cells(size_t(coarse.columns_) * coarse.rows_);
  coarse.measure(scene, cells);
  return std::any_of(cells.begin(), cells.end(), [](float mean) { return mean > 0; });
}

SkySampler::SkySampler(const RenderScene& scene) {
  const ShaderSlot& environment = scene.environment.shader;
  if (!environment.shaderClass || !environment.shaderClass->miss) return;
  columns_ = columnsFor(scene);
  rows_ = columns_ / 2;
  for (uint32_t row = 0; row <= rows_; row++) edge_.push_back(std::cos(M_PI * row / rows_));
  std::vector<float> cells(size_t(columns_) * rows_);
  brightest_ = measure(scene, cells);
  for (uint32_t row = 0; row < rows_; row++) {
    const float* of = cells.data() + size_t(row) * columns_;
    emitted_ += std::accumulate(of, of + columns_, 0.0) * solidAngle(row);
  }
  const double mean = emitted_ / (4 * M_PI);
  // A cell beside a much brighter one may contain some of its light between the sampled directions.
  const auto beside = [&](uint32_t row, uint32_t column) {
    float most = 0;
    for (int y = -1; y <= 1; y++)
      for (int x = -1; x <= 1; x++) {
        const uint32_t r = uint32_t(std::clamp(int(row) + y, 0, int(rows_) - 1)),
                       c = (column + columns_ + uint32_t(x)) % columns_;
        most = std::max(most, cells[size_t(r) * columns_ + c]);
      }
    return most;
  };
  inRow_.resize(cells.size());
  byRow_.resize(rows_);
  std::vector<double> mass(columns_);
  std::vector<float> expected(cells.size()); // radiance that a cell may have
  for (uint32_t row = 0; row < rows_; row++) {
    double sum = 0;
    for (uint32_t column = 0; column < columns_; column++) {
      const size_t cell = size_t(row) * columns_ + column;
      expected[cell] = std::max(cells[cell], beside(row, column) / 16);
      mass[column] = sum += std::max(double(expected[cell]) - mean, 0.0);
    }
    float* shares = inRow_.data() + size_t(row) * columns_;
    for (uint32_t column = 0; column < columns_; column++)
      shares[column] = sum > 0 ? float(mass[column] / sum) : 0;
    byRow_[row] = total_ += sum * solidAngle(row);
  }
  const double most = *std::max_element(cells.begin(), cells.end());
  if (!(total_ > leastShare * emitted_ || most > mostContrast * mean)) total_ = 0;
  for (double& share : byRow_) share /= total_ > 0 ? total_ : 1;
  if (total_ > 0) listSun(expected);
}

// radiance: by cell.
void SkySampler::listSun(const std::vector<float>& radiance) {
  const double least = sunContrast * emitted_ / (4 * M_PI);
  double sum = 0;
  for (size_t cell = 0; cell < radiance.size(); cell++) {
    if (!(double(radiance[cell]) > least)) continue;
    sum += double(radiance[cell]) * solidAngle(uint32_t(cell / columns_));
    sun_.push_back({uint32_t(cell), sum});
  }
  if (sum < leastSun * emitted_ || !std::isfinite(sum)) sun_.clear();
}

float SkySampler::cellPdf(uint32_t row, uint32_t column) const {
  const float* shares = inRow_.data() + size_t(row) * columns_;
  const double inRow = double(shares[column]) - (column ? shares[column - 1] : 0.0f);
  return float((byRow_[row] - (row ? byRow_[row - 1] : 0.0)) * inRow / solidAngle(row));
}

// Selects row and column by u and v, and uses their remainders for the position in the cell.
float SkySampler::sample(double u, double v, Vec3f& direction) const {
  if (!usable()) return 0;
  const auto row = uint32_t(std::min(
      std::upper_bound(byRow_.begin(), byRow_.end(), v) - byRow_.begin(), ptrdiff_t(rows_) - 1));
  const float* shares = inRow_.data() + size_t(row) * columns_;
  const auto column = uint32_t(
      std::min(std::upper_bound(shares, shares + columns_, u) - shares, ptrdiff_t(columns_) - 1));
  const double before = row ? byRow_[row - 1] : 0, left = column ? shares[column - 1] : 0;
  const double down = std::clamp((v - before) / (byRow_[row] - before), 0.0, 1.0);
  const double along = std::clamp((u - left) / (shares[column] - left), 0.0, 1.0);
  direction = directionIn(row, column, down, along);
  return cellPdf(row, column);
}

Vec3f SkySampler::directionIn(uint32_t row, uint32_t column, double down, double along) const {
  const double y = edge_[row] + (edge_[row + 1] - edge_[row]) * down,
               phi = 2 * M_PI * (column + along) / columns_;
  const double s = std::sqrt(std::max(0.0, 1 - y * y));
  return {float(s * std::cos(phi)), float(y), float(s * std::sin(phi))};
}

bool SkySampler::cellOf(const Vec3f& d, uint32_t& row, uint32_t& column) const {
  const double theta = std::acos(std::clamp(double(d.y), -1.0, 1.0));
  double phi = std::atan2(double(d.z), double(d.x));
  if (phi < 0) phi += 2 * M_PI;
  if (!(theta >= 0) || !(phi >= 0)) return false;
  row = std::min(uint32_t(theta / M_PI * rows_), rows_ - 1);
  column = std::min(uint32_t(phi / (2 * M_PI) * columns_), columns_ - 1);
  return true;
}

float SkySampler::pdf(const Vec3f& direction) const {
  uint32_t row, column;
  return usable() && cellOf(direction, row, column) ? cellPdf(row, column) : 0;
}

double SkySampler::sampleSun(double pick, double u, double v, Vec3f& direction) const {
  const double at = pick * sun_.back().cumulative;
  const auto found =
      std::upper_bound(sun_.begin(), sun_.end() - 1, at,
                       [](double value, const SunCell& cell) { return value < cell.cumulative; });
  const uint32_t row = found->cell / columns_, column = found->cell % columns_;
  const double before = found == sun_.begin() ? 0 : (found - 1)->cumulative;
  direction = directionIn(row, column, u, v);
  return (found->cumulative - before) / sun_.back().cumulative / solidAngle(row);
}

bool SkySampler::isInSun(const Vec3f& direction) const {
  uint32_t row, column;
  if (sun_.empty() || !cellOf(direction, row, column)) return false;
  const uint32_t cell = row * columns_ + column;
  const auto at = std::lower_bound(sun_.begin(), sun_.end(), cell,
                                   [](const SunCell& c, uint32_t value) { return c.cell < value; });
  return at != sun_.end() && at->cell == cell;
}

} // namespace openrt
