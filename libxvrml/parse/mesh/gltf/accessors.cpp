// accessors.cpp: loads buffers, and converts the elements of accessors to floats.
#include "parse/mesh/gltf/accessors.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/data_url.h"
#include "base/regular_file.h"

namespace xvrml::gltf {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr uint64_t timesRead = 100; // how often a file may use its arrays

enum ComponentType : uint32_t {
  signedByte = 5120,
  unsignedByte = 5121,
  signedShort = 5122,
  unsignedShort = 5123,
  unsignedInt = 5125,
  floatType = 5126
};

size_t bytesOf(uint32_t type) {
  switch (type) {
  case signedByte:
  case unsignedByte: return 1;
  case signedShort:
  case unsignedShort: return 2;
  case unsignedInt:
  case floatType: return 4;
  default: return 0;
  }
}

// Returns the numbers of an element. The columns of small matrices, which begin at multiples of 4
// bytes, are never needed here.
size_t componentsOf(std::string_view type) {
  constexpr std::pair<std::string_view, size_t> rows[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  for (const auto& [name, count] : rows)
    if (name == type) return count;
  return 0;
}

template <class T> T load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// glTF 2.0, 3.11 "Animations" and 3.6.2.3: f = c / 255 and so on; at least -1.
template <class T> float normalized(T value) {
  return std::max(float(value) / float(std::numeric_limits<T>::max()), -1.0f);
}

template <class T> void convert(const char* bytes, size_t count, bool norm, float* out) {
  for (size_t i = 0; i < count; ++i) {
    const T value = load<T>(bytes + i * sizeof(T));
    out[i] = norm ? normalized(value) : float(value);
  }
}

void convert(const char* bytes, uint32_t type, size_t count, bool norm, float* out) {
  switch (type) {
  case signedByte: return convert<int8_t>(bytes, count, norm, out);
  case unsignedByte: return convert<uint8_t>(bytes, count, norm, out);
  case signedShort: return convert<int16_t>(bytes, count, norm, out);
  case unsignedShort: return convert<uint16_t>(bytes, count, norm, out);
  case unsignedInt: return convert<uint32_t>(bytes, count, norm, out);
  default: std::memcpy(out, bytes, count * sizeof(float));
  }
}

uint32_t loadIndex(const char* bytes, uint32_t type) {
  switch (type) {
  case unsignedByte: return load<uint8_t>(bytes);
  case unsignedShort: return load<uint16_t>(bytes);
  default: return load<uint32_t>(bytes);
  }
}

bool isIndexType(uint32_t type) {
  return type == unsignedByte || type == unsignedShort || type == unsignedInt;
}

} // namespace

Accessors::Accessors(const MeshFile& file, const Item& root, std::string_view binary)
    : file_(file), scratch_(file.budget), bufferItems_(root.list("buffers")),
      views_(root.list("bufferViews")), accessors_(root.list("accessors")),
      buffers_(bufferItems_.size()), present_(file.bytes.size()) {
  if (!buffers_.empty() && !bufferItems_[0].has("uri") && !binary.empty())
    buffers_[0] = {true, {}, binary};
}

std::string_view Accessors::bufferBytes(size_t buffer) {
  if (!buffers_[buffer].tried) loadBuffer(buffer);
  return buffers_[buffer].bytes;
}

void Accessors::loadBuffer(size_t number) {
  Buffer& buffer = buffers_[number];
  const Item& item = bufferItems_[number];
  buffer.tried = true;
  const std::string* uri = item.longText("uri");
  if (!uri) return item.error("the buffer has no uri, and the file no binary chunk for it");
  if (isDataUrl(*uri)) {
    scratch_.take(uri->size());
    DataUrl data;
    std::string why;
    if (!decodeDataUrl(*uri, file_.options.limits.fileBytes, data, why)) return item.error(why);
    buffer.own = std::move(data.bytes);
  } else if (!readFile(item, *uri, buffer)) {
    return;
  }
  buffer.bytes = buffer.own;
  present_ += buffer.own.size();
}

void Accessors::spend(uint64_t numbers) {
  const uint64_t limit = file_.options.limits.arrayElements;
  spent_ += numbers;
  if (spent_ > limit && spent_ / timesRead > present_)
    throw MeshFault{nullptr, fmt::format("the arrays that are used have more numbers than limit "
                                         "arrayElements={} and than {} times the bytes of the "
                                         "file; the rest of it is left out",
                                         limit, timesRead)};
}

bool Accessors::readFile(const Item& item, const std::string& uri, Buffer& buffer) {
  const ResolvedUrl resolved = resolveUrl(uri, file_.path, file_.options);
  if (!resolved.error.empty()) {
    item.error(resolved.error);
    return false;
  }
  try {
    const RegularFile binary(resolved.path);
    const uint64_t limit = file_.options.limits.fileBytes;
    if (binary.size() > limit)
      throw std::runtime_error(
          fmt::format("it has {} bytes: more than limit fileBytes={}", binary.size(), limit));
    scratch_.take(binary.size());
    buffer.own.resize(binary.size());
    buffer.own.resize(binary.read(0, buffer.own.data(), buffer.own.size()));
    return true;
  } catch (const std::runtime_error& error) {
    item.error(fmt::format("'{}': {}", shortenedUrl(uri), error.what()));
    return false;
  }
}

std::string_view Accessors::viewBytes(size_t view) {
  const Item& item = views_[view];
  const auto buffer = item.index("buffer", buffers_.size());
  if (!buffer) {
    if (!item.has("buffer")) item.error("the view names no buffer");
    return {};
  }
  const std::string_view bytes = bufferBytes(*buffer);
  if (bytes.empty()) return {}; // reported with the buffer
  const uint64_t offset = item.count("byteOffset", 0), length = item.count("byteLength", 0);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    item.error(fmt::format("{} bytes from {} on are not in the buffer, which has {}", length,
                           offset, bytes.size()));
    return {};
  }
  return bytes.substr(offset, length);
}

