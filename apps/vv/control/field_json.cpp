#include "control/field_json.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "xvrml/world.h"

namespace vv::control {

using namespace xvrml;

namespace {

template <class T> constexpr size_t width = sizeof(T) / sizeof(float);
static_assert(width<Vec2f> == 2 && width<Vec3f> == 3 && width<Color> == 3 && width<Rotation> == 4);

const char* expectation(FieldType type) {
  switch (type) {
  case FieldType::SFBool: return "true or false";
  case FieldType::SFColor: return "an array of 3 numbers (red, green, blue)";
  case FieldType::SFFloat:
  case FieldType::SFTime: return "a number";
  case FieldType::SFImage:
    return "an object with width, height, components and pixels (a whole number for each pixel, as "
           "in VRML)";
  case FieldType::SFInt32: return "a whole number of 32 bits";
  case FieldType::SFNode: return "the DEF name or the number of a node, or null";
  case FieldType::SFRotation: return "an array of 4 numbers (axis x, y, z and angle in radians)";
  case FieldType::SFString: return "a text";
  case FieldType::SFVec2f: return "an array of 2 numbers";
  case FieldType::SFVec3f: return "an array of 3 numbers";
  case FieldType::MFColor:
  case FieldType::MFVec3f: return "an array of arrays of 3 numbers";
  case FieldType::MFFloat:
  case FieldType::MFTime: return "an array of numbers";
  case FieldType::MFInt32: return "an array of whole numbers of 32 bits";
  case FieldType::MFNode: return "an array of DEF names or numbers of nodes";
  case FieldType::MFRotation: return "an array of arrays of 4 numbers";
  case FieldType::MFString: return "an array of texts";
  case FieldType::MFVec2f: return "an array of arrays of 2 numbers";
  }
  return "";
}

bool hasWideNumbers(FieldType type) {
  return type == FieldType::SFTime || type == FieldType::MFTime || type == FieldType::SFInt32 ||
         type == FieldType::MFInt32;
}

// Returns whether a field of these node types accepts the node. nodeTypes: names and abstract
// types, separated by blanks; empty: any.
bool accepts(std::string_view nodeTypes, Node& node) {
  if (nodeTypes.empty()) return true;
  const std::string padded = fmt::format(" {} ", nodeTypes);
  const auto listed = [&](const std::string& name) {
    return padded.find(fmt::format(" {} ", name)) != padded.npos;
  };
  for (const Node* one :
       {static_cast<const Node*>(&node), static_cast<const Node*>(renderedNode(&node))}) {
    if (!one) continue;
    if (listed(one->type().name)) return true;
    for (const std::string& kind : one->type().abstract)
      if (listed(kind)) return true;
  }
  return false;
}

// Reads the value of one field. `path` says where in the value the reader is: "[3][1]".
class Reader {
 public:
  Reader(const Node& owner, const FieldInfo& field, const FindNode& findNode)
      : owner_(owner), field_(field), findNode_(findNode) {}

  Value read(const Json& json) {
    switch (field_.type) {
    case FieldType::SFBool:
      if (!json.is_boolean()) wrong(json);
      return json.get<bool>();
    case FieldType::SFColor: return tuple<Color>(json);
    case FieldType::SFFloat: return single(json);
    case FieldType::SFImage: return image(json);
    case FieldType::SFInt32: return integer(json);
    case FieldType::SFNode: return json.is_null() ? NodeRef() : node(json);
    case FieldType::SFRotation: return tuple<Rotation>(json);
    case FieldType::SFString: return text(json);
    case FieldType::SFTime: return number(json);
    case FieldType::SFVec2f: return tuple<Vec2f>(json);
    case FieldType::SFVec3f: return tuple<Vec3f>(json);
    case FieldType::MFColor: return list<Color>(json, &Reader::tuple<Color>);
    case FieldType::MFFloat: return list<float>(json, &Reader::single);
    case FieldType::MFInt32: return list<int32_t>(json, &Reader::integer);
    case FieldType::MFNode: return list<NodeRef>(json, &Reader::listedNode);
    case FieldType::MFRotation: return list<Rotation>(json, &Reader::tuple<Rotation>);
    case FieldType::MFString: return list<std::string>(json, &Reader::text);
    case FieldType::MFTime: return list<double>(json, &Reader::number);
    case FieldType::MFVec2f: return list<Vec2f>(json, &Reader::tuple<Vec2f>);
    case FieldType::MFVec3f: return list<Vec3f>(json, &Reader::tuple<Vec3f>);
    }
    wrong(json);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw CommandError("value", fmt::format("{}.{} ({}): {}", owner_.type().name, field_.name,
                                            fieldTypeName(field_.type), what));
  }
  // Says what the whole value should be, and what stands at the place of the reader.
  [[noreturn]] void wrong(const Json& got) const {
    fail(fmt::format("{} was expected, not {}{}", expectation(field_.type), shownJson(got),
                     path_.empty() ? "" : " at value" + path_));
  }
  [[noreturn]] void wrongNumber(double got) const {
    const FieldRange& r = field_.range;
    fail(fmt::format("numbers from {} to {}{}{} were expected, not {}{}", r.minimum, r.maximum,
                     r.minimumOpen || r.maximumOpen ? " (bounds excluded)" : "",
                     std::isnan(r.also) ? "" : fmt::format(" or {}", r.also), got,
                     path_.empty() ? "" : " at value" + path_));
  }

