// pictures.h: The pictures of an exported world as files that other programs read: PNG and JPEG as
// they are, all others recoded as PNG. Each is read once. [the thread that owns the world]
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "libpicture/export/remarks.h"
#include "xvrml/renderer.h"

namespace picture {

struct PictureFile {
  std::string bytes; // a PNG or JPEG file
  bool isPng = true;
  int components = 3;       // 1 grey, 2 grey and alpha, 3 colours, 4 colours and alpha
  bool transparent = false; // a pixel has an alpha below 1
};

class Pictures {
 public:
  Pictures(const xvrml::World& world, Remarks& remarks) : world_(world), remarks_(remarks) {}
  // Returns the place in files() of the picture of a texture node; none for null and for a node
  // without a picture, which is counted in the remarks.
  std::optional<size_t> of(const xvrml::Node* texture);
  const std::vector<PictureFile>& files() const { return files_; }
  // Returns the files that pictures were read from.
  std::vector<std::string> inputs() const;

 private:
  std::optional<size_t> read(const xvrml::Node& texture);

  const xvrml::World& world_;
  Remarks& remarks_;
  std::vector<PictureFile> files_;
  std::unordered_map<const xvrml::Node*, std::optional<size_t>> nodes_;
  std::map<std::string, size_t> paths_; // places of pictures from files and data: URLs
};

} // namespace picture
