// text.cpp: Text and FontStyle (clauses 6.20, 6.47): lines of glyphs in the plane z = 0.
#include <algorithm>
#include <limits>

#include "geometry/builders.h"
#include "geometry/text/fonts.h"
#include "geometry/text/text_extent.h"
#include "geometry/vector_math.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

enum class Justify : uint8_t { first, begin, middle, end };

Justify justifyFrom(const MFString& values, size_t i, Faults& faults) {
  // Defaults: BEGIN along the line, FIRST across the lines.
  Justify otherwise = i == 0 ? Justify::begin : Justify::first;
  if (i >= values.size() || values[i].empty()) return otherwise;
  if (values[i] == "FIRST") return Justify::first;
  if (values[i] == "BEGIN") return Justify::begin;
  if (values[i] == "MIDDLE") return Justify::middle;
  if (values[i] == "END") return Justify::end;
  faults.note("FontStyle.justify must be FIRST, BEGIN, MIDDLE or END");
  return otherwise;
}

// FontStyle's fields, checked; defaults if there is no FontStyle.
struct Style {
  std::vector<std::string> families;
  bool bold = false, italic = false, horizontal = true, leftToRight = true, topToBottom = true;
  double size = 1, spacing = 1;
  Justify major = Justify::begin, minor = Justify::first;
  std::string language;

  Style(const nodes::FontStyle* node, Faults& faults) {
    if (!node) return;
    families = node->family;
    const std::string& style = node->style;
    bold = style == "BOLD" || style == "BOLDITALIC";
    italic = style == "ITALIC" || style == "BOLDITALIC";
    if (!bold && !italic && style != "PLAIN" && !style.empty())
      faults.note("FontStyle.style must be PLAIN, BOLD, ITALIC or BOLDITALIC");
    horizontal = node->horizontal;
    leftToRight = node->leftToRight;
    topToBottom = node->topToBottom;
    size = node->size;
    spacing = node->spacing;
    major = justifyFrom(node->justify, 0, faults);
    minor = justifyFrom(node->justify, 1, faults);
    language = node->language;
  }

  TextDirection direction() const {
    if (horizontal) return leftToRight ? TextDirection::leftToRight : TextDirection::rightToLeft;
    return topToBottom ? TextDirection::topToBottom : TextDirection::bottomToTop;
  }
};

// A line of text and its stretch. Its glyphs lie between 0 and `length` along the line's axis,
// whatever their direction.
struct Line {
  ShapedLine shaped;
  double length = 0; // along the axis before stretching, in em
  double stretch = 1;
  double start = 0; // smallest coordinate along the axis after stretching, in em
};

class Layout {
 public:
  Layout(const nodes::Text& node, const Style& style, Font& font, const MeshOptions& options,
         Faults& faults)
      : node_(node), style_(style), font_(font), limit_(triangleLimit(options)), faults_(faults) {}

  Mesh run() {
    shapeLines();
    fitLengths();
    placeAcross();
    for (size_t i = 0; i < lines_.size() && !full_; i++) addLine(i);
    if (mesh_.ownIndices.empty()) return {};
    mesh_.kind = Mesh::Kind::triangles;
    mesh_.solid = node_.solid; // always FALSE in VRML97 (6.47)
    mesh_.viewOwn();
    return std::move(mesh_);
  }

  TextExtent extent() {
    shapeLines();
    fitLengths();
    placeAcross();
    constexpr double most = std::numeric_limits<double>::max();
    double left = most, right = -most, low = most, high = -most;
    TextExtent extent;
    for (size_t i = 0; i < lines_.size(); i++) {
      const double across = offset_ + double(i) * step_, begin = lines_[i].start,
                   end = begin + lines_[i].length * lines_[i].stretch;
      const double x[] = {style_.horizontal ? begin : across, style_.horizontal ? end : across + 1};
      const double y[] = {style_.horizontal ? across + font_.descender() : begin,
                          style_.horizontal ? across + font_.ascender() : end};
      extent.lines.push_back({scaled(x[1] - x[0]), scaled(y[1] - y[0])});
      left = std::min(left, x[0]);
      right = std::max(right, x[1]);
      low = std::min(low, y[0]);
      high = std::max(high, y[1]);
    }
    extent.text = {scaled(right - left), scaled(high - low)};
    extent.origin = {scaled(left), scaled(high), 0};
    return extent;
  }

 private:
  float scaled(double em) const { return float(em * style_.size); }

  void shapeLines() {
    for (const std::string& string : node_.string) {
      Line line;
      if (string.size() < (1u << 30))
        line.shaped = font_.shape(string, style_.direction(), style_.language);
      line.length = std::abs(style_.horizontal ? line.shaped.advanceX : line.shaped.advanceY);
      lines_.push_back(std::move(line));
    }
  }

  // Stretches each line to its length, then compresses all lines equally to maxExtent (clause
  // 6.47).
  void fitLengths() {
    double longest = 0;
    for (size_t i = 0; i < lines_.size(); i++) {
      double wanted = i < node_.length.size() ? node_.length[i] / style_.size : 0;
      if (wanted > 0 && std::isfinite(wanted) && lines_[i].length > 0)
        lines_[i].stretch = wanted / lines_[i].length;
      longest = std::max(longest, lines_[i].length * lines_[i].stretch);
    }
    double most = node_.maxExtent / style_.size;
    double factor = most > 0 && longest > most ? most / longest : 1;
    for (Line& line : lines_) {
      line.stretch *= factor;
      line.start = startAlong(line.length * line.stretch);
    }
  }

