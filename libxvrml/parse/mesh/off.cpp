// off.cpp: reads OFF, text (Geomview, "OOGL File Formats", section "OFF: Indexed polyhedra", 1993):
// polygons over a list of vertices, with normals, colours and texture coordinates of vertices or
// colours of faces. One vertex or face stands in each line, as all programs write them.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "parse/encodings.h"
#include "parse/mesh/bare_shape.h"
#include "parse/mesh/mesh_file.h"
#include "parse/mesh/text_cursor.h"

namespace xvrml {
namespace {

// Holds what stands before "OFF", and says what the lines of vertices hold.
struct OffHead {
  bool texCoords = false, colors = false, normals = false;
  std::string_view refused; // a prefix that is not read: "4" or "n"
};

// Takes a prefix off the text. Returns whether it was there.
bool take(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

// Reads "[ST][C][N][4][n]OFF", and moves behind it. Some programs write no blank before the counts.
bool readHead(TextCursor& text, OffHead& head) {
  std::string_view rest(text.at(), size_t(text.end() - text.at()));
  head.texCoords = take(rest, "ST");
  head.colors = take(rest, "C");
  head.normals = take(rest, "N");
  for (const std::string_view prefix : {"4", "n"})
    if (take(rest, prefix)) head.refused = prefix;
  if (!take(rest, "OFF")) return false;
  if (!rest.empty() && !TextCursor::isSpace(rest[0]) && rest[0] != '#' &&
      !(rest[0] >= '0' && rest[0] <= '9'))
    return false;
  text.seek(rest.data());
  return true;
}

// Moves to the next line or rest of a line that is neither empty nor a comment.
void skipComments(TextCursor& text) {
  for (text.skipSpace(); !text.atEnd() && *text.at() == '#'; text.skipSpace()) text.nextLine();
}

// Returns whether the line has another word that is no comment.
bool hasMore(TextCursor& text) { return !text.atLineEnd() && *text.at() != '#'; }

class OffReader {
 public:
  explicit OffReader(const MeshFile& file)
      : file_(file), text_(file.bytes, '#'), scratch_(file.budget) {}

  void read() {
    readCounts();
    try {
      readVertices();
      readFaces();
    } catch (const MeshFault& fault) { // what has been read is shown
      file_.locator.error(fault.at, fault.message);
    }
    bad_.report(
        file_.locator, Severity::error,
        "faces are left out: expected a number of corners from 3 on, and as many indices of "
        "vertices from 0 on");
    badColors_.report(file_.locator, Severity::warning,
                      "colours are left out: expected three or four numbers");
    mapped_.report(file_.locator, Severity::warning,
                   "colours are indices of a map that is not in the file: these faces are grey");
    opacities_.report(file_.locator, Severity::warning,
                      "colours have an opacity below 1, which is not used");
    finish();
  }

 private:
  void readCounts() {
    skipComments(text_);
    if (!readHead(text_, head_))
      throw MeshFault{text_.at(), "expected OFF, or COFF, NOFF and so on, as the first word"};
    if (!head_.refused.empty())
      throw MeshFault{nullptr, fmt::format("OFF files with the prefix '{}' have vertices of other "
                                           "than three dimensions, which cannot be read",
                                           head_.refused)};
    skipComments(text_);
    if (TextCursor ahead = text_; ahead.word() == "BINARY")
      throw MeshFault{text_.at(), "binary OFF files cannot be read"};
    for (uint64_t* count : {&vertices_, &faces_, &edges_}) {
      text_.skipBlanks();
      const char* at = text_.at();
      const TextCursor before = text_;
      double number = 0;
      if (count == &edges_ && !hasMore(text_)) break; // some programs leave it out
      const bool read = text_.number(number);
      if (!read || !(number >= 0 && number <= 1e15) || std::floor(number) != number) {
        text_ = before;
        throw MeshFault{at, fmt::format("expected the numbers of vertices, faces and edges, found "
                                        "{}",
                                        found())};
      }
      *count = uint64_t(number);
    }
    if (vertices_ > INT32_MAX / 4) throw MeshFault{nullptr, "too many vertices in an OFF file"};
    text_.nextLine();
  }

  std::string found() {
    if (text_.atEnd()) return "the end of the file";
    if (text_.atLineEnd()) return "the end of the line";
    const std::string_view word = text_.word();
    return describe(Name{word, word.data()});
  }

  uint64_t left() const { return uint64_t(text_.end() - text_.at()); }

  // Moves to the next line of a list, or throws if the file ends before.
  void startLine(std::string_view what, uint64_t row, uint64_t rows) {
    skipComments(text_);
    if (text_.atEnd())
      throw MeshFault{nullptr, fmt::format("the OFF file ends early: it announces {} {} and has {}",
                                           rows, what, row)};
  }

  float number() {
    float value = 0;
    if (!hasMore(text_) || !text_.number(value))
      throw MeshFault{text_.at(), fmt::format("expected a number, found {}; the rest of the file "
                                              "is left out",
                                              found())};
    return value;
  }

  void readVertices() {
    // A vertex takes six bytes at least: "0 0 0" and a line end.
    const uint64_t room = std::min(vertices_, left() / 6 + 1);
    scratch_.take(room * (sizeof(Vec3f) * (1 + head_.normals + head_.colors) +
                          sizeof(Vec2f) * head_.texCoords));
    shape_.points.reserve(room);
    for (uint64_t i = 0; i < vertices_; ++i, text_.nextLine()) {
      startLine("vertices", i, vertices_);
      Vec3f normal;
      Vec2f texCoord;
      Color color{0.8f, 0.8f, 0.8f};
      const Vec3f point = vector();
      if (head_.normals) normal = vector();
      if (head_.colors) readColor(color);
      if (head_.texCoords) {
        texCoord.x = number();
        texCoord.y = number();
      }
      shape_.points.push_back(point);
      if (head_.normals) shape_.normals.push_back(normal);
      if (head_.colors) shape_.colors.push_back(color);
      if (head_.texCoords) shape_.texCoords.push_back(texCoord);
    }
  }

  Vec3f vector() {
    const float x = number(), y = number(), z = number();
    return {x, y, z};
  }

  // Reads "r g b" or "r g b a": integers from 0 to 255, or numbers with a point from 0 to 1. One
  // integer is an index of a map of colours, which the file does not hold. Returns whether there is
  // a colour.
  bool readColor(Color& color) {
    text_.skipBlanks();
    const char* from = text_.at();
    float parts[4] = {};
    int count = 0;
    bool whole = true;
    // Texture coordinates may follow the four numbers of a vertex.
    while (count < 4 && hasMore(text_)) {
      const char* at = text_.at();
      if (!text_.number(parts[count])) break;
      whole = whole && std::string_view(at, size_t(text_.at() - at)).find_first_of(".eE") ==
                           std::string_view::npos;
      ++count;
    }
    if (count == 0 && !hasMore(text_)) return false;
    if (count == 1 && whole) {
      mapped_.add(from);
      return false;
    }
    if (count < 3) {
      badColors_.add(from);
      return false;
    }
    const auto part = [&](int i) {
      return std::clamp(whole ? parts[i] / 255 : parts[i], 0.f, 1.f);
    };
    color = {part(0), part(1), part(2)};
    if (count == 4 && part(3) < 1) opacities_.add(from);
    return true;
  }

  void readFaces() {
    for (uint64_t i = 0; i < faces_; ++i, text_.nextLine()) {
      startLine("faces", i, faces_);
      readFace();
    }
  }

  void readFace() {
    const char* at = text_.at();
    MFInt32& index = shape_.coordIndex;
    const size_t first = index.size();
    int32_t corners = 0;
    bool good = text_.number(corners) && corners >= 3 && uint64_t(corners) <= left() / 2 + 1;
    for (int32_t k = 0; good && k < corners; ++k) {
      int32_t vertex = 0;
      good = hasMore(text_) && text_.number(vertex) && vertex >= 0 &&
             size_t(vertex) < shape_.points.size();
      grow(index);
      index.push_back(vertex);
    }
    if (!good) {
      index.resize(first);
      return bad_.add(at);
    }
    grow(index);
    index.push_back(-1);
    shape_.convex = shape_.convex && corners == 3;
    if (!head_.colors) addFaceColor();
    ++shown_;
  }

  // Faces without a colour of their own have that of a Material.
  void addFaceColor() {
    constexpr Color plain{0.8f, 0.8f, 0.8f};
    Color color = plain;
    const bool has = readColor(color);
    if (!has && faceColors_.empty()) return;
    while (faceColors_.size() < shown_) {
      grow(faceColors_);
      faceColors_.push_back(plain);
    }
    grow(faceColors_);
    faceColors_.push_back(color);
  }

  template <class T> void grow(std::vector<T>& list) {
    if (list.size() < list.capacity()) return;
    const size_t more = std::max<size_t>(list.size(), 1024);
    if (list.size() + more > INT32_MAX / 2)
      throw MeshFault{text_.at(), "too many faces in an OFF file; the rest of it is left out"};
    scratch_.take(more * sizeof(T));
    list.reserve(list.size() + more);
  }

  void finish() {
    if (shape_.points.empty()) return;
    PointRange().add(shape_.points).report(file_.locator);
    if (!faceColors_.empty()) {
      shape_.colors = std::move(faceColors_);
      shape_.colorPerVertex = false;
    }
    if (shape_.coordIndex.empty()) shape_.kind = MeshKind::points;
    NodeStream nodes(file_);
    writeBareShape(nodes, std::move(shape_));
  }

  const MeshFile& file_;
  TextCursor text_;
  Scratch scratch_;
  OffHead head_;
  uint64_t vertices_ = 0, faces_ = 0, edges_ = 0;
  BareShape shape_;
  MFColor faceColors_;
  size_t shown_ = 0; // faces in shape_
  FaultCount bad_, badColors_, mapped_, opacities_;
};

} // namespace

// The first word is the keyword, and the counts follow it. Comments may come before and between.
bool isOff(std::string_view bytes, std::string_view) {
  constexpr size_t searched = 1 << 16;
  TextCursor text(bytes.substr(0, searched));
  OffHead head;
  skipComments(text);
  if (!readHead(text, head)) return false;
  skipComments(text);
  int32_t vertices = 0, faces = 0;
  return text.number(vertices) && text.number(faces);
}

void readOff(const MeshFile& file) { OffReader(file).read(); }

} // namespace xvrml
