// wire.cpp: encodes and decodes messages. Part of the library and of xvrml-script-host.
#include "script/remote/wire.h"

#include <cstring>
#include <iterator>
#include <utility>

#include "xvrml/xscript_types.h"

namespace xvrml::wire {
namespace {

constexpr uint64_t word = 8;
constexpr uint64_t absent = ~uint64_t(0); // stands for NULL in place of a length
constexpr uint64_t padding(uint64_t size) { return (word - size % word) % word; }

} // namespace

Element elementOf(XsType type) {
  const XsTypeInfo* info = xsTypeInfo(type);
  if (!info) return {Kind::unknown, 0};
  if (info->element == XS_SFSTRING) return {Kind::texts, 0};
  if (info->element == XS_SFIMAGE) return {Kind::images, 0};
  return {Kind::plain, info->bytes};
}

const char* functionName(Op op) {
  constexpr const char* names[] = {"create",   "initialize", "event",  "eventsProcessed",
                                   "shutdown", "tick",       "destroy"};
  const size_t index = size_t(op) - size_t(Op::create);
  return index < std::size(names) ? names[index] : "";
}

// --- Writer ---

void Writer::begin(Op op, uint32_t script, double time) {
  constexpr size_t keep = 1 << 20; // larger buffers are freed
  if (bytes_.capacity() > keep) bytes_ = {};
  bytes_.resize(sizeof(Header));
  header() = {0, uint16_t(op), 0, script, 0, time};
  count_ = 0;
  tooLong_ = false;
}

void Writer::raw(const void* data, uint64_t size) {
  tooLong_ = tooLong_ || size > maximumMessage - word ||
             bytes_.size() + size + padding(size) > maximumMessage;
  if (tooLong_) return;
  const size_t at = bytes_.size();
  bytes_.resize(at + size + padding(size));
  if (size > 0) std::memcpy(bytes_.data() + at, data, size);
}

void Writer::put(uint64_t number) { raw(&number, sizeof number); }
void Writer::put(double number) { raw(&number, sizeof number); }

void Writer::put(const char* name) { put(XsString{name, name ? std::strlen(name) : 0}); }

// Writes a text: its length, then its characters and a zero. A missing text is `absent` and its
// claimed length.
void Writer::put(const XsString& text) {
  if (!text.data) {
    put(absent);
    put(text.bytes);
    return;
  }
  put(text.bytes);
  tooLong_ = tooLong_ || text.bytes >= maximumMessage;
  if (tooLong_) return;
  raw(text.data, text.bytes);
  if (padding(text.bytes) == 0) put(uint64_t(0)); // otherwise the padding contains the zero
}

void Writer::put(const XsValue* value) {
  const Element element = value ? elementOf(value->type) : Element{};
  const bool data = value && element.kind != Kind::unknown && value->count > 0 && value->of.data;
  put(uint64_t(value != nullptr));
  if (!value) return;
  put(uint64_t(uint32_t(value->type)));
  put(uint64_t(value->count));
  put(uint64_t(data));
  if (!data) return;
  if (element.kind == Kind::plain)
    return raw(value->of.data, uint64_t(value->count) * element.bytes);
  for (uint32_t i = 0; i < value->count && !tooLong_; ++i) {
    if (element.kind == Kind::texts) {
      put(value->of.strings[i]);
      continue;
    }
    const XsImage& image = value->of.images[i];
    const bool size =
        image.width >= 0 && image.height >= 0 && image.components >= 0 && image.components <= 4;
    const uint64_t pixels =
        size ? uint64_t(image.width) * uint64_t(image.height) * uint64_t(image.components) : 0;
    for (const int32_t number : {image.width, image.height, image.components}) put(number);
    put(image.pixels ? pixels : absent);
    if (image.pixels) raw(image.pixels, pixels);
  }
}

void Writer::put(const XsField& field) {
  put(field.name);
  put(uint32_t(field.type));
  put(uint32_t(field.access));
}

void Writer::put(const XsNodeInfo& info) {
  put(info.fieldCount);
  put(info.typeName);
  put(info.defName);
}

void Writer::put(const XsNode* nodes) {
  put(uint64_t(nodes != nullptr));
  if (nodes) raw(nodes, uint64_t(count_) * sizeof(XsNode));
}

void Writer::put(const XsString* texts) {
  put(uint64_t(texts != nullptr));
  for (uint32_t i = 0, count = texts ? count_ : 0; i < count && !tooLong_; ++i) put(texts[i]);
}

bool Writer::finish() {
  header().bytes = uint32_t(bytes_.size() - sizeof(Header));
  return !tooLong_;
}

// --- Reader ---

const char* Reader::raw(uint64_t size) {
  good_ = good_ && size <= uint64_t(end_ - at_) && size + padding(size) <= uint64_t(end_ - at_);
  return good_ ? std::exchange(at_, at_ + size + padding(size)) : nullptr;
}

void Reader::get(uint64_t& number) {
  number = 0;
  if (const char* data = raw(sizeof number)) std::memcpy(&number, data, sizeof number);
}

void Reader::get(uint32_t& number) {
  const auto wide = take<uint64_t>();
  good_ = good_ && wide <= UINT32_MAX;
  number = count_ = good_ ? uint32_t(wide) : 0;
}

void Reader::get(int32_t& number) {
  const auto wide = take<uint64_t>();
  good_ = good_ && wide <= UINT32_MAX;
  number = good_ ? int32_t(uint32_t(wide)) : 0;
}

void Reader::get(double& number) {
  number = 0;
  if (const char* data = raw(sizeof number)) std::memcpy(&number, data, sizeof number);
}

void Reader::get(const char*& name) { name = take<XsString>().data; }

void Reader::get(XsString& text) {
  text = {};
  const auto size = take<uint64_t>();
  if (size == absent) return get(text.bytes);
  const char* data = good_ && size < maximumMessage
                         ? raw(size + 1)
                         : nullptr; // the zero is in the padding or in the next word
  good_ = data && data[size] == 0;
  if (good_) text = {data, size};
}

const XsString* Reader::strings(uint64_t count) {
  good_ = good_ && count <= uint64_t(end_ - at_) / (2 * word); // no text is shorter than two words
  if (!good_) return nullptr;
  std::vector<XsString>& list = strings_.emplace_back(count);
  for (XsString& text : list) get(text);
  return list.data();
}

void Reader::get(const XsValue*& value) {
  value = nullptr;
  const auto there = take<uint64_t>();
  good_ = good_ && there <= 1;
  if (!good_ || !there) return;
  XsValue& v = values_.emplace_back();
  v.type = XsType(take<uint32_t>() & 0x7fffffffu);
  const auto count = take<uint32_t>();
  const auto data = take<uint64_t>();
  const Element element = elementOf(v.type);
  good_ = good_ && data <= 1 && (!data || (element.kind != Kind::unknown && count > 0));
  if (!good_) return;
  v.count = count;
  value = &v;
  if (!data) return;
  if (element.kind == Kind::plain) {
    v.of.data = raw(uint64_t(count) * element.bytes);
  } else if (element.kind == Kind::texts) {
    v.of.strings = strings(count);
  } else {
    good_ = count <= uint64_t(end_ - at_) / (4 * word);
    if (!good_) return;
    std::vector<XsImage>& list = images_.emplace_back(count);
    for (XsImage& image : list) {
      for (int32_t* number : {&image.width, &image.height, &image.components}) get(*number);
      const auto size = take<uint64_t>();
      if (size == absent) continue;
      const bool sizes =
          image.width >= 0 && image.height >= 0 && image.components >= 0 && image.components <= 4;
      // This is below 2^62.
      const uint64_t pixels = sizes ? uint64_t(image.width) * uint64_t(image.height) : 0;
      good_ = good_ && size == pixels * uint64_t(sizes ? image.components : 0);
      image.pixels = reinterpret_cast<const uint8_t*>(raw(size));
    }
    v.of.images = list.data();
  }
  if (!good_) value = nullptr;
}

void Reader::get(XsValue& value) {
  const auto* there = take<const XsValue*>();
  good_ = good_ && there;
  value = there ? *there : XsValue{};
}

void Reader::get(XsField& field) {
  field.name = take<const char*>();
  field.type = XsType(take<uint32_t>() & 0x7fffffffu);
  field.access = XsAccess(take<uint32_t>() & 0x7fffffffu);
  good_ = good_ && field.name && elementOf(field.type).kind != Kind::unknown &&
          field.access >= XS_FIELD && field.access <= XS_EVENT_OUT;
}

void Reader::get(XsNodeInfo& info) {
  info.fieldCount = take<uint32_t>();
  info.typeName = take<const char*>();
  info.defName = take<const char*>();
  good_ = good_ && info.typeName && info.defName;
}

void Reader::get(const XsNode*& nodes) {
  nodes = nullptr;
  const uint32_t count = count_;
  if (take<uint64_t>() != 0)
    nodes = reinterpret_cast<const XsNode*>(raw(uint64_t(count) * sizeof(XsNode)));
}

void Reader::get(const XsString*& texts) {
  texts = nullptr;
  const uint32_t count = count_;
  if (take<uint64_t>() != 0) texts = strings(count);
}

} // namespace xvrml::wire
