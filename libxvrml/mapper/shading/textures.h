// textures.h: the pictures of a world as OpenRT textures: one per node, or one per file and repeat
// mode. Made on first use. [the mapper's thread]
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>

#include "base/budget.h"
#include "image/image.h"
#include "image/volume.h"
#include "mapper/rt.h"
#include "xvrml/radiance.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

class Textures {
 public:
  Textures(World& world, bool linearColor)
      : world_(world), srgb_(linearColor), share_(budgetOf(world)) {}

  // Returns the texture of an ImageTexture, PixelTexture or MovieTexture node (or null), or of the
  // first texture of a MultiTexture, with a warning. Returns 0
  // if there is none or it cannot be loaded (reported once).
  RTid ofNode(Node* texture);
  // The same for a picture of numbers, such as normals, which are never decoded as colours. A node
  // that shows colours, too, stays as it was used first, with a warning if that makes a difference.
  RTid ofData(Node* texture);
  // Returns the first URL of a list that leads to a picture. node: for messages, and its file is
  // the base of relative URLs.
  RTid ofUrls(const MFString& urls, const Node& node, bool repeatS, bool repeatT);
  // The same for a face of a panorama or cube map: the picture does not repeat, whatever the node
  // says, because its edges meet those of other faces.
  RTid ofFace(Node* texture);
  // Makes a picture that the caller keeps, without repetition, and deletes it. Throws
  // std::runtime_error if the world's budget does not allow it.
  RTid add(const Image& image) { return make(image, samplingOf(false, false)); }
  RTid add(const RadianceImage& image) { return make(image, samplingOf(false, false)); }
  void drop(RTid texture);
  // Does the same for a volume, with the repetition and TextureProperties (or null) of its node.
  struct Repeats {
    bool s, t, r;
  };
  RTid add(const Volume& volume, const Repeats& repeats, const NodeRef& properties);
  // Returns the memory that another picture from a file may take.
  ImageRoom roomForPicture() const;
  // Returns a black texel, used for an environment whose picture cannot be loaded.
  RTid black();
  // Uploads the new picture of a texture node, under the same id if the node owns its picture.
  // Returns true if ofNode() now returns another id.
  bool changed(Node& texture);
  void clear(); // deletes everything
  uint64_t loaded() const { return loaded_; }
  uint64_t count() const { return count_; }
  uint64_t missing() const { return missing_; }

 private:
  // How a picture goes on beyond its edges, and how it is enlarged.
  struct Sampling {
    RTenum wrapS = RT_REPEAT, wrapT = RT_REPEAT, wrapR = RT_REPEAT;
    bool nearest = false;
    std::array<float, 4> border{}; // as the world has it; zeros where no edge leads to the border
    bool bordered() const {
      return wrapS == RT_CLAMP_TO_BORDER || wrapT == RT_CLAMP_TO_BORDER ||
             wrapR == RT_CLAMP_TO_BORDER;
    }
    auto operator<=>(const Sampling&) const = default;
  };
  static Sampling samplingOf(bool repeatS, bool repeatT);
  // The sampling of a node with TextureProperties, which may be null.
  Sampling samplingOf(bool repeatS, bool repeatT, const NodeRef& properties) const;
  RTid ofUrls(const MFString& urls, const Node& node, const Sampling& sampling);
  RTid ofFile(const std::string& path, const Sampling& sampling, std::string& error);
  // Throws std::runtime_error if the world's budget does not allow the picture.
  template <class Picture> RTid make(const Picture& image, const Sampling& sampling);
  // Sets the sampling of the bound texture. data: it holds numbers.
  void setSampling(const Sampling& sampling, bool data);
  // Gives a bordered picture of a file, which one node shows, another sampling.
  void resample(RTid texture, const Sampling& sampling);
  void dropUnused(RTid texture); // deletes a bordered picture of a file that no node shows any more
  void upload(RTid texture, const Image& image);
  void upload(RTid texture, const RadianceImage& image); // values are used unchanged
  void upload(RTid texture, const Volume& volume);
  void take(RTid texture, uint64_t bytes);
  void remove(RTid texture);
  uint64_t room() const; // bytes that still images may still take
  struct TextureEntry;
  using Entries = std::unordered_map<const Node*, TextureEntry>;
  RTid find(Node* texture, bool data);
  RTid makeNode(Node& texture, bool data, bool face = false);
  bool changedIn(Entries& entries, Node& texture, bool face);

  struct TextureEntry {
    NodeRef node;
    RTid id = 0;
    bool data = false; // ofData
  };
  World& world_;
  bool srgb_;
  bool data_ = false;                        // the picture that is being made holds numbers
  Share share_;                              // share of the world's budget
  std::unordered_map<RTid, uint64_t> bytes_; // bytes of each texture
  uint64_t count_ = 0, missing_ = 0, loaded_ = 0;
  Entries nodes_, faces_; // faces_: those of ofFace()
  // The texture of each file, by its sampling and whether it holds numbers, or the reason why there
  // is none.
  using Files = std::map<std::tuple<std::string, Sampling, bool>, std::pair<RTid, std::string>>;
  Files files_;
  std::unordered_map<RTid, Files::iterator> bordered_; // the files of bordered pictures
  // Returns whether so many nodes show a bordered picture of a file.
  bool showBordered(ptrdiff_t nodes, RTid texture) const;
};

} // namespace xvrml::mapper