  // Calls `read` for an element and notes its place meanwhile.
  template <class Read> auto inside(size_t index, const Read& read) {
    const size_t length = path_.size();
    path_ += fmt::format("[{}]", index);
    auto value = read();
    path_.resize(length);
    return value;
  }

  // The limits of the range are rounded to float, so that every value that was read can be written
  // back. Rotations have any axis, because the node normalises it (decision 42).
  void checkRange(double number) const {
    if (field_.type == FieldType::SFRotation || field_.type == FieldType::MFRotation) return;
    const bool wide = hasWideNumbers(field_.type);
    const auto rounded = [wide](double v) { return wide ? v : double(float(v)); };
    const FieldRange& r = field_.range;
    const double v = rounded(number), minimum = rounded(r.minimum), maximum = rounded(r.maximum);
    const bool low = r.minimumOpen ? v <= minimum : v < minimum;
    const bool high = r.maximumOpen ? v >= maximum : v > maximum;
    if ((low || high) && v != r.also) wrongNumber(number);
  }

  double number(const Json& json) {
    if (!json.is_number()) wrong(json);
    const double value = json.get<double>();
    checkRange(value);
    return value;
  }

  float single(const Json& json) {
    if (!json.is_number()) wrong(json);
    const double value = json.get<double>();
    const auto rounded = float(value);
    if (!std::isfinite(rounded))
      fail(fmt::format("a number of 32 bits was expected, not {}{}", value,
                       path_.empty() ? "" : " at value" + path_));
    checkRange(value);
    return rounded;
  }

  int32_t integer(const Json& json) {
    if (!json.is_number()) wrong(json);
    const double value = json.get<double>();
    if (value != std::floor(value) || value < std::numeric_limits<int32_t>::min() ||
        value > std::numeric_limits<int32_t>::max())
      wrong(json);
    checkRange(value);
    return int32_t(value);
  }

  std::string text(const Json& json) {
    if (!json.is_string()) wrong(json);
    return json.get<std::string>();
  }

  NodeRef node(const Json& json) {
    if (!json.is_string() && !json.is_number_unsigned()) wrong(json);
    NodeRef found = findNode_(json);
    if (!accepts(field_.nodeTypes, *found))
      fail(fmt::format("one of {} was expected, not a {}{}", field_.nodeTypes, found->type().name,
                       path_.empty() ? "" : " at value" + path_));
    return found;
  }
  // Lists of Scripts, prototypes and nodes that select one of their children may hold NULL
  // (decision 15).
  NodeRef listedNode(const Json& json) {
    const bool mayBeNull = owner_.type().index < 0 || owner_.type().is("selecting");
    return json.is_null() && mayBeNull ? NodeRef() : node(json);
  }

  template <class T> T tuple(const Json& json) {
    if (!json.is_array() || json.size() != width<T>) wrong(json);
    float numbers[width<T>];
    for (size_t i = 0; i < width<T>; ++i) numbers[i] = inside(i, [&] { return single(json[i]); });
    if constexpr (width<T> == 2)
      return {numbers[0], numbers[1]};
    else if constexpr (width<T> == 3)
      return {numbers[0], numbers[1], numbers[2]};
    else
      return {numbers[0], numbers[1], numbers[2], numbers[3]};
  }

  template <class T> std::vector<T> list(const Json& json, T (Reader::*read)(const Json&)) {
    if (!json.is_array()) wrong(json);
    std::vector<T> values;
    values.reserve(json.size());
    for (size_t i = 0; i < json.size(); ++i)
      values.push_back(inside(i, [&] { return (this->*read)(json[i]); }));
    return values;
  }

