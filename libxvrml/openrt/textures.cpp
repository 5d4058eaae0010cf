// textures.cpp: see textures.h.
#include "openrt/textures.h"

#include <exception>

#include "image/image.h"
#include "xvrml/nodes.h"

namespace xvrml::mapping {

RTid Textures::ofNode(Node* texture) {
  Node* node = renderedNode(texture);
  if (!node) return 0;
  const auto [it, fresh] = nodes_.try_emplace(node, 0);
  if (!fresh) return it->second;
  RTid id = 0;
  if (auto* image = nodeCast<nodes::ImageTexture>(node)) {
    id = ofUrls(image->url, *node, image->repeatS, image->repeatT);
  } else if (auto* pixels = nodeCast<nodes::PixelTexture>(node)) {
    if (pixels->image.components > 0) id = make(pixels->image, pixels->repeatS, pixels->repeatT);
    report(world_.diagnostics, node->source, "PixelTexture");
  } else if (nodeCast<nodes::MovieTexture>(node)) {
    world_.diagnostics.warn(node->source, "MovieTexture: films are not decoded; the surface is drawn without it");
  } else {
    world_.diagnostics.warn(node->source, node->type().name + " is not a texture that can be drawn");
  }
  return nodes_[node] = id;
}

RTid Textures::ofUrls(const MFString& urls, const Node& node, bool repeatS, bool repeatT) {
  const std::string& base = node.source.file ? *node.source.file : world_.path;
  std::string error;
  for (const std::string& url : urls) {
    const ResolvedUrl resolved = resolveUrl(url, base, world_.options);
    std::string why = resolved.error;
    if (why.empty())
      if (const RTid id = ofFile(resolved.path, repeatS, repeatT, why)) return id;
    if (error.empty()) error = why.find(url) == std::string::npos ? url + ": " + why : why;
  }
  if (urls.empty()) return 0;
  ++missing_;
  world_.diagnostics.warn(node.source, node.type().name + ": no picture: " + error);
  return 0;
}

RTid Textures::ofFile(const std::string& path, bool repeatS, bool repeatT, std::string& error) {
  const auto [it, fresh] = files_.try_emplace({path, repeatS, repeatT}, 0, std::string());
  auto& [id, why] = it->second;
  if (fresh) {
    try {
      id = make(readImage(path, world_.options.limits), repeatS, repeatT);
      if (id == 0 && rtGetError() != RT_NO_ERROR) why = rtGetErrorMessage();
    } catch (const std::exception& failure) { why = failure.what(); }
  }
  error = why;
  return id;
}

RTid Textures::make(const Image& image, bool repeatS, bool repeatT) {
  if (image.width <= 0 || image.height <= 0 || image.components < 1 || image.components > 4) return 0;
  if (image.pixels.size() < size_t(image.width) * size_t(image.height) * size_t(image.components)) return 0;
  RTid id = 0;
  rtGenTextures(1, &id);
  if (id == 0) return 0;
  rtBindTexture(id);
  rtTexImage2D(image.components, image.width, image.height, RT_UNSIGNED_BYTE, image.pixels.data());
  rtTexParameteri(RT_TEXTURE_WRAP_S, repeatS ? RT_REPEAT : RT_CLAMP_TO_EDGE);
  rtTexParameteri(RT_TEXTURE_WRAP_T, repeatT ? RT_REPEAT : RT_CLAMP_TO_EDGE);
  rtTexParameteri(RT_TEXTURE_SRGB, srgb_ ? 1 : 0);
  ++count_;
  return id;
}

} // namespace xvrml::mapping
