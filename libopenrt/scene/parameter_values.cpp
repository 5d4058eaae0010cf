// parameter_values.cpp: the layout of packed values. A value is a header, then its integer and its
// texture unless they are 0, then its floats and its text. Everything is aligned to four bytes.
#include "scene/parameter_values.h"

#include <cstring>

namespace openrt {

struct ParameterValues::Header {
  uint32_t index;
  uint32_t floats : 30;
  uint32_t hasInteger : 1;
  uint32_t hasTexture : 1;
  uint32_t textBytes;
};

namespace {

constexpr size_t aligned(size_t bytes) { return (bytes + 3) / 4 * 4; }

} // namespace

ParameterValue valueOf(const edit::ParameterT& edit) {
  return {edit.index, edit.floats, edit.integer, edit.text, edit.texture};
}

edit::ParameterT editOf(uint32_t shader, const ParameterValue& value) {
  edit::ParameterT edit;
  edit.shader = shader;
  edit.index = value.index;
  edit.floats.assign(value.floats.begin(), value.floats.end());
  edit.integer = value.integer;
  edit.text = value.text;
  edit.texture = value.texture;
  return edit;
}

ParameterValues::Header ParameterValues::headerAt(const std::byte* at) {
  Header header;
  std::memcpy(&header, at, sizeof header);
  return header;
}

size_t ParameterValues::sizeAt(const std::byte* at) {
  const Header header = headerAt(at);
  return sizeof header + 4 * (size_t(header.hasInteger) + header.hasTexture + header.floats) +
         aligned(header.textBytes);
}

ParameterValue ParameterValues::read(const std::byte* at) {
  const Header header = headerAt(at);
  ParameterValue value;
  value.index = header.index;
  at += sizeof header;
  if (header.hasInteger) {
    std::memcpy(&value.integer, at, sizeof value.integer);
    at += sizeof value.integer;
  }
  if (header.hasTexture) {
    std::memcpy(&value.texture, at, sizeof value.texture);
    at += sizeof value.texture;
  }
  value.floats = {reinterpret_cast<const float*>(at), header.floats};
  value.text = {reinterpret_cast<const char*>(at + 4 * size_t(header.floats)), header.textBytes};
  return value;
}

ParameterValues::Iterator ParameterValues::notBefore(uint32_t index) const {
  Iterator it = begin();
  while (it != end() && headerAt(it.at_).index < index) ++it;
  return it;
}

std::optional<ParameterValue> ParameterValues::find(uint32_t index) const {
  const Iterator it = notBefore(index);
  if (it == end() || headerAt(it.at_).index != index) return std::nullopt;
  return *it;
}

void ParameterValues::set(const ParameterValue& value) {
  const Header header{value.index, uint32_t(value.floats.size()), value.integer != 0,
                      value.texture != 0, uint32_t(value.text.size())};
  const Iterator it = notBefore(value.index);
  const size_t offset = size_t(it.at_ - begin().at_);
  const size_t before = it != end() && headerAt(it.at_).index == value.index ? sizeAt(it.at_) : 0;
  const size_t size = sizeof header +
                      4 * (size_t(header.hasInteger) + header.hasTexture + header.floats) +
                      aligned(header.textBytes);
  const auto place = bytes_.begin() + std::ptrdiff_t(offset);
  if (size > before)
    bytes_.insert(place + std::ptrdiff_t(before), size - before, std::byte());
  else
    bytes_.erase(place + std::ptrdiff_t(size), place + std::ptrdiff_t(before));
  std::byte* out = bytes_.data() + offset;
  const auto write = [&out](const void* data, size_t count) {
    if (count > 0) std::memcpy(out, data, count);
    out += count;
  };
  write(&header, sizeof header);
  if (header.hasInteger) write(&value.integer, sizeof value.integer);
  if (header.hasTexture) write(&value.texture, sizeof value.texture);
  write(value.floats.data(), value.floats.size_bytes());
  write(value.text.data(), value.text.size());
}

} // namespace openrt
