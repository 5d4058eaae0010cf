#include "mapper/shading/textures.h"

#include <algorithm>
#include <exception>
#include <stdexcept>

#include "image/decoders.h"
#include "image/picture_urls.h"
#include "xvrml/media.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

namespace {

bool usable(const Image& image) {
  if (image.width <= 0 || image.height <= 0 || image.components < 1 || image.components > 4)
    return false;
  return image.pixels.size() >=
         size_t(image.width) * size_t(image.height) * size_t(image.components);
}

bool usable(const RadianceImage& image) { return image.width > 0 && image.height > 0; }
bool usable(const Volume& volume) { return !volume.pixels.empty(); }

// The picture of a node that owns its pixels; `image` is null if it has none at present.
struct OwnImage {
  const Image* image = nullptr;
  bool repeatS = true, repeatT = true;
  NodeRef properties; // TextureProperties
};
bool ownImage(Node& node, OwnImage& own) {
  if (auto* pixels = nodeCast<nodes::PixelTexture>(&node)) {
    own = {pixels->image.components > 0 ? &pixels->image : nullptr, pixels->repeatS,
           pixels->repeatT, pixels->textureProperties};
    return true;
  }
  if (auto* movie = nodeCast<nodes::MovieTexture>(&node)) {
    own = {currentImage(node), movie->repeatS, movie->repeatT, movie->textureProperties};
    return true;
  }
  return false;
}

} // namespace

RTid Textures::ofNode(Node* texture) { return find(texture, false); }

RTid Textures::ofData(Node* texture) { return find(texture, true); }

RTid Textures::find(Node* texture, bool data) {
  Node* node = renderedNode(texture);
  if (const auto* multi = nodeCast<nodes::MultiTexture>(node)) {
    world_.diagnostics.warn(node->source,
                            "MultiTexture: only the texture of an appearance and diffuseTexture of "
                            "a Material have layers; here the first texture is used");
    node = multi->texture.empty() ? nullptr : renderedNode(multi->texture[0].get());
  }
  if (!node) return 0;
  const auto [it, fresh] = nodes_.try_emplace(node, TextureEntry{NodeRef(node), 0, data});
  if (!fresh) {
    if (it->second.data != data && srgb_)
      world_.diagnostics.warn(node->source, node->type().name +
                                                ": one node shows colours and holds numbers; use "
                                                "two nodes, because only colours are decoded");
    return it->second.id;
  }
  const RTid id = makeNode(*node, data);
  return nodes_[node].id = id;
}

RTid Textures::ofFace(Node* texture) {
  Node* node = renderedNode(texture);
  if (!node) return 0;
  const auto [it, fresh] = faces_.try_emplace(node, TextureEntry{NodeRef(node), 0, false});
  if (!fresh) return it->second.id;
  const RTid id = makeNode(*node, false, true);
  return faces_[node].id = id;
}

void Textures::drop(RTid texture) {
  if (texture == 0) return;
  remove(texture);
  --count_;
}

RTid Textures::add(const Volume& volume, const Repeats& repeats, const NodeRef& properties) {
  Sampling sampling = samplingOf(repeats.s, repeats.t, properties);
  if (!properties) sampling.wrapR = repeats.r ? RT_REPEAT : RT_CLAMP_TO_EDGE;
  return make(volume, sampling);
}

ImageRoom Textures::roomForPicture() const {
  return {world_.options.limits, room(), share_.budget().get()};
}

RTid Textures::makeNode(Node& node, bool data, bool face) {
  data_ = data;
  struct Reset {
    bool& flag;
    ~Reset() { flag = false; }
  } reset{data_};
  if (auto* image = nodeCast<nodes::ImageTexture>(&node))
    return ofUrls(image->url, node,
                  face ? samplingOf(false, false)
                       : samplingOf(image->repeatS, image->repeatT, image->textureProperties));
  RTid id = 0;
  if (OwnImage own; ownImage(node, own)) {
    try {
      if (own.image)
        id = make(*own.image, face ? samplingOf(false, false)
                                   : samplingOf(own.repeatS, own.repeatT, own.properties));
    } catch (const std::runtime_error& failure) {
      world_.diagnostics.error(node.source, node.type().name + ": no picture: " + failure.what());
    }
    if (!node.live && nodeCast<nodes::MovieTexture>(&node))
      world_.diagnostics.warn(
          node.source,
          "MovieTexture: films play in a running world; the surface is drawn without it");
    report(world_.diagnostics, node.source, node.type().name);
  } else if (node.type().is("environmentTexture")) {
    world_.diagnostics.warn(node.source,
                            node.type().name +
                                ": a cube map is drawn as the texture of an Appearance with a "
                                "Material, or as diffuseTexture of that; here it is left out");
  } else if (node.type().is("texture3D")) {
    world_.diagnostics.warn(node.source,
                            node.type().name +
                                ": a volume is drawn as the texture of an Appearance, or as the "
                                "texture of a material that gives its colour; here it is left out");
  } else {
    world_.diagnostics.warn(node.source, node.type().name + " is not a texture that can be drawn");
  }
  return id;
}

void Textures::clear() {
  std::vector<RTid> ids;
  for (const Entries* entries : {&nodes_, &faces_})
    for (const auto& [node, known] : *entries) ids.push_back(known.id);
  for (const auto& [file, made] : files_) ids.push_back(made.first);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (const RTid id : ids)
    if (id != 0) rtDeleteTexture(id);
  share_.clear();
}