  int32_t imageNumber(const Json& json, const char* name, int32_t most) {
    const auto found = json.find(name);
    if (found == json.end()) fail(fmt::format("the member \"{}\" of the image is missing", name));
    if (!found->is_number_unsigned() || *found > most)
      fail(fmt::format("{}: a whole number from 0 to {} was expected, not {}", name, most,
                       shownJson(*found)));
    return found->get<int32_t>();
  }

  Image image(const Json& json) {
    constexpr int32_t longest = 65'536;
    if (!json.is_object()) wrong(json);
    Image image;
    image.width = imageNumber(json, "width", longest);
    image.height = imageNumber(json, "height", longest);
    image.components = imageNumber(json, "components", 4);
    const auto pixels = json.find("pixels");
    if (pixels == json.end() || !pixels->is_array() || json.size() != 4) wrong(json);
    const size_t count = image.components ? size_t(image.width) * size_t(image.height) : size_t(0);
    if (pixels->size() != count)
      fail(fmt::format("pixels: {} numbers were expected, not {}", count, pixels->size()));
    const uint32_t largest = uint32_t((uint64_t(1) << (8 * std::max(1, image.components))) - 1);
    image.pixels.reserve(count * size_t(image.components));
    for (size_t i = 0; i < count; ++i) {
      const Json& pixel = (*pixels)[i];
      if (!pixel.is_number_unsigned() || pixel.get<uint64_t>() > largest)
        fail(fmt::format("pixels[{}]: a whole number from 0 to {} was expected, not {}", i, largest,
                         shownJson(pixel)));
      for (int shift = 8 * (image.components - 1); shift >= 0; shift -= 8)
        image.pixels.push_back(uint8_t(pixel.get<uint64_t>() >> shift));
    }
    return image;
  }

  const Node& owner_;
  const FieldInfo& field_;
  const FindNode& findNode_;
  std::string path_;
};

struct Writer {
  std::string& out;
  const NumberOfNode& numberOf;

  template <class T> void write(T number) {
    if (std::isfinite(number))
      fmt::format_to(std::back_inserter(out), "{}", number);
    else
      out += "null";
  }
  template <class... T> void array(T... numbers) {
    out += '[';
    const char* comma = "";
    ((out += std::exchange(comma, ","), write(numbers)), ...);
    out += ']';
  }

  void operator()(bool v) { out += v ? "true" : "false"; }
  void operator()(float v) { write(v); }
  void operator()(double v) { write(v); }
  void operator()(int32_t v) { fmt::format_to(std::back_inserter(out), "{}", v); }
  void operator()(const std::string& v) { out += jsonText(v); }
  void operator()(const Color& v) { array(v.r, v.g, v.b); }
  void operator()(const Vec2f& v) { array(v.x, v.y); }
  void operator()(const Vec3f& v) { array(v.x, v.y, v.z); }
  void operator()(const Rotation& v) { array(v.x, v.y, v.z, v.angle); }
  void operator()(const NodeRef& v) {
    if (v)
      fmt::format_to(std::back_inserter(out), "{}", numberOf(v));
    else
      out += "null";
  }
  void operator()(const Image& v) {
    fmt::format_to(std::back_inserter(out),
                   R"({{"width":{},"height":{},"components":{},"pixels":[)", v.width, v.height,
                   v.components);
    const size_t bytes = size_t(std::max(1, v.components));
    for (size_t i = 0; i + bytes <= v.pixels.size(); i += bytes) {
      uint32_t pixel = 0;
      for (size_t k = 0; k < bytes; ++k) pixel = pixel << 8 | v.pixels[i + k];
      fmt::format_to(std::back_inserter(out), "{}{}", i ? "," : "", pixel);
    }
    out += "]}";
  }
  template <class T> void operator()(const std::vector<T>& list) {
    out += '[';
    for (size_t i = 0; i < list.size(); ++i) {
      if (i) out += ',';
      (*this)(list[i]);
    }
    out += ']';
  }
};

} // namespace

Value readValue(const Json& json, const Node& owner, const FieldInfo& field,
                const FindNode& findNode) {
  return Reader(owner, field, findNode).read(json);
}

void appendValue(std::string& out, const Value& value, const NumberOfNode& numberOf) {
  std::visit(Writer{out, numberOf}, value);
}

} // namespace vv::control