  // Returns the start of a line for the major alignment (tables of clause 6.20.3).
  double startAlong(double length) const {
    bool towardsPlus = style_.horizontal ? style_.leftToRight : !style_.topToBottom;
    switch (style_.major) {
    case Justify::middle: return -length / 2;
    case Justify::end: return towardsPlus ? -length : 0;
    default: return towardsPlus ? 0 : -length;
    }
  }

  // Applies the minor alignment to the whole block. `offset_` is the position of the first line's
  // baseline (horizontal) or left edge (vertical).
  void placeAcross() {
    double extra = double(lines_.size() - 1) * style_.spacing;
    if (style_.horizontal) {
      step_ = style_.topToBottom ? -style_.spacing : style_.spacing;
      // Extents of a line, relative to its baseline.
      double top = font_.ascender(), bottom = font_.descender();
      double high = style_.topToBottom ? top : top + extra,
             low = style_.topToBottom ? bottom - extra : bottom;
      switch (style_.minor) {
      case Justify::first: offset_ = 0; break;
      case Justify::begin: offset_ = style_.topToBottom ? -high : -low; break;
      case Justify::middle: offset_ = -(high + low) / 2; break;
      case Justify::end: offset_ = style_.topToBottom ? -low : -high; break;
      }
      return;
    }
    step_ = style_.leftToRight ? style_.spacing : -style_.spacing;
    double left = style_.leftToRight ? 0 : -extra,
           right = style_.leftToRight ? 1 + extra : 1; // columns are one em wide
    switch (style_.minor) {
    case Justify::middle: offset_ = -(left + right) / 2; break;
    case Justify::end: offset_ = style_.leftToRight ? -right : -left; break;
    default: offset_ = style_.leftToRight ? -left : -right; break;
    }
  }

  // Returns a glyph origin in em: stretched along the line; across it relative to the baseline, or
  // to the column's middle if vertical.
  V2d place(const Line& line, size_t index, const V2d& p) const {
    double across = offset_ + double(index) * step_;
    if (style_.horizontal) return {line.start + p.x * line.stretch, across + p.y};
    // The pen runs down (or up) from 0, so the lowest point of the line is -length (or 0).
    double low = line.shaped.advanceY < 0 ? -line.length : 0;
    return {across + 0.5 + p.x, line.start + (p.y - low) * line.stretch};
  }

  void addLine(size_t index) {
    const Line& line = lines_[index];
    // The texture's origin is that of the first string (clause 6.47).
    V2d origin = place(lines_[0], 0, V2d(0, 0));
    for (const PlacedGlyph& placed : line.shaped.glyphs) {
      const GlyphMesh& glyph = font_.glyph(placed.glyph);
      if ((mesh_.ownIndices.size() + glyph.indices.size()) / 3 > limit_) {
        faults_.add(Fault::overLimit, index);
        full_ = true;
        return;
      }
      uint32_t first = uint32_t(mesh_.ownPoints.size());
      for (const Vec2f& p : glyph.points) {
        V2d at = place(line, index, {placed.x + p.x, placed.y + p.y});
        mesh_.ownPoints.push_back({float(at.x * style_.size), float(at.y * style_.size), 0});
        mesh_.ownTexCoords.push_back({float(at.x - origin.x), float(at.y - origin.y)});
      }
      for (size_t i = 0; i + 2 < glyph.indices.size(); i += 3)
        addTriangle(first, &glyph.indices[i]);
    }
  }

  // Adds a triangle unless strong compression has left it without area.
  void addTriangle(uint32_t first, const uint32_t* at) {
    const auto& p = mesh_.ownPoints;
    if (hasArea(p[first + at[0]], p[first + at[1]], p[first + at[2]]))
      mesh_.ownIndices.insert(mesh_.ownIndices.end(),
                              {first + at[0], first + at[1], first + at[2]});
  }

  const nodes::Text& node_;
  const Style& style_;
  Font& font_;
  uint64_t limit_;
  Faults& faults_;
  std::vector<Line> lines_;
  double offset_ = 0, step_ = 0;
  bool full_ = false;
  Mesh mesh_;
};

} // namespace

// Calls use(style, font) if the text can be laid out.
template <class Use> static void withFont(const nodes::Text& node, Faults& faults, const Use& use) {
  if (node.string.empty()) return;
  Style style(nodeCast<nodes::FontStyle>(renderedNode(node.fontStyle.get())), faults);
  if (!(style.size > 0) || !(style.size < 1e30) || !(std::abs(style.spacing) < 1e30)) {
    faults.note("FontStyle.size must be positive and spacing finite; nothing is drawn");
    return;
  }
  std::lock_guard lock(fontsMutex());
  Font* font = findFont(style.families, style.bold, style.italic, style.language);
  if (!font) {
    faults.note("no font is installed (fonts-dejavu-core on Debian); nothing is drawn");
    return;
  }
  use(style, *font);
}

Mesh buildText(const nodes::Text& node, const MeshOptions& options, Faults& faults) {
  Mesh mesh;
  withFont(node, faults, [&](const Style& style, Font& font) {
    mesh = Layout(node, style, font, options, faults).run();
  });
  if (!allFinite(mesh.points) || !allFinite(mesh.texCoords)) {
    faults.note("text is too large; nothing is drawn");
    return {};
  }
  return mesh;
}

TextExtent extentOf(const nodes::Text& node) {
  TextExtent extent;
  Faults faults; // reported where the mesh is built
  withFont(node, faults, [&](const Style& style, Font& font) {
    extent = Layout(node, style, font, {}, faults).extent();
  });
  const bool finite = allFinite(std::span<const Vec2f>(extent.lines)) && isFinite(extent.text) &&
                      isFinite(extent.origin);
  return finite ? extent : TextExtent();
}

} // namespace xvrml
