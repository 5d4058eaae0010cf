// obj.cpp: reads OBJ (Wavefront, "Object Files (.obj)", 1995): points, polygons, lines, groups,
// materials, smoothing groups and colours of vertices. Faces of one object, group, material and
// smoothing group become one Shape. Free-form curves and surfaces are left out.
#include <algorithm>
#include <deque>
#include <set>

#include <fmt/format.h>

#include "parse/encodings.h"
#include "parse/mesh/bare_shape.h"
#include "parse/mesh/mesh_file.h"
#include "parse/mesh/mtl.h"
#include "parse/mesh/text_cursor.h"

namespace xvrml {
namespace {

constexpr size_t mostParts = 1'000'000, mostLibraries = 1000;

// Faces, lines or points that become one Shape. Indices count from 0 in the file's lists.
struct Part {
  MeshKind kind = MeshKind::faces;
  std::string name, material;
  float creaseAngle = meshCreaseAngle;
  bool hasTexCoords = false, hasNormals = false, convex = true;
  MFInt32 coord, texCoord, normal; // -1 ends each face
};

struct Corner {
  int32_t coord = 0, texCoord = -1, normal = -1;
};

// Takes the values that a part uses out of the list of the whole file, and changes the indices to
// theirs. `places` has room for the whole list.
template <class T>
std::vector<T> pick(const std::vector<T>& all, MFInt32& index, std::vector<int32_t>& places) {
  std::vector<T> used;
  places.resize(all.size(), -1);
  std::vector<int32_t> touched;
  for (int32_t& i : index) {
    if (i < 0) continue;
    int32_t& place = places[size_t(i)];
    if (place < 0) {
      place = int32_t(used.size());
      used.push_back(all[size_t(i)]);
      touched.push_back(i);
    }
    i = place;
  }
  for (const int32_t i : touched) places[size_t(i)] = -1;
  return used;
}

class ObjReader {
 public:
  explicit ObjReader(const MeshFile& file)
      : file_(file), text_(file.bytes), scratch_(file.budget), nodes_(file) {}

  void read();

 private:
  // A backslash at the end of a line joins the next line to the statement, but not to a comment.
  void statement(std::string_view word);
  void readStatement(std::string_view word);
  static bool isOfNumbers(std::string_view word);

  // Statements of numbers and indices. Returns false for other keywords.
  bool readNumbers(std::string_view word);

  // Returns whether the rest of the line has neither a comment nor a continuation. Most lines have
  // none, and are read where they stand.
  bool isPlainLine() const;

  // Goes on with a copy of the statement in one line, with the lines that a backslash at the end of
  // a line joins. numbers: without comments, which begin at any '#'; names may hold that character,
  // and need a copy that stays.
  void joinLines(bool numbers);

  // Statements that say how the following elements are. Returns false for other keywords.
  bool readState(std::string_view word);
  void readOther(std::string_view spelled);

  // A file name may contain blanks; several names stand in one line.
  void readLibraries();
  void report(const MeshFault& fault);

  template <class T> void grow(std::vector<T>& list) {
    if (list.size() < list.capacity()) return;
    const size_t more = std::max<size_t>(list.size(), 1024);
    if (list.size() + more > INT32_MAX / 2)
      throw MeshFault{at_, "too many values in an OBJ file; the rest of it is left out"};
    scratch_.take(more * sizeof(T));
    list.reserve(list.size() + more);
  }

  // "v x y z", "v x y z w", "v x y z r g b"
  void readVertex();

  template <class T> void readValue(std::vector<T>& list, int needed) {
    T value;
    float* numbers = &value.x;
    int count = 0;
    while (count < int(sizeof(T) / sizeof(float)) && !text_.atLineEnd() &&
           text_.number(numbers[count]))
      ++count;
    if (count < needed) {
      badValues_.add(at_);
      value = {};
    }
    grow(list);
    list.push_back(value);
  }

