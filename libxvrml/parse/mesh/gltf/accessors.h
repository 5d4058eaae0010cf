// accessors.h: the arrays of a glTF file: buffers, views of them, and accessors, which say what the
// bytes mean (glTF 2.0, 3.6). Every range is checked before it is read. [the thread that loads]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "parse/mesh/gltf/json.h"

namespace xvrml::gltf {

// The numbers of an accessor, normalized integers as 0 to 1 or -1 to 1.
struct Values {
  explicit Values(const BudgetPtr& budget) : memory(budget) {}
  Scratch memory;
  size_t components = 0; // numbers of one element; 0: nothing could be read
  std::vector<float> numbers;
  size_t size() const { return components == 0 ? 0 : numbers.size() / components; }
};

class Accessors {
 public:
  // binary: the binary chunk of a .glb file; empty: none.
  Accessors(const MeshFile& file, const Item& root, std::string_view binary);

  size_t size() const { return accessors_.size(); }
  // Reads an accessor. Reports what is wrong with it, and returns nothing then.
  Values read(size_t accessor);
  std::vector<uint32_t> readIndices(size_t accessor, Scratch& memory);
  // Returns the bytes of a buffer view; empty, after a message, if there are none.
  std::string_view viewBytes(size_t view);
  size_t viewCount() const { return views_.size(); }
  // Counts what is converted. A document of a few bytes may name one array any number of times;
  // throws MeshFault where this adds up to far more than the file holds.
  void spend(uint64_t numbers);

 private:
  struct Buffer {
    bool tried = false;
    std::string own;        // read from a file or a data: URL
    std::string_view bytes; // what the document may use
  };
  // Elements in memory: `stride` bytes from one to the next.
  struct Elements {
    const char* bytes = nullptr; // null: all are 0
    uint64_t count = 0, stride = 0;
    uint32_t componentType = 0;
    size_t components = 0;
    bool normalized = false;
  };

  std::string_view bufferBytes(size_t buffer);
  void loadBuffer(size_t buffer);
  bool readFile(const Item& item, const std::string& uri, Buffer& buffer);
  bool locate(const Item& item, Elements& elements);
  bool place(const Item& item, uint64_t view, uint64_t offset, Elements& elements);
  bool applySparse(const Item& item, const Elements& elements, std::vector<float>& numbers);

  const MeshFile& file_;
  Scratch scratch_; // memory for the buffers
  std::vector<Item> bufferItems_, views_, accessors_;
  std::vector<Buffer> buffers_;
  uint64_t present_; // bytes of the file and its buffers
  uint64_t spent_ = 0;
};

} // namespace xvrml::gltf
