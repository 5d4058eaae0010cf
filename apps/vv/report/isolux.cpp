#include "report/isolux.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "libpicture/false_colour.h"

namespace vv {

namespace {

using picture::LuminanceScale;
using picture::Measurement;

constexpr int mostCells = 96;    // along a side; larger grids are drawn as means
constexpr int mostNumbers = 400; // points with their number
constexpr double width = 640, legend = 90, most = 480; // units of the drawing

// Values by cell, NaN where there is none.
struct Grid {
  int columns = 0, rows = 0;
  std::vector<double> values;
  std::vector<char> doubtful;
  double at(int column, int row) const {
    return values[size_t(row) * size_t(columns) + size_t(column)];
  }
};

// Returns the means of blocks of points that are small enough for at most mostCells along a side.
Grid gridOf(const Measurement& m) {
  const int block = (std::max(m.sensor.columns, m.sensor.rows) + mostCells - 1) / mostCells;
  Grid grid;
  grid.columns = (m.sensor.columns + block - 1) / block;
  grid.rows = (m.sensor.rows + block - 1) / block;
  const size_t count = size_t(grid.columns) * size_t(grid.rows);
  std::vector<double> sums(count);
  std::vector<int> counts(count);
  grid.doubtful.resize(count);
  for (size_t i = 0; i < m.value.size(); ++i) {
    const size_t column = i % size_t(m.sensor.columns), row = i / size_t(m.sensor.columns),
                 cell = row / size_t(block) * size_t(grid.columns) + column / size_t(block);
    if (m.samples[i] == 0 || !std::isfinite(m.value[i])) continue;
    sums[cell] += double(m.value[i]);
    ++counts[cell];
    if (!m.trusted[i]) grid.doubtful[cell] = 1;
  }
  for (size_t i = 0; i < count; ++i)
    grid.values.push_back(counts[i] ? sums[i] / counts[i]
                                    : std::numeric_limits<double>::quiet_NaN());
  return grid;
}

struct Point {
  double x, y;
};
using Segment = std::array<Point, 2>;

// Returns the lines of one level, in units of cells, by marching squares between the middles of
// four cells. The mean of the four decides where two lines cross such a square.
std::vector<Segment> isolines(const Grid& grid, double level) {
  std::vector<Segment> out;
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const double v[4] = {grid.at(column, row), grid.at(column + 1, row),
                           grid.at(column + 1, row + 1), grid.at(column, row + 1)};
      const Point corners[4] = {{column + .5, row + .5},
                                {column + 1.5, row + .5},
                                {column + 1.5, row + 1.5},
                                {column + .5, row + 1.5}};
      if (!std::isfinite(v[0] + v[1] + v[2] + v[3])) continue;
      Point cut[4];
      int edges[4], count = 0;
      for (int i = 0; i < 4; ++i) {
        const int k = (i + 1) % 4;
        if ((v[i] < level) == (v[k] < level)) continue;
        const double t = (level - v[i]) / (v[k] - v[i]);
        cut[i] = {corners[i].x + t * (corners[k].x - corners[i].x),
                  corners[i].y + t * (corners[k].y - corners[i].y)};
        edges[count++] = i;
      }
      if (count == 2) out.push_back({cut[edges[0]], cut[edges[1]]});
      if (count != 4) continue;
      const bool joins = ((v[0] + v[1] + v[2] + v[3]) / 4 < level) == (v[0] < level);
      out.push_back({cut[0], cut[joins ? 1 : 3]});
      out.push_back({cut[2], cut[joins ? 3 : 1]});
    }
  return out;
}

// Returns a colour half way to white, so that numbers can be read on it.
std::string colourOf(double share) {
  const std::array<float, 3> c = picture::scaleColour(share);
  const auto byte = [](float v) { return int(std::lround(127.5 + 127.5 * double(v))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c[0]), byte(c[1]), byte(c[2]));
}

std::string numberOf(double value) {
  return value >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

// How large a cell is drawn.
struct Sizes {
  double x = 0, y = 0;
};

void addCells(const Grid& grid, const LuminanceScale& scale, Sizes cell, std::string& out) {
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (const double value = grid.at(column, row); std::isfinite(value))
        out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                           "fill=\"{}\"/>\n",
                           column * cell.x, row * cell.y, cell.x + .2, cell.y + .2,
                           colourOf(value / scale.top));
}

void addLines(const Grid& grid, const LuminanceScale& scale, Sizes cell, std::string& out) {
  const int levels = int(std::lround(scale.top / scale.step));
  for (int i = 1; i < levels; ++i) {
    const std::vector<Segment> lines = isolines(grid, i * scale.step);
    if (lines.empty()) continue;
    out += "<path fill=\"none\" stroke=\"#111\" stroke-width=\"1\" d=\"";
    for (const Segment& line : lines)
      out += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", line[0].x * cell.x, line[0].y * cell.y,
                         line[1].x * cell.x, line[1].y * cell.y);
    // in turn at a quarter, a half and three quarters, so that labels of neighbours lie apart
    const Point at = lines[lines.size() * size_t(1 + i % 3) / 4][0];
    out += fmt::format("\"/>\n<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\" stroke=\"#fff\" "
                       "stroke-width=\"3\" paint-order=\"stroke\">{:g}</text>\n",
                       at.x * cell.x, at.y * cell.y - 3, i * scale.step);
  }
}

