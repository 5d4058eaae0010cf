#include "as_json/field_json.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "xvrml/numbers.h"
#include "xvrml/value_text.h"
#include "xvrml/value_words.h"
#include "xvrml/versions.h"
#include "xvrml/world.h"

namespace vv::json {

using namespace xvrml;

namespace {

// How the values of fields are written in JSON.
constexpr ValueWords words{
    .colour = "an array of 3 numbers (red, green, blue)",
    .rotation = "an array of 4 numbers (axis x, y, z and angle in radians)",
    .truth = {"true or false", "an array of truth values"},
    .image = {"an object with width, height, components and pixels (a whole number for each pixel, "
              "as in VRML)",
              "an array of objects with width, height, components and pixels"},
    .node = {"the DEF name or the number of a node, or null",
             "an array of DEF names or numbers of nodes"},
    .text = {"a text", "an array of texts"},
    .whole = {"a whole number of 32 bits", "an array of whole numbers of 32 bits"},
    .number = {"a number", "an array of numbers"},
    .numbers = {"an array of {} numbers", "an array of arrays of {} numbers"}};

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
    return std::visit(
        [&](auto value) -> Value {
          read(json, value);
          return value;
        },
        defaultValue(field_.type));
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw CommandError("value", fmt::format("{}.{} ({}): {}", owner_.type().name, field_.name,
                                            fieldTypeName(field_.type), what));
  }
  // Says what the whole value should be, and what stands at the place of the reader.
  [[noreturn]] void wrong(const Json& got) const {
    fail(fmt::format("{} was expected, not {}{}", wordsFor(field_.type, words), shownJson(got),
                     path_.empty() ? "" : " at value" + path_));
  }
  [[noreturn]] void wrongNumber(double got) const {
    fail(fmt::format("numbers in {} were expected, not {}{}", describe(rangeIn(owner_, field_)),
                     got, path_.empty() ? "" : " at value" + path_));
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
    const FieldRange& r = rangeIn(owner_, field_);
    const double v = rounded(number), minimum = rounded(r.minimum), maximum = rounded(r.maximum);
    const bool low = r.minimumOpen ? v <= minimum : v < minimum;
    const bool high = r.maximumOpen ? v >= maximum : v > maximum;
    if ((low || high) && v != r.also) wrongNumber(number);
  }

  template <class T> void read(const Json& json, std::vector<T>& list) {
    if (!json.is_array()) wrong(json);
    list.reserve(json.size());
    for (size_t i = 0; i < json.size(); ++i)
      list.push_back(inside(i, [&] {
        T element{};
        if constexpr (std::is_same_v<T, NodeRef>)
          element = listedNode(json[i]);
        else
          read(json[i], element);
        return element;
      }));
  }
  template <Numeric T> void read(const Json& json, T& value) {
    auto* numbers = numbersOf(value);
    if constexpr (numberCount<T> == 1) return readNumber(json, *numbers);
    if (!json.is_array() || json.size() != size_t(numberCount<T>)) wrong(json);
    for (int i = 0; i < numberCount<T>; ++i)
      inside(size_t(i), [&] {
        readNumber(json[size_t(i)], numbers[i]);
        return 0;
      });
  }
  void read(const Json& json, bool& value) {
    if (!json.is_boolean()) wrong(json);
    value = json.get<bool>();
  }
  void read(const Json& json, std::string& value) {
    if (!json.is_string()) wrong(json);
    value = json.get<std::string>();
  }
  void read(const Json& json, Image& value) { value = image(json); }
  void read(const Json& json, NodeRef& value) {
    if (!json.is_null()) value = node(json);
  }
  void readNumber(const Json& json, float& value) { value = single(json); }
  void readNumber(const Json& json, double& value) { value = number(json); }
  void readNumber(const Json& json, int32_t& value) { value = integer(json); }

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

  int32_t imageNumber(const Json& json, const char* name, int32_t most) {
    const auto found = json.find(name);
    if (found == json.end()) fail(fmt::format("the member \"{}\" of the image is missing", name));
    // Compared as values of JSON, numbers from 2^63 on would be negative.
    if (!found->is_number_unsigned() || found->get<uint64_t>() > uint64_t(most))
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
    if (std::isfinite(double(number)))
      fmt::format_to(std::back_inserter(out), "{}", number);
    else
      out += "null";
  }
  void operator()(bool v) { out += v ? "true" : "false"; }
  template <Numeric T> void operator()(const T& v) {
    const auto* numbers = numbersOf(v);
    if constexpr (numberCount<T> == 1) return write(*numbers);
    for (int i = 0; i < numberCount<T>; ++i) {
      out += i ? ',' : '[';
      write(numbers[i]);
    }
    out += ']';
  }
  void operator()(const std::string& v) { out += jsonText(v); }
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
      (*this)(ElementOf<std::vector<T>>(list[i]));
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

} // namespace vv::json
