// thumbnails.h: Keeps small pictures as textures that widgets draw. Owned by the editor's panels.
// [main thread]
#pragma once

#include <cstdint>
#include <map>

#include "edit/look_library.h"

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

 private:
  std::map<uint64_t, SDL_Texture*> textures_; // by the numbers of the balls
};

} // namespace vv