// Sets the bytes of elements in a view. Their last byte must be in it.
bool Accessors::place(const Item& item, uint64_t view, uint64_t offset, Elements& elements) {
  const std::string_view bytes = viewBytes(view);
  if (bytes.empty()) return false;
  const uint64_t size = bytesOf(elements.componentType) * elements.components;
  elements.stride = views_[view].count("byteStride", size);
  if (elements.stride < size || elements.stride > 255) {
    if (elements.stride != size) {
      views_[view].error(fmt::format("byteStride {} is not from {} to 252", elements.stride, size));
      return false;
    }
  }
  const bool fits = elements.count == 0 ||
                    (offset <= bytes.size() && size <= bytes.size() - offset &&
                     (elements.count - 1) <= (bytes.size() - offset - size) / elements.stride);
  if (!fits) {
    item.error(fmt::format("{} elements are not in the buffer view, which has {} bytes",
                           elements.count, bytes.size()));
    return false;
  }
  elements.bytes = bytes.data() + offset;
  return true;
}

bool Accessors::locate(const Item& item, Elements& elements) {
  elements.componentType = uint32_t(item.count("componentType", 0));
  elements.components = componentsOf(item.text("type"));
  elements.count = item.count("count", 0);
  elements.normalized = item.boolean("normalized", false);
  if (bytesOf(elements.componentType) == 0 || elements.components == 0) {
    item.error("the accessor has no componentType and type that are known");
    return false;
  }
  const Limits& limits = file_.options.limits;
  if (elements.count > limits.arrayElements / elements.components) {
    item.error(fmt::format("{} elements: more numbers than limit arrayElements={}", elements.count,
                           limits.arrayElements));
    return false;
  }
  spend(elements.count * elements.components);
  const auto view = item.index("bufferView", views_.size());
  if (!view) return !item.has("bufferView");
  return place(item, *view, item.count("byteOffset", 0), elements);
}

Values Accessors::read(size_t accessor) {
  const Item& item = accessors_[accessor];
  Elements elements;
  Values values(file_.budget);
  if (!locate(item, elements)) return values;
  const size_t total = elements.count * elements.components;
  values.memory.take(total * sizeof(float));
  values.numbers.resize(total);
  for (uint64_t i = 0; elements.bytes && i < elements.count; ++i)
    convert(elements.bytes + i * elements.stride, elements.componentType, elements.components,
            elements.normalized, &values.numbers[i * elements.components]);
  if (item.has("sparse") && !applySparse(item.object("sparse"), elements, values.numbers))
    return values;
  values.components = elements.components;
  return values;
}

// Replaces single elements (glTF 2.0, 3.6.2.4).
bool Accessors::applySparse(const Item& item, const Elements& elements,
                            std::vector<float>& numbers) {
  const Item indexItem = item.object("indices"), valueItem = item.object("values");
  const auto indexView = indexItem.index("bufferView", views_.size());
  const auto valueView = valueItem.index("bufferView", views_.size());
  Elements index, values = elements;
  index.count = values.count = item.count("count", 0);
  index.componentType = uint32_t(indexItem.count("componentType", 0));
  index.components = 1;
  if (!indexView || !valueView || !isIndexType(index.componentType)) {
    item.error("the sparse accessor does not name its indices and values");
    return false;
  }
  if (!place(indexItem, *indexView, indexItem.count("byteOffset", 0), index) ||
      !place(valueItem, *valueView, valueItem.count("byteOffset", 0), values))
    return false;
  spend(index.count * values.components);
  for (uint64_t i = 0; i < index.count; ++i) {
    const uint64_t to = loadIndex(index.bytes + i * index.stride, index.componentType);
    if (to >= elements.count) {
      item.error(fmt::format("the sparse index {} is not below {}", to, elements.count));
      return false;
    }
    convert(values.bytes + i * values.stride, values.componentType, values.components,
            values.normalized, &numbers[to * values.components]);
  }
  return true;
}

std::vector<uint32_t> Accessors::readIndices(size_t accessor, Scratch& memory) {
  const Item& item = accessors_[accessor];
  Elements elements;
  if (!locate(item, elements)) return {};
  if (elements.components != 1 || !isIndexType(elements.componentType) || !elements.bytes) {
    item.error("expected indices: SCALAR of unsigned bytes, shorts or integers");
    return {};
  }
  memory.take(elements.count * sizeof(uint32_t));
  std::vector<uint32_t> indices(elements.count);
  for (uint64_t i = 0; i < elements.count; ++i)
    indices[i] = loadIndex(elements.bytes + i * elements.stride, elements.componentType);
  return indices;
}

} // namespace xvrml::gltf
