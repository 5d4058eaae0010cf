// textures.cpp: Keeps textures and gives them to OpenRT, which interpolates them without mipmaps.
#include "gl/textures.h"

#include "gl/names.h"

namespace rtgl {
namespace {

int wrapOf(GLenum mode) { return mode == GL_REPEAT ? RT_REPEAT : RT_CLAMP_TO_EDGE; }

} // namespace

void Textures::make(GLsizei n, GLuint* names) {
  if (n < 0) fail(GL_INVALID_VALUE, "the number is below 0");
  if (n == 0) return;
  const auto count = static_cast<GLuint>(n);
  const GLuint first = unusedNames(textures_, count);
  for (GLuint i = 0; i < count; i++) {
    textures_[first + i];
    names[i] = first + i;
  }
}

RTid Textures::imageOf(GLuint name) const {
  const auto found = textures_.find(name);
  return found == textures_.end() ? 0 : found->second.id;
}

void Textures::remove(GLuint name) {
  const auto found = textures_.find(name);
  if (found == textures_.end()) return;
  if (found->second.id) rtDeleteTexture(found->second.id);
  textures_.erase(found);
}

void Textures::load(Texture& texture) {
  if (!texture.id) rtGenTextures(1, &texture.id);
  const Picture& p = texture.picture;
  rtBindTexture(texture.id);
  rtTexImage2D(p.components, p.width, p.height, RT_UNSIGNED_BYTE, p.texels.data());
  setProperties(texture);
}

void Textures::use(GLuint name) {
  const auto found = textures_.find(name);
  if (found == textures_.end()) return;
  const TextureProperties& wanted = found->second;
  if (found->second.given != wanted) setProperties(found->second);
}

void Textures::setProperties(Texture& texture) const {
  if (!texture.id) return;
  texture.given = texture;
  rtBindTexture(texture.id);
  rtTexParameteri(RT_TEXTURE_WRAP_S, wrapOf(texture.wrapS));
  rtTexParameteri(RT_TEXTURE_WRAP_T, wrapOf(texture.wrapT));
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, texture.magFilter == GL_NEAREST ? RT_NEAREST : RT_LINEAR);
  rtTexParameteri(RT_TEXTURE_SRGB, srgb_);
}

void Textures::decode(bool srgb) {
  if (srgb == srgb_) return;
  srgb_ = srgb;
  for (auto& [name, texture] : textures_) setProperties(texture);
}

} // namespace rtgl
