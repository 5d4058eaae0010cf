// ply_header.cpp: "ply", "format ascii 1.0", "element vertex 8", "property float x",
// "property list uchar int vertex_indices", "comment ...", "end_header".
#include "parse/mesh/ply_header.h"

#include <algorithm>

#include <fmt/format.h>

#include "parse/encodings.h"
#include "parse/mesh/text_cursor.h"

namespace xvrml {
namespace {

constexpr size_t mostElements = 100, mostProperties = 1000;

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr TypeName typeNames[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

struct UseName {
  std::string_view name;
  PlyUse use;
};
// The names that programs write; those of texture coordinates differ.
constexpr UseName useNames[] = {{"x", PlyUse::x},
                                {"y", PlyUse::y},
                                {"z", PlyUse::z},
                                {"nx", PlyUse::nx},
                                {"ny", PlyUse::ny},
                                {"nz", PlyUse::nz},
                                {"red", PlyUse::red},
                                {"green", PlyUse::green},
                                {"blue", PlyUse::blue},
                                {"r", PlyUse::red},
                                {"g", PlyUse::green},
                                {"b", PlyUse::blue},
                                {"diffuse_red", PlyUse::red},
                                {"diffuse_green", PlyUse::green},
                                {"diffuse_blue", PlyUse::blue},
                                {"s", PlyUse::s},
                                {"t", PlyUse::t},
                                {"u", PlyUse::s},
                                {"v", PlyUse::t},
                                {"texture_u", PlyUse::s},
                                {"texture_v", PlyUse::t},
                                {"vertex1", PlyUse::vertex1},
                                {"vertex2", PlyUse::vertex2}};

bool isColor(PlyUse use) { return use >= PlyUse::red && use <= PlyUse::blue; }

class HeaderReader {
 public:
  explicit HeaderReader(const MeshFile& file) : file_(file), text_(file.bytes) {}

  PlyHeader read() {
    findLineEnd();
    nextLine(); // "ply"
    bool formatted = false;
    for (;; nextLine()) {
      const char* at = text_.at();
      if (text_.atEnd()) fail(at, "end_header, found the end of the file");
      const std::string_view word = text_.word();
      if (word == "end_header") break;
      if (word == "format")
        formatted = readFormat();
      else if (word == "element")
        readElement();
      else if (word == "property")
        readProperty();
      else if (word == "comment")
        readComment();
      else if (word != "obj_info" && !word.empty())
        unknown_.add(at);
    }
    nextLine();
    unknown_.report(file_.locator, Severity::error,
                    "lines of the PLY header are passed over: expected format, element, property, "
                    "comment or end_header");
    if (!formatted) fail(file_.bytes.data(), "a line 'format ascii 1.0' in the PLY header");
    header_.bytes = size_t(text_.at() - file_.bytes.data());
    // A program that writes a file in two parts may put a mark before each.
    if (header_.order == PlyOrder::text &&
        file_.bytes.substr(header_.bytes).starts_with("\xef\xbb\xbf"))
      header_.bytes += 3;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex")
        header_.vertices = std::min<uint64_t>(element.count, INT32_MAX / 4);
      for (const PlyProperty& property : element.properties) {
        if (element.name != "face") continue;
        header_.faceColors |= property.use == PlyUse::red;
        header_.cornerTexCoords |= property.use == PlyUse::texCoords;
      }
    }
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const char* at, std::string_view expected) {
    throw MeshFault{at, fmt::format("expected {}", expected)};
  }

  // The first line says how the lines of the header end. Behind a header of CR alone, a byte 0x0A
  // belongs to the data.
  void findLineEnd() {
    const size_t end = std::min(file_.bytes.find_first_of("\r\n"), file_.bytes.size());
    const std::string_view rest = file_.bytes.substr(end);
    carriageReturns_ = rest.starts_with('\r') && !rest.starts_with("\r\n");
  }
  void nextLine() {
    text_.rest();
    if (carriageReturns_ && !text_.atEnd() && *text_.at() == '\r')
      text_.seek(text_.at() + 1);
    else
      text_.nextLine();
  }

  bool readFormat() {
    const char* at = text_.at();
    const std::string_view name = text_.word();
    if (name == "ascii")
      header_.order = PlyOrder::text;
    else if (name == "binary_little_endian")
      header_.order = PlyOrder::little;
    else if (name == "binary_big_endian")
      header_.order = PlyOrder::big;
    else
      fail(at,
           fmt::format("a PLY format (ascii, binary_little_endian, binary_big_endian), found {}",
                       describe(Name{name, at})));
    return true;
  }

  void readElement() {
    PlyElement element;
    element.name = text_.word();
    const char* at = text_.at();
    double count = 0;
    if (!text_.number(count) || !(count >= 0 && count < 1e15))
      fail(at, fmt::format("the number of rows of element {}", describe(Name{element.name})));
    element.count = uint64_t(count);
    header_.elements.push_back(std::move(element));
    if (header_.elements.size() > mostElements)
      fail(at, fmt::format("at most {} elements in a PLY header", mostElements));
  }

  PlyType readType() {
    const char* at = text_.at();
    const std::string_view name = text_.word();
    for (const TypeName& row : typeNames)
      if (row.name == name) return row.type;
    fail(at,
         fmt::format("a PLY type (char, uchar, short, ushort, int, uint, float, double), found {}",
                     describe(Name{name, at})));
  }

  void readProperty() {
    const char* at = text_.at();
    if (header_.elements.empty()) fail(at, "an element before the first property");
    PlyProperty property;
    const char* typeAt = text_.at();
    property.isList = text_.word() == "list";
    if (!property.isList) text_.seek(typeAt);
    if (property.isList) property.countType = readType();
    property.type = readType();
    const std::string_view name = text_.word();
    PlyElement& element = header_.elements.back();
    property.use = property.isList ? useOfList(name) : useOf(name);
    if (isColor(property.use) && property.type < PlyType::float32)
      property.scale = 1 / (std::exp2(8.0 * double(plyTypeBytes(property.type))) - 1);
    element.properties.push_back(property);
    if (element.properties.size() > mostProperties)
      fail(at, fmt::format("at most {} properties of an element", mostProperties));
  }

  static PlyUse useOf(std::string_view name) {
    for (const UseName& row : useNames)
      if (row.name == name) return row.use;
    return PlyUse::other;
  }
  static PlyUse useOfList(std::string_view name) {
    if (name == "vertex_indices" || name == "vertex_index") return PlyUse::indices;
    return name == "texcoord" ? PlyUse::texCoords : PlyUse::other;
  }

  void readComment() {
    if (text_.word() == "TextureFile" && header_.texture.empty())
      header_.texture = std::string(text_.rest());
  }

  const MeshFile& file_;
  TextCursor text_;
  PlyHeader header_;
  bool carriageReturns_ = false; // lines of the header end with CR alone
  FaultCount unknown_;
};

} // namespace

uint64_t plyTypeBytes(PlyType type) {
  switch (type) {
  case PlyType::int8:
  case PlyType::uint8: return 1;
  case PlyType::int16:
  case PlyType::uint16: return 2;
  case PlyType::float64: return 8;
  default: return 4;
  }
}

PlyHeader readPlyHeader(const MeshFile& file) { return HeaderReader(file).read(); }

bool isPly(std::string_view bytes, std::string_view) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

} // namespace xvrml
