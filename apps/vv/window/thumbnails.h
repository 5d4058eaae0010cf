// thumbnails.h: Keeps small pictures as textures that widgets draw. Owned by the editor's panels.
// [main thread]
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "edit/look_library.h"
#include "edit/texture_thumbnails.h"

struct SDL_Renderer;
struct SDL_Texture;

namespace vv {

class Thumbnails {
 public:
  Thumbnails() = default;
  ~Thumbnails(); // the renderer must still be there
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  // Returns the texture of a ball; null for null, or if there is none.
  SDL_Texture* textureOf(SDL_Renderer* renderer, const LookBall* ball);
  // The same for the thumbnail of a texture node.
  SDL_Texture* textureOf(SDL_Renderer* renderer, const Thumbnail* thumbnail);
  // Forgets those of texture nodes once there are many. [before the widgets of a frame]
  void bound();

 private:
  using Textures = std::map<uint64_t, SDL_Texture*>; // by the numbers of the pictures
  static void clear(Textures& textures);

  Textures balls_, thumbnails_;
};

} // namespace vv
