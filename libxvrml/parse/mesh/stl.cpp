// stl.cpp: reads STL, text and binary (3D Systems, StereoLithography Interface Specification,
// 1989). Each solid becomes a Shape with an IndexedFaceSet, whose equal vertices are welded. The
// normals of facets follow from their vertices. Colours of facets are those of VisCAM and
// SolidView, or of Materialise Magics, which use the attribute bytes.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "parse/encodings.h"
#include "parse/mesh/bare_shape.h"
#include "parse/mesh/mesh_file.h"
#include "parse/mesh/node_stream.h"
#include "parse/mesh/text_cursor.h"
#include "parse/mesh/weld.h"
#include "parse/source.h"

namespace xvrml {
namespace {

constexpr size_t headBytes = 84, facetBytes = 50;

struct Solid {
  std::string_view name;
  std::vector<Vec3f> corners; // three for each facet
  std::vector<Color> colors;  // one for each facet; empty: none
};

// Whether a word is a keyword, in any case of letters.
bool is(std::string_view word, std::string_view keyword) {
  return word.size() == keyword.size() &&
         std::equal(word.begin(), word.end(), keyword.begin(),
                    [](char a, char b) { return a == b || (a >= 'A' && a <= 'Z' && a + 32 == b); });
}

// Reads one of the two spellings of a statement's end behind its first word: "endloop" or "end
// loop". Moves behind both words if they are these.
bool ends(TextCursor& text, std::string_view first, std::string_view what) {
  if (first.size() > 3 && is(first.substr(0, 3), "end")) return is(first.substr(3), what);
  if (!is(first, "end")) return false;
  const char* const before = text.at();
  if (is(text.word(), what)) return true;
  text.seek(before);
  return false;
}

// Reads the name of a solid: the rest of the line, or what stands before the first facet or the end
// if these are in the same line. Names may hold the word facet.
std::string_view nameOfSolid(TextCursor& text) {
  text.skipBlanks();
  const char* const from = text.at();
  const char* to = from;
  while (!text.atLineEnd()) {
    const char* const before = text.at();
    const std::string_view word = text.word();
    const char* const behind = text.at();
    const bool facet = is(word, "facet");
    const std::string_view next = facet ? text.word() : std::string_view();
    if (is(word, "endsolid") || (facet && (is(next, "normal") || is(next, "outer")))) {
      text.seek(before);
      break;
    }
    text.seek(to = behind);
  }
  return {from, size_t(to - from)};
}

bool isFinite(const Vec3f& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void writeSolid(const MeshFile& file, NodeStream& nodes, PointRange& range, Solid&& solid) {
  if (solid.corners.empty()) return;
  if (solid.corners.size() > INT32_MAX / 2)
    throw MeshFault{
        nullptr, fmt::format("{} triangles in one solid are too many", solid.corners.size() / 3)};
  Scratch scratch(file.budget);
  const size_t facets = solid.corners.size() / 3;
  scratch.take(weldBytes(solid.corners.size()) + facets * 4 * sizeof(int32_t));
  const std::vector<uint32_t> index = weldPoints(solid.corners);
  solid.corners.shrink_to_fit();
  range.add(solid.corners);
  MFInt32 coordIndex(4 * facets);
  for (size_t i = 0; i < facets; ++i) {
    for (size_t k = 0; k < 3; ++k) coordIndex[4 * i + k] = int32_t(index[3 * i + k]);
    coordIndex[4 * i + 3] = -1;
  }
  BareShape shape;
  shape.name = solid.name;
  shape.points = std::move(solid.corners);
  shape.coordIndex = std::move(coordIndex);
  shape.colors = std::move(solid.colors);
  shape.colorPerVertex = false;
  writeBareShape(nodes, std::move(shape));
}

// "solid name", facets of "facet normal x y z", "outer loop", three times "vertex x y z",
// "endloop", "endfacet", then "endsolid name"; in any case of letters, on any lines or all in one.
class TextReader {
 public:
  explicit TextReader(const MeshFile& file)
      : file_(file), nodes_(file), text_(withoutDosEnd(file.bytes)), scratch_(file.budget) {}

  void read() {
    for (text_.skipSpace(); !text_.atEnd(); text_.skipSpace()) statement();
    if (open_) {
      file_.locator.error(text_.at(), "the file ends within a solid: expected endsolid");
      finish();
    }
    bad_.report(file_.locator, Severity::error,
                "facets are left out, because they do not have three vertices of three numbers");
    range_.report(file_.locator);
    unknown_.report(file_.locator, Severity::error,
                    "lines are left out: expected a statement of an STL file (facet, vertex, "
                    "endsolid)");
  }

 private:
  void statement() {
    const char* at = text_.at();
    const std::string_view word = text_.word();
    if (is(word, "vertex")) {
      Vec3f p;
      const bool good = text_.number(p.x) && text_.number(p.y) && text_.number(p.z);
      if (!good) skipToKeyword();
      if (good && vertices_ < 3) facet_[vertices_] = p;
      vertices_ += good ? 1 : 4; // 4: the facet is bad
    } else if (is(word, "facet")) {
      facetAt_ = at;
      vertices_ = 0;
      skipToKeyword(); // the normal follows from the vertices
    } else if (ends(text_, word, "facet")) {
      endFacet();
    } else if (is(word, "solid")) {
      if (open_) finish();
      open_ = true;
      solid_.name = nameOfSolid(text_);
    } else if (ends(text_, word, "solid")) {
      skipNameBehindEnd();
      finish();
    } else if (!is(word, "outer") && !is(word, "loop") && !ends(text_, word, "loop")) {
      unknown_.add(at);
      text_.nextLine();
    }
  }

  // Skips what is left of a statement. The next one may stand in the same line.
  void skipToKeyword() {
    constexpr std::string_view keywords[] = {"outer", "vertex", "endloop",  "endfacet",
                                             "end",   "facet",  "endsolid", "solid"};
    while (!text_.atLineEnd()) {
      const char* const before = text_.at();
      const std::string_view word = text_.word();
      if (std::any_of(std::begin(keywords), std::end(keywords),
                      [&](std::string_view one) { return is(word, one); }))
        return text_.seek(before);
    }
  }

  // The name of the solid follows, then perhaps the next solid in the same line.
  void skipNameBehindEnd() {
    text_.skipBlanks();
    const std::string_view name = solid_.name;
    if (!name.empty() &&
        std::string_view(text_.at(), size_t(text_.end() - text_.at())).starts_with(name))
      text_.seek(text_.at() + name.size());
    const char* const before = text_.at();
    if (is(text_.word(), "solid"))
      text_.seek(before);
    else
      text_.nextLine();
  }

  void endFacet() {
    if (vertices_ != 3) return bad_.add(facetAt_);
    if (solid_.corners.size() == solid_.corners.capacity())
      scratch_.take(std::max<size_t>(1024, solid_.corners.size()) * sizeof(Vec3f));
    solid_.corners.insert(solid_.corners.end(), facet_, facet_ + 3);
    vertices_ = 0;
  }

  void finish() {
    writeSolid(file_, nodes_, range_, std::move(solid_));
    solid_ = {};
    open_ = false;
  }

  const MeshFile& file_;
  NodeStream nodes_;
  TextCursor text_;
  Scratch scratch_;
  Solid solid_;
  bool open_ = false;
  Vec3f facet_[3];
  int vertices_ = 0;
  const char* facetAt_ = nullptr;
  FaultCount bad_, unknown_;
  PointRange range_;
};

// Colours of facets in 15 bits. Magics: the header holds "COLOR=" with red, green, blue, alpha;
// bit 15 of a facet says that it has that colour, else bits 0-4 are red. VisCAM: bit 15 says that
// the facet has a colour of its own, whose bits 0-4 are blue.
class FacetColors {
 public:
  explicit FacetColors(std::string_view head) {
    const size_t at = head.find("COLOR=");
    magics_ = at != head.npos && at + 10 <= head.size();
    for (int i = 0; magics_ && i < 3; ++i)
      whole_[i] = float(static_cast<unsigned char>(head[at + 6 + i])) / 255;
  }
  bool has(uint16_t bits) const { return magics_ || (bits & 0x8000); }
  Color of(uint16_t bits) const {
    const auto part = [bits](int shift) { return float(bits >> shift & 31) / 31; };
    if (magics_ && (bits & 0x8000)) return {whole_[0], whole_[1], whole_[2]};
    if (magics_) return {part(0), part(5), part(10)};
    if (bits & 0x8000) return {part(10), part(5), part(0)};
    return {0.8f, 0.8f, 0.8f}; // Material's diffuseColor
  }

 private:
  bool magics_ = false;
  float whole_[3] = {};
};

// 80 bytes of any content, the number of facets, then for each facet 12 floats (normal and three
// vertices) and 2 attribute bytes; little-endian.
void readBinary(const MeshFile& file) {
  uint32_t count = 0;
  if (file.bytes.size() < headBytes) throw MeshFault{nullptr, "the STL file ends in its header"};
  std::memcpy(&count, file.bytes.data() + 80, sizeof count);
  const uint64_t present = (file.bytes.size() - headBytes) / facetBytes;
  if (count > present) {
    file.locator.error(nullptr,
                       fmt::format("the STL file ends early: it announces {} triangles and "
                                   "has {}",
                                   count, present));
    count = uint32_t(present);
  }
  Solid solid;
  Scratch scratch(file.budget);
  scratch.take(uint64_t(count) * (3 * sizeof(Vec3f) + sizeof(Color)));
  solid.corners.reserve(3 * size_t(count));
  const FacetColors colors(file.bytes.substr(0, 80));
  FaultCount bad;
  const char* facet = file.bytes.data() + headBytes;
  for (uint32_t i = 0; i < count; ++i, facet += facetBytes) {
    Vec3f corners[3];
    std::memcpy(corners, facet + 12, sizeof corners);
    uint16_t attribute = 0;
    std::memcpy(&attribute, facet + 48, sizeof attribute);
    if (!isFinite(corners[0]) || !isFinite(corners[1]) || !isFinite(corners[2])) {
      bad.add(nullptr);
      continue;
    }
    if (solid.colors.empty() && colors.has(attribute))
      solid.colors.assign(solid.corners.size() / 3, colors.of(0));
    solid.corners.insert(solid.corners.end(), corners, corners + 3);
    if (colors.has(attribute) || !solid.colors.empty())
      solid.colors.push_back(colors.of(attribute));
  }
  bad.report(file.locator, Severity::error,
             "triangles are left out, because their vertices are not finite");
  NodeStream nodes(file);
  PointRange range;
  writeSolid(file, nodes, range, std::move(solid));
  range.report(file.locator);
}

} // namespace

bool isBinaryStl(std::string_view bytes, std::string_view) {
  if (bytes.size() < headBytes) return false;
  uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count > 0 && uint64_t(headBytes) + uint64_t(facetBytes) * count == bytes.size();
}

namespace {

// Returns whether the beginning of a file is a text that begins with "solid". Binary files, whose
// header may be that word, have zeros in their numbers.
bool beginsAsText(std::string_view begin) {
  TextCursor text(begin);
  text.skipSpace();
  return is(text.word(), "solid") && std::all_of(begin.begin(), begin.end(), [](char c) {
           return static_cast<unsigned char>(c) >= ' ' || TextCursor::isSpace(c) || c == '\x1a';
         });
}

// Some programs write lines of their own between "solid" and the first "facet".
bool hasFacetOrEnd(std::string_view begin) {
  TextCursor text(begin);
  text.skipSpace();
  text.word();
  nameOfSolid(text);
  for (; !text.atEnd(); text.nextLine()) {
    const std::string_view word = text.word();
    if (is(word, "facet") || ends(text, word, "solid")) return true;
  }
  return false;
}

// Returns the beginning of a file without the zeros that may pad a short text. Those of a binary
// file stay.
std::string_view beginOf(std::string_view bytes) {
  const std::string_view begin = bytes.substr(0, 4096), text = withoutDosEnd(begin);
  return hasFacetOrEnd(text) ? text : begin;
}

} // namespace

bool isAsciiStl(std::string_view bytes, std::string_view) {
  const std::string_view begin = beginOf(bytes);
  return beginsAsText(begin) && hasFacetOrEnd(begin);
}

void readStl(const MeshFile& file) {
  if (!isBinaryStl(file.bytes) && beginsAsText(beginOf(file.bytes)))
    TextReader(file).read();
  else
    readBinary(file);
}

} // namespace xvrml
