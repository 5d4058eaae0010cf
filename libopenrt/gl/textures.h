// textures.h: the textures that glBindTexture names, each with its picture as a texture of OpenRT.
#pragma once

#include <map>
#include <vector>

#include "gl/attributes.h"

namespace rtgl {

struct Picture {
  int width = 0, height = 0, components = 0; // components: 1 to 4, 8 bits each
  std::vector<unsigned char> texels;         // rows from the bottom up, tightly packed
};

struct Texture {
  RTid id = 0; // 0 as long as there is no picture
  Picture picture;
  GLenum wrapS = GL_REPEAT, wrapT = GL_REPEAT, magFilter = GL_LINEAR,
         minFilter = GL_NEAREST_MIPMAP_LINEAR;
  Color border = {0, 0, 0, 0};
};

class Textures {
 public:
  GLuint newName();
  // Returns a texture; makes it if there is none of the name.
  Texture& at(GLuint name) { return textures_[name]; }
  bool has(GLuint name) const { return name != 0 && textures_.count(name) != 0; }
  // Returns the texture of OpenRT, or 0 if the name has no picture.
  RTid imageOf(GLuint name) const;
  void remove(GLuint name);
  // Give picture and properties to OpenRT.
  void load(Texture& texture);
  void setProperties(const Texture& texture) const;
  // Tells whether colours are decoded from sRGB.
  void decode(bool srgb);

 private:
  std::map<GLuint, Texture> textures_;
  bool srgb_ = false;
};

} // namespace rtgl
