// textures.h: the textures that glBindTexture names, each with its picture as a texture of OpenRT.
#pragma once

#include <map>
#include <vector>

#include "gl/attributes.h"

namespace rtgl {

inline constexpr int maxTextureSize = 16384; // texels a side

struct Picture {
  int width = 0, height = 0, components = 0; // components: 1 to 4, 8 bits each
  std::vector<unsigned char> texels;         // rows from the bottom up, tightly packed
};

struct TextureProperties {
  GLenum wrapS = GL_REPEAT, wrapT = GL_REPEAT, magFilter = GL_LINEAR,
         minFilter = GL_NEAREST_MIPMAP_LINEAR;
  bool operator==(const TextureProperties&) const = default;
};

struct Texture : TextureProperties {
  RTid id = 0; // 0 as long as there is no picture
  Picture picture;
  TextureProperties given; // what OpenRT has been told
};

class Textures {
 public:
  // Makes n textures and writes their names.
  void make(GLsizei n, GLuint* names);
  // Returns a texture; makes it if there is none of the name.
  Texture& at(GLuint name) { return textures_[name]; }
  bool has(GLuint name) const { return name != 0 && textures_.count(name) != 0; }
  // Returns the texture of OpenRT, or 0 if the name has no picture.
  RTid imageOf(GLuint name) const;
  void remove(GLuint name);
  // Gives the picture to OpenRT.
  void load(Texture& texture);
  // Gives OpenRT the properties that a texture has when something is drawn with it. They may change
  // before the frame ends.
  void use(GLuint name);
  // Tells whether colours are decoded from sRGB.
  void decode(bool srgb);

 private:
  void setProperties(Texture& texture) const;
  std::map<GLuint, Texture> textures_;
  bool srgb_ = false;
};

} // namespace rtgl
