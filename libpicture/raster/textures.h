// textures.h: The pixels of the pictures of a world, for the z-buffer renderer. Each picture is
// decoded once. [of() and traitsOf(): the thread that owns the world; sample(): any thread]
#pragma once

#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "libpicture/export/surface.h"

namespace picture::raster {

class Textures : public PictureSource {
 public:
  // linear: samples are linear; otherwise they are numbers of the file.
  Textures(const xvrml::World& world, bool linear);
  std::optional<size_t> of(const xvrml::Node* texture) override;
  Traits traitsOf(size_t place) const override { return images_[place].traits; }
  struct Sample {
    xvrml::Color color{1, 1, 1};
    float alpha = 1;
  };
  // Returns the picture at texture coordinates of the geometry, between the four nearest pixels.
  Sample sample(const SurfacePicture& picture, double s, double t) const;

 private:
  struct Stored {
    xvrml::Image image;
    Traits traits;
  };
  Sample texel(const xvrml::Image& image, int x, int y) const;

  const xvrml::World& world_;
  std::array<float, 256> values_{}; // by byte
  std::vector<Stored> images_;
  std::unordered_map<const xvrml::Node*, std::optional<size_t>> nodes_;
  std::map<std::string, size_t> paths_; // places of pictures from files and data: URLs
};

} // namespace picture::raster