bool Textures::changed(Node& node) {
  if (nodeCast<nodes::MultiTexture>(&node)) return true;
  const bool other = changedIn(nodes_, node, false);
  return changedIn(faces_, node, true) || other;
}

bool Textures::changedIn(Entries& entries, Node& node, bool face) {
  const auto found = entries.find(&node);
  if (found == entries.end()) return false; // the texture is loaded on first use
  const RTid before = found->second.id;
  if (OwnImage own; before != 0 && ownImage(node, own) && own.image && usable(*own.image)) {
    rtBindTexture(before);
    if (own.properties && !face)
      setSampling(samplingOf(own.repeatS, own.repeatT, own.properties), found->second.data);
    try {
      upload(before, *own.image);
    } catch (const std::runtime_error& failure) { // as makeNode() does
      world_.diagnostics.error(node.source, node.type().name + ": no picture: " + failure.what());
      remove(before);
      --count_;
      entries[&node].id = 0;
    }
    report(world_.diagnostics, node.source, node.type().name);
    return entries[&node].id != before;
  }
  if (OwnImage own; before != 0 && ownImage(node, own)) { // the node has no picture any more
    remove(before);
    --count_;
  }
  if (const auto* file = nodeCast<nodes::ImageTexture>(&node); file && before != 0 && !face)
    resample(before, samplingOf(file->repeatS, file->repeatT, file->textureProperties));
  const RTid id = makeNode(node, found->second.data, face);
  entries[&node].id = id;
  if (id != before) dropUnused(before);
  return id != before;
}

RTid Textures::ofUrls(const MFString& urls, const Node& node, bool repeatS, bool repeatT) {
  return ofUrls(urls, node, samplingOf(repeatS, repeatT));
}

RTid Textures::ofUrls(const MFString& urls, const Node& node, const Sampling& sampling) {
  RTid id = 0;
  const std::string error =
      openFirst(urls, node, world_, [&](const std::string& path, std::string& why) {
        id = ofFile(path, sampling, why);
        return id != 0;
      });
  if (id != 0 || urls.empty()) return id;
  ++missing_;
  world_.diagnostics.warn(node.source, node.type().name + ": no picture: " + error);
  return 0;
}

RTid Textures::black() {
  RTid& texture = files_[{std::string(), Sampling(), false}].first; // no file has an empty path
  if (texture == 0) {
    RadianceImage texel;
    texel.width = texel.height = 1;
    texel.rgb.assign(3, 0.0f);
    texture = make(texel, samplingOf(false, false));
  }
  return texture;
}

RTid Textures::ofFile(const std::string& path, const Sampling& sampling, std::string& error) {
  const auto [it, fresh] = files_.try_emplace({path, sampling, data_}, 0, std::string());
  auto& [id, why] = it->second;
  if (fresh) {
    try {
      const ImageRoom room = roomForPicture();
      id = std::visit([&](const auto& picture) { return make(picture, sampling); },
                      decodePicture(readPictureFile(path, room), room));
      if (id == 0 && rtGetError() != RT_NO_ERROR) why = rtGetErrorMessage();
      if (id != 0 && sampling.bordered()) bordered_.emplace(id, it);
    } catch (const std::exception& failure) { why = failure.what(); }
  }
  error = why;
  return id;
}

// Returns how many bytes pictures from files may still take. All together may take 4 bytes for each
// pixel that a single one may have.
uint64_t Textures::room() const {
  const uint64_t pixels = world_.options.limits.imagePixels;
  const uint64_t most = pixels > ~uint64_t(0) / 4 ? ~uint64_t(0) : 4 * pixels;
  return most - std::min(most, share_.bytes());
}

void Textures::remove(RTid texture) {
  rtDeleteTexture(texture);
  if (const auto found = bytes_.find(texture); found != bytes_.end()) {
    share_.give(found->second);
    bytes_.erase(found);
  }
}

// Charges a texture's pixels to the budget.
void Textures::take(RTid texture, uint64_t wanted) {
  uint64_t& bytes = bytes_[texture];
  if (wanted > bytes && !share_.take(wanted - bytes))
    throw std::runtime_error("together with the rest of the world, " + std::to_string(wanted) +
                             " bytes are more than " + share_.budget()->name());
  if (wanted < bytes) share_.give(bytes - wanted);
  bytes = wanted;
}

void Textures::upload(RTid texture, const Image& image) {
  take(texture, image.pixels.size());
  rtTexImage2D(image.components, image.width, image.height, RT_UNSIGNED_BYTE, image.pixels.data());
  ++loaded_;
}

void Textures::upload(RTid texture, const RadianceImage& image) {
  take(texture, image.rgb.size() * sizeof(float));
  rtTexImage2D(3, image.width, image.height, RT_FLOAT, image.rgb.data());
  ++loaded_;
}

void Textures::upload(RTid texture, const Volume& volume) {
  take(texture, volume.pixels.size());
  rtTexImage3D(volume.components, volume.width, volume.height, volume.depth, RT_UNSIGNED_BYTE,
               volume.pixels.data());
  ++loaded_;
}

template <class Picture> RTid Textures::make(const Picture& image, const Sampling& sampling) {
  if (!usable(image)) return 0;
  RTid id = 0;
  rtGenTextures(1, &id);
  if (id == 0) return 0;
  rtBindTexture(id);
  try {
    upload(id, image);
  } catch (...) {
    remove(id);
    throw;
  }
  setSampling(sampling, data_);
  rtTexParameteri(RT_TEXTURE_SRGB, srgb_ && !data_ ? 1 : 0);
  ++count_;
  return id;
}

} // namespace xvrml::mapper
