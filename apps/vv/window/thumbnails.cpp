#include "window/thumbnails.h"

#include <vector>

#include <SDL.h>

namespace vv {

Thumbnails::~Thumbnails() {
  for (const auto& [number, texture] : textures_)
    if (texture) SDL_DestroyTexture(texture);
}

SDL_Texture* Thumbnails::textureOf(SDL_Renderer* renderer, const LookBall* ball) {
  if (!ball) return nullptr;
  const auto [place, isNew] = textures_.try_emplace(ball->number, nullptr);
  if (!isNew) return place->second;
  constexpr int side = LookBall::side;
  std::vector<uint8_t> rgba; // SDL's own renderer can draw this format without a copy
  for (size_t i = 0; i < ball->rgb.size(); ++i) {
    rgba.push_back(ball->rgb[i]);
    if (i % 3 == 2) rgba.push_back(255);
  }
  SDL_Texture* const texture =
      SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ABGR8888, SDL_TEXTUREACCESS_STATIC, side, side);
  if (!texture) return nullptr;
  SDL_UpdateTexture(texture, nullptr, rgba.data(), 4 * side);
  SDL_SetTextureScaleMode(texture, SDL_ScaleModeLinear);
  return place->second = texture;
}

} // namespace vv
