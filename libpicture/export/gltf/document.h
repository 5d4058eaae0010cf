// document.h: A glTF 2.0 document while it is made: lists of objects as text, and the bytes of its
// buffer. Objects become text at once, so that a world of a million nodes needs no tree of them.
// [one thread]
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace picture::gltf {

// Numbers are floats, as in the buffer, so that minima and maxima are exactly those of the numbers
// there.
using Json =
    nlohmann::basic_json<std::map, std::vector, std::string, bool, int64_t, uint64_t, float>;

// componentType of accessors, and target of buffer views.
enum Component : int {
  unsignedByte = 5121,
  unsignedShort = 5123,
  unsignedInt = 5125,
  floats = 5126
};
enum Target : int { noTarget = 0, vertexTarget = 34962, indexTarget = 34963 };

// The elements of an accessor. bytes: those of `count` elements, one after the other.
struct Elements {
  std::string bytes;
  size_t count = 0;
  Component component = floats;
  const char* type = "SCALAR";
  Target target = noTarget;
  bool normalized = false;
  std::vector<float> minimum, maximum; // empty: not said
};

// Returns an object for JSON, with U+FFFD for each byte of texts that is not UTF-8.
std::string textOf(const Json& json);

class Document {
 public:
  // Adds an object to a list of the document ("nodes", "meshes"); returns its index.
  size_t add(const std::string& list, const Json& object);
  size_t countOf(const std::string& list) const;
  // Adds an object to a list of an extension of the document ("KHR_lights_punctual", "lights").
  void addExtension(const std::string& name, Json content);
  // Notes that an object has this extension.
  void use(const std::string& extension) { used_.insert(extension); }
  // Adds an accessor with a buffer view of its own; returns its index.
  size_t add(Elements elements);
  // Adds a buffer view of bytes that no accessor describes; returns its index.
  size_t addBytes(std::string bytes, Target target = noTarget);
  void addRoot(size_t node) { roots_.push_back(node); }
  // Turns all roots so far, in which z is up, about x: in glTF y is up (3.4).
  void turnZUp();

  uint64_t bufferBytes() const { return bufferBytes_; }
  // Moves the bytes of the buffer out, in pieces.
  std::vector<std::string> takeBuffer() { return std::move(buffer_); }
  // Returns the text of the document. bufferUri: where the buffer is; empty: in the binary chunk.
  std::string text(const std::string& bufferUri) const;

 private:
  struct List {
    std::string text; // the objects, with commas between them
    size_t count = 0;
  };
  std::map<std::string, List> lists_;
  std::map<std::string, Json> extensions_;
  std::set<std::string> used_;
  std::vector<size_t> roots_;
  std::vector<std::string> buffer_; // each has a multiple of 4 bytes
  uint64_t bufferBytes_ = 0;
};

} // namespace picture::gltf
