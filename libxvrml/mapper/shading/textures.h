// textures.h: the pictures of a world as OpenRT textures, one per node and one per file and way of
// repeating. Made by the mapper's thread when first used.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <unordered_map>

#include "base/budget.h"
#include "mapper/rt.h"
#include "xvrml/radiance.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

class Textures {
 public:
  Textures(World& world, bool linearColor)
      : world_(world), srgb_(linearColor), share_(budgetOf(world)) {}

  // Of an ImageTexture, PixelTexture or MovieTexture node (or null); 0: there is none, or it could
  // not be had (said once).
  RTid ofNode(Node* texture);
  // The first URL of a list that leads to a picture. node: for messages and as the file that
  // relative URLs mean.
  RTid ofUrls(const MFString& urls, const Node& node, bool repeatS, bool repeatT);
  // A black texel: what is shown in place of a sky whose picture cannot be had.
  RTid black();
  // A texture node has another picture: it is handed over again, under the same id where the
  // picture is the node's own. True if ofNode() now gives another id.
  bool changed(Node& texture);
  void clear(); // deletes everything
  uint64_t loaded() const { return loaded_; }
  uint64_t count() const { return count_; }
  uint64_t missing() const { return missing_; }

 private:
  RTid ofFile(const std::string& path, bool repeatS, bool repeatT, std::string& error);
  // Throws std::runtime_error if the world's budget does not allow the picture.
  template <class Picture> RTid make(const Picture& image, bool repeatS, bool repeatT);
  void upload(RTid texture, const Image& image);
  void upload(RTid texture, const RadianceImage& image); // numbers are used as they are
  void take(RTid texture, uint64_t bytes);
  void remove(RTid texture);
  uint64_t room() const; // bytes that still pictures may still take
  RTid makeNode(Node& texture);

  struct Known {
    NodeRef node;
    RTid id = 0;
  };
  World& world_;
  bool srgb_;
  Share share_;                              // of the world's budget
  std::unordered_map<RTid, uint64_t> bytes_; // of each texture
  uint64_t count_ = 0, missing_ = 0, loaded_ = 0;
  std::unordered_map<const Node*, Known> nodes_;
  std::map<std::tuple<std::string, bool, bool>, std::pair<RTid, std::string>>
      files_; // texture, or why there is none
};

} // namespace xvrml::mapper
