// pictures.h: The pictures of an exported world as files that other programs read: PNG and JPEG as
// they are, all others recoded as PNG. Each is read once. [the thread that owns the world]
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "libpicture/export/picture_source.h"
#include "libpicture/export/remarks.h"

namespace picture {

struct PictureFile {
  std::string bytes; // a PNG or JPEG file
  bool isPng = true;
  int components = 3;       // as in PictureSource::Traits
  bool transparent = false; // as in PictureSource::Traits
};

class Pictures : public PictureSource {
 public:
  Pictures(const xvrml::World& world, Remarks& remarks) : world_(world), remarks_(remarks) {}
  // Returns places in files(). A node without a picture is counted in the remarks.
  std::optional<size_t> of(const xvrml::Node* texture) override;
  Traits traitsOf(size_t place) const override {
    return {files_[place].components, files_[place].transparent};
  }
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
