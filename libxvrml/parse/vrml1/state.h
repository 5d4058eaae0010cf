// state.h: the traversal state of VRML 1.0: the property nodes that apply to the shapes that
// follow. It also notes which properties are read, so that a node that is USEd again in a state
// that agrees in these properties need not be converted again. The accumulated transformation
// (placement.h) is not a part of it: it acts on groups, never within a shape.
#pragma once

#include <array>
#include <cstdint>

#include "parse/vrml1/tree.h"

namespace xvrml::vrml1 {

struct TextureChain;

enum class Slot : uint8_t {
  coordinate,
  fontStyle,
  material,
  materialBinding,
  normal,
  normalBinding,
  shapeHints,
  texture,
  textureCoordinate,
  textureTransform
};
inline constexpr size_t slotCount = 10;

class State {
 public:
  using Values = std::array<const void*, slotCount>;

  // Returns the property node in effect, or null if the defaults hold.
  const TreeNode* node(Slot slot) { return static_cast<const TreeNode*>(read(slot)); }
  const TextureChain* textureTransform() {
    return static_cast<const TextureChain*>(read(Slot::textureTransform));
  }
  void set(Slot slot, const void* value) {
    values_[size_t(slot)] = value;
    written_ |= bit(slot);
  }

  const Values& values() const { return values_; }
  // Holds what a Separator keeps at its beginning and restores at its end.
  struct Saved {
    Values values;
    uint32_t written;
  };
  Saved save() const { return {values_, written_}; }
  void restore(const Saved& saved) {
    values_ = saved.values;
    written_ = saved.written;
  }

  // A record of the slots that are read before they are written. end() returns them; they also
  // count as read by the record around this one.
  struct Record {
    uint32_t read = 0, written = 0;
  };
  Record begin() {
    const Record outer{read_, written_};
    read_ = written_ = 0;
    return outer;
  }
  uint32_t end(const Record& outer) {
    const uint32_t mask = read_;
    read_ = outer.read;
    written_ = outer.written;
    noteRead(mask);
    return mask;
  }
  void noteRead(uint32_t mask) { read_ |= mask & ~written_; }

 private:
  static constexpr uint32_t bit(Slot slot) { return 1u << unsigned(slot); }
  const void* read(Slot slot) {
    noteRead(bit(slot));
    return values_[size_t(slot)];
  }

  Values values_{};
  uint32_t read_ = 0, written_ = 0;
};

} // namespace xvrml::vrml1