  // Reads an index of a list: from 1, or from -1 backwards.
  bool readIndex(size_t listSize, int32_t& out);
  bool accept(char c);
  // Reads an index behind a '/'. An index that is not written is none.
  bool readOptionalIndex(size_t listSize, int32_t& out);

  // "v", "v/vt", "v//vn", "v/vt/vn"; also "v/", "v//" and "v/vt/". Returns false if the vertex is
  // not one of the file's. `good` becomes false if anything else cannot be read.
  bool readCorner(Corner& corner, bool& good);
  void readElement(MeshKind kind);
  void addElement(Part& part);
  Part& partFor(MeshKind kind, bool texCoords, bool normals);
  void write(Part& part);
  void writeShape(const Part& part, MeshGeometry&& geometry);

  // A file with nothing but vertices is a cloud of points.
  void writeVertices();

  const MeshFile& file_;
  TextCursor text_;
  Scratch scratch_;
  NodeStream nodes_;
  const char* at_ = nullptr;      // the statement that is being read
  std::string numbers_;           // a copy of that statement, if it is one of numbers in many lines
  std::deque<std::string> names_; // copies of the other statements in many lines
  const char* lastLine_ = nullptr; // where the last line of the joined statement ends
  MFVec3f points_, normals_;
  MFColor colors_;
  MFVec2f texCoords_;
  std::string_view object_, group_, material_, smoothing_; // what holds for the next elements
  std::vector<Part> parts_;
  std::unordered_map<std::string, size_t> partOf_;
  Part* part_ = nullptr; // the part of the last element, if nothing has changed since
  int partShape_ = 0;
  ObjMaterials materials_;
  std::vector<Corner> corners_;
  std::vector<int32_t> places_;
  std::set<std::string> unknown_;
  std::set<std::string, std::less<>> libraries_; // the lines that name them
  FaultCount badValues_, badFaces_, badCorners_, freeForm_;
};

void ObjReader::read() {
  try {
    for (; !text_.atEnd(); text_.nextLine()) {
      if (text_.atLineEnd()) continue;
      at_ = text_.at();
      statement(text_.word());
    }
  } catch (const MeshFault& fault) { // what has been read is shown
    file_.locator.error(fault.at, fault.message);
  }
  badValues_.report(file_.locator, Severity::error,
                    "lines without the numbers that they need; their values are taken as 0");
  badFaces_.report(file_.locator, Severity::error,
                   "faces, lines or points are left out: expected indices of vertices above");
  badCorners_.report(file_.locator, Severity::warning,
                     "faces or lines have corners that name texture coordinates or normals which "
                     "the file does not have above; they are drawn without these");
  freeForm_.report(file_.locator, Severity::warning,
                   "statements of free-form curves and surfaces are left out");
  PointRange().add(points_).report(file_.locator);
  for (Part& part : parts_) write(part);
  if (parts_.empty() && !points_.empty()) writeVertices();
}

void ObjReader::statement(std::string_view word) {
  if (word[0] == '#') return;
  if (word.back() == '\\') {
    word.remove_suffix(1);
    text_.seek(text_.at() - 1);
  }
  const bool numbers = isOfNumbers(word) || isOfNumbers(lowerKeyword(word));
  if (numbers ? isPlainLine() : !TextCursor(text_).rest().ends_with('\\'))
    return readStatement(word);
  const TextCursor whole = text_;
  joinLines(numbers);
  readStatement(word);
  text_ = whole;
  text_.seek(lastLine_);
}

void ObjReader::readStatement(std::string_view word) {
  if (!readNumbers(word) && !readState(word) && !readNumbers(lowerKeyword(word)) &&
      !readState(lowerKeyword(word)))
    readOther(word);
}

bool ObjReader::isOfNumbers(std::string_view word) {
  constexpr std::string_view keywords[] = {"v", "vt", "vn", "f", "fo", "l", "p"};
  return std::find(std::begin(keywords), std::end(keywords), word) != std::end(keywords);
}

bool ObjReader::readNumbers(std::string_view word) {
  if (!isOfNumbers(word)) return false;
  if (word == "v")
    readVertex();
  else if (word == "vt")
    readValue(texCoords_, 1);
  else if (word == "vn")
    readValue(normals_, 3);
  else if (word == "l")
    readElement(MeshKind::lines);
  else if (word == "p")
    readElement(MeshKind::points);
  else
    readElement(MeshKind::faces);
  return true;
}

bool ObjReader::isPlainLine() const {
  for (const char* p = text_.at(); p < text_.end() && *p != '\n' && *p != '\r'; ++p)
    if (*p == '#' || *p == '\\') return false;
  return true;
}

void ObjReader::joinLines(bool numbers) {
  std::string& joined = numbers ? numbers_ : names_.emplace_back();
  joined.clear();
  for (bool continues = true; continues;) {
    std::string_view line = text_.rest();
    lastLine_ = text_.at();
    if (numbers) line = line.substr(0, line.find('#'));
    continues = line.ends_with('\\') && !text_.atEnd();
    if (line.ends_with('\\')) line.remove_suffix(1);
    while (!line.empty() && TextCursor::isSpace(line.back())) line.remove_suffix(1);
    if (joined.capacity() < joined.size() + line.size() + 1) {
      scratch_.take(joined.size() + line.size() + 1);
      joined.reserve(2 * (joined.size() + line.size() + 1));
    }
    joined.append(line) += ' ';
    if (continues) text_.nextLine();
  }
  text_ = TextCursor(joined);
}

bool ObjReader::readState(std::string_view word) {
  if (word.empty()) return true;
  if (word == "o") {
    object_ = text_.rest();
    group_ = {};
  } else if (word == "g") {
    group_ = text_.rest();
  } else if (word == "s") {
    smoothing_ = text_.word();
    smoothing_ = smoothing_.substr(0, smoothing_.find('#'));
    if (smoothing_ == "off") smoothing_ = "0";
  } else if (word == "usemtl") {
    material_ = text_.rest();
  } else if (word == "mtllib") {
    readLibraries();
  } else {
    return false;
  }
  part_ = nullptr;
  return true;
}

void ObjReader::readOther(std::string_view spelled) {
  part_ = nullptr;
  const std::string word = lowerKeyword(spelled);
  constexpr std::string_view freeForm[] = {"cstype", "deg",  "bmat", "step", "curv",
                                           "curv2",  "surf", "parm", "trim", "hole",
                                           "scrv",   "sp",   "end",  "con",  "vp"};
  // Statements about display that have no meaning here.
  constexpr std::string_view display[] = {"mg",        "bevel",  "c_interp", "d_interp",
                                          "lod",       "maplib", "usemap",   "shadow_obj",
                                          "trace_obj", "ctech",  "stech"};
  if (std::find(std::begin(freeForm), std::end(freeForm), word) != std::end(freeForm))
    return freeForm_.add(at_);
  if (std::find(std::begin(display), std::end(display), word) != std::end(display)) return;
  if (unknown_.size() < 20 && unknown_.emplace(spelled.substr(0, 100)).second)
    file_.locator.warn(at_, fmt::format("{} is no statement of an OBJ file; such lines are left "
                                        "out",
                                        describe(Name{spelled, at_})));
}

void ObjReader::readLibraries() {
  text_.skipBlanks();
  const char* from = text_.at();
  // A joined statement is no part of the file.
  const bool joined = text_.end() != file_.bytes.data() + file_.bytes.size();
  const auto place = [&](const char* at) { return joined ? at_ : at; };
  const std::string_view whole = text_.rest();
  if (whole.empty() || !libraries_.emplace(whole).second) return;
  if (libraries_.size() > mostLibraries)
    throw MeshFault{at_, fmt::format("more than {} material libraries; the rest of the file is "
                                     "left out",
                                     mostLibraries)};
  try {
    readMtl(file_, whole, place(from), materials_);
    return;
  } catch (const MeshFault& fault) {
    if (whole.find_first_of(" \t") == whole.npos) return report(fault);
  }
  text_.seek(from);
  while (!text_.atLineEnd()) {
    const std::string_view name = text_.word();
    if (name[0] == '#') return; // a comment
    try {
      readMtl(file_, name, place(name.data()), materials_);
    } catch (const MeshFault& fault) { report(fault); }
  }
}

void ObjReader::report(const MeshFault& fault) {
  file_.locator.warn(fault.at, fmt::format("materials are not read: {}", fault.message));
}

void ObjReader::readVertex() {
  float numbers[7] = {};
  int count = 0;
  while (count < 7 && !text_.atLineEnd() && text_.number(numbers[count])) ++count;
  if (count < 7) numbers[count] = 0; // a number out of range
  if (count < 3) badValues_.add(at_);
  grow(points_);
  points_.push_back({numbers[0], numbers[1], numbers[2]});
  if (count >= 6 && colors_.empty()) colors_.resize(points_.size() - 1, Color{1, 1, 1});
  if (count < 6 && colors_.empty()) return;
  grow(colors_);
  const auto part = [&](int i) { return count >= 6 ? std::clamp(numbers[i], 0.0f, 1.0f) : 1.0f; };
  colors_.push_back({part(3), part(4), part(5)});
}

bool ObjReader::readIndex(size_t listSize, int32_t& out) {
  const char* p = text_.at();
  int32_t number = 0;
  if (p == text_.end() || readNumber(p, text_.end(), number) != NumberError::none) return false;
  text_.seek(p);
  const int64_t index = number < 0 ? int64_t(listSize) + number : int64_t(number) - 1;
  out = int32_t(index);
  return number != 0 && index >= 0 && index < int64_t(listSize);
}

bool ObjReader::accept(char c) {
  if (text_.atEnd() || *text_.at() != c) return false;
  text_.seek(text_.at() + 1);
  return true;
}

bool ObjReader::readOptionalIndex(size_t listSize, int32_t& out) {
  if (text_.atEnd() || *text_.at() == '/' || TextCursor::isSpace(*text_.at())) return true;
  if (readIndex(listSize, out)) return true;
  out = -1;
  return false;
}

bool ObjReader::readCorner(Corner& corner, bool& good) {
  corner = {};
  if (!readIndex(points_.size(), corner.coord)) return false;
  if (accept('/')) good = readOptionalIndex(texCoords_.size(), corner.texCoord) && good;
  if (accept('/')) good = readOptionalIndex(normals_.size(), corner.normal) && good;
  if (text_.atEnd() || TextCursor::isSpace(*text_.at())) return true;
  good = false;
  text_.word(); // what else is glued to it
  return true;
}

void ObjReader::readElement(MeshKind kind) {
  corners_.clear();
  bool texCoords = true, normals = true, good = true;
  while (!text_.atLineEnd()) {
    Corner corner;
    if (!readCorner(corner, good)) return badFaces_.add(at_);
    texCoords = texCoords && corner.texCoord >= 0;
    normals = normals && corner.normal >= 0;
    grow(corners_);
    corners_.push_back(corner);
  }
  const size_t least = kind == MeshKind::faces ? 3 : kind == MeshKind::lines ? 2 : 1;
  if (corners_.size() < least) return badFaces_.add(at_);
  if (!good) badCorners_.add(at_);
  const bool faces = kind == MeshKind::faces;
  addElement(partFor(kind, faces && texCoords, faces && normals));
}

void ObjReader::addElement(Part& part) {
  part.convex = part.convex && corners_.size() == 3;
  for (const Corner& corner : corners_) {
    grow(part.coord);
    part.coord.push_back(corner.coord);
    if (part.hasTexCoords) grow(part.texCoord), part.texCoord.push_back(corner.texCoord);
    if (part.hasNormals) grow(part.normal), part.normal.push_back(corner.normal);
  }
  if (part.kind == MeshKind::points) return;
  for (MFInt32* list : {&part.coord, &part.texCoord, &part.normal}) {
    if (list->empty()) continue;
    grow(*list);
    list->push_back(-1);
  }
}

Part& ObjReader::partFor(MeshKind kind, bool texCoords, bool normals) {
  const int shape = int(kind) * 4 + texCoords * 2 + normals;
  if (part_ && shape == partShape_) return *part_;
  // Faces with normals need no smoothing group.
  const std::string_view smoothing = normals ? std::string_view() : smoothing_;
  std::string key = fmt::format("{}\n{}\n{}\n{}\n{}", shape, object_, group_, material_, smoothing);
  scratch_.take(sizeof(Part) + 3 * key.size());
  const auto [it, fresh] = partOf_.try_emplace(std::move(key), parts_.size());
  if (fresh) {
    if (parts_.size() >= mostParts)
      throw MeshFault{
          at_, fmt::format("more than {} groups; the rest of the file is left out", mostParts)};
    Part& part = parts_.emplace_back();
    part.kind = kind;
    part.name = group_.empty() || group_ == "default" ? object_ : group_;
    part.material = material_;
    part.hasTexCoords = texCoords;
    part.hasNormals = normals;
    if (smoothing_ == "0")
      part.creaseAngle = 0;
    else if (!smoothing_.empty())
      part.creaseAngle = 3.1416f;
  }
  part_ = &parts_[it->second];
  partShape_ = shape;
  return *part_;
}

void ObjReader::write(Part& part) {
  scratch_.take((part.coord.size() + part.texCoord.size() + part.normal.size()) * sizeof(Vec3f));
  MeshGeometry geometry;
  if (!colors_.empty()) {
    MFInt32 index = part.coord;
    geometry.colors = pick(colors_, index, places_);
  }
  geometry.points = pick(points_, part.coord, places_);
  if (part.hasTexCoords) geometry.texCoords = pick(texCoords_, part.texCoord, places_);
  if (part.hasNormals) geometry.normals = pick(normals_, part.normal, places_);
  geometry.coordIndex = std::move(part.coord);
  // Equal lists need not be stored twice.
  if (part.texCoord != geometry.coordIndex) geometry.texCoordIndex = std::move(part.texCoord);
  if (part.normal != geometry.coordIndex) geometry.normalIndex = std::move(part.normal);
  geometry.convex = part.convex;
  geometry.creaseAngle = part.creaseAngle;
  writeShape(part, std::move(geometry));
}

void ObjReader::writeShape(const Part& part, MeshGeometry&& geometry) {
  nodes_.open("Shape", part.name.empty() ? std::string_view() : nodes_.define(part.name, {}));
  const bool lit = part.kind == MeshKind::faces;
  if (lit || geometry.colors.empty())
    writeObjAppearance(nodes_, file_, materials_, part.material, lit);
  nodes_.openField("geometry");
  if (part.kind == MeshKind::faces)
    writeFaces(nodes_, std::move(geometry));
  else if (part.kind == MeshKind::lines)
    writeLines(nodes_, std::move(geometry));
  else
    writePoints(nodes_, std::move(geometry));
  nodes_.closeField();
  nodes_.close();
}

void ObjReader::writeVertices() {
  MeshGeometry geometry;
  geometry.points = std::move(points_);
  geometry.colors = std::move(colors_);
  Part part;
  part.kind = MeshKind::points;
  writeShape(part, std::move(geometry));
}

} // namespace

// The text begins with vertices or a material library; comments, groups and other values may come
// before.
bool isObj(std::string_view bytes, std::string_view) {
  constexpr size_t searched = 1 << 16;
  TextCursor text(bytes.substr(0, searched));
  for (; !text.atEnd(); text.nextLine()) {
    if (text.atLineEnd()) continue;
    const std::string_view word = text.word();
    if (word[0] == '#' || word == "o" || word == "g" || word == "s" || word == "usemtl" ||
        word == "vt" || word == "vn")
      continue;
    float number = 0;
    return word == "mtllib" || (word == "v" && text.number(number));
  }
  return false;
}

void readObj(const MeshFile& file) { ObjReader(file).read(); }

} // namespace xvrml