// Adds the number of each point; a question mark stands behind those that are not trusted.
void addNumbers(const Grid& grid, Sizes cell, std::string& out) {
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (const double value = grid.at(column, row); std::isfinite(value))
        out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"#333\">{}{}</text>\n",
                           (column + .5) * cell.x, (row + .5) * cell.y + 4, numberOf(value),
                           grid.doubtful[size_t(row * grid.columns + column)] ? "?" : "");
}

void addLegend(const LuminanceScale& scale, const char* unit, double height, std::string& out) {
  const int levels = int(std::lround(scale.top / scale.step));
  const double left = width + 12, box = std::min(18.0, (height - 20) / (levels + 1));
  out += fmt::format("<text x=\"{:.1f}\" y=\"12\" text-anchor=\"start\">{}</text>\n", left, unit);
  for (int i = 0; i <= levels; ++i) {
    const double y = 20 + (levels - i) * box;
    out += fmt::format("<rect x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"14\" height=\"{2:.1f}\" "
                       "fill=\"{3}\" stroke=\"#999\"/><text x=\"{4:.1f}\" y=\"{5:.1f}\" "
                       "text-anchor=\"start\">{6:g}</text>\n",
                       left, y, box, colourOf(double(i) / levels), left + 20, y + box / 2 + 4,
                       i * scale.step);
  }
}

double sizeOf(const double v[3]) { return std::hypot(v[0], v[1], v[2]); }

} // namespace

std::string isoluxPicture(const Measurement& m) {
  if (m.sensor.columns < 2 || m.sensor.rows < 2) return {};
  const Grid grid = gridOf(m);
  double highest = 0;
  for (const double value : grid.values)
    if (std::isfinite(value)) highest = std::max(highest, value);
  if (!(highest > 0)) return {};
  const LuminanceScale scale = picture::luminanceScale(highest);
  const double across = sizeOf(m.sensor.column) * m.sensor.columns,
               down = sizeOf(m.sensor.row) * m.sensor.rows;
  const double height = std::clamp(width * down / across, 60.0, most);
  const Sizes cell{width / grid.columns, height / grid.rows};
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"11\" text-anchor=\"middle\">\n",
      width + legend, height);
  addCells(grid, scale, cell, out);
  const bool hasAll = grid.columns == m.sensor.columns && grid.rows == m.sensor.rows;
  if (hasAll && grid.columns <= 20 && grid.columns * grid.rows <= mostNumbers)
    addNumbers(grid, cell, out);
  addLines(grid, scale, cell, out);
  addLegend(scale, picture::infoOf(m.sensor.quantity).unit, height, out);
  return out + "</svg>\n";
}

} // namespace vv
