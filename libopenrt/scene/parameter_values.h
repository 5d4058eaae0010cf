// parameter_values.h: the values of the parameters of one shader, packed into one block of memory.
// Worlds have millions of shaders, and most of these have a few numbers. Used by the front end
// (api/scene_state.h) and by backends (scene/scene.h), each on its own thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "edits_generated.h"

namespace openrt {

// The value of one parameter. Its type says which of the members counts. It refers to memory of
// whoever made it.
struct ParameterValue {
  uint32_t index = 0; // in the class's table
  std::span<const float> floats;
  int32_t integer = 0;
  std::string_view text;
  uint32_t texture = 0;
};

ParameterValue valueOf(const edit::ParameterT& edit);
edit::ParameterT editOf(uint32_t shader, const ParameterValue& value);

class ParameterValues {
 public:
  class Iterator {
   public:
    using value_type = ParameterValue;
    using difference_type = std::ptrdiff_t;
    explicit Iterator(const std::byte* at = nullptr) : at_(at) {}
    ParameterValue operator*() const { return read(at_); }
    Iterator& operator++() {
      at_ += sizeAt(at_);
      return *this;
    }
    Iterator operator++(int) {
      Iterator before = *this;
      ++*this;
      return before;
    }
    bool operator==(const Iterator&) const = default;

   private:
    friend class ParameterValues;
    const std::byte* at_;
  };

  // The values in ascending order of their indices. They are valid until a value is set.
  Iterator begin() const { return Iterator(bytes_.data()); }
  Iterator end() const { return Iterator(bytes_.data() + bytes_.size()); }
  std::optional<ParameterValue> find(uint32_t index) const;
  // Sets the value of a parameter. The value must not refer to memory of this object. If it throws,
  // nothing is changed.
  void set(const ParameterValue& value);
  void clear() { std::vector<std::byte>().swap(bytes_); }

 private:
  struct Header;
  static Header headerAt(const std::byte* at);
  static size_t sizeAt(const std::byte* at);
  static ParameterValue read(const std::byte* at);
  Iterator notBefore(uint32_t index) const;

  std::vector<std::byte> bytes_; // the values, one after the other
};

} // namespace openrt
