#include "window/thumbnails.h"

#include <vector>

#include <SDL.h>

namespace vv {

namespace {

constexpr size_t mostThumbnails = 64;

// rgba: SDL's own renderer can draw this format without a copy.
SDL_Texture* makeTexture(SDL_Renderer* renderer, const std::vector<uint8_t>& rgba, int width,
                         int height) {
  SDL_Texture* const texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ABGR8888,
                                                 SDL_TEXTUREACCESS_STATIC, width, height);
  if (!texture) return nullptr;
  SDL_UpdateTexture(texture, nullptr, rgba.data(), 4 * width);
  SDL_SetTextureScaleMode(texture, SDL_ScaleModeLinear);
  return texture;
}

} // namespace

Thumbnails::~Thumbnails() {
  clear(balls_);
  clear(thumbnails_);
}

void Thumbnails::clear(Textures& textures) {
  for (const auto& [number, texture] : textures)
    if (texture) SDL_DestroyTexture(texture);
  textures.clear();
}

void Thumbnails::bound() {
  if (thumbnails_.size() > mostThumbnails) clear(thumbnails_);
}

SDL_Texture* Thumbnails::textureOf(SDL_Renderer* renderer, const LookBall* ball) {
  if (!ball) return nullptr;
  const auto [place, isNew] = balls_.try_emplace(ball->number, nullptr);
  if (!isNew) return place->second;
  std::vector<uint8_t> rgba;
  for (size_t i = 0; i < ball->rgb.size(); ++i) {
    rgba.push_back(ball->rgb[i]);
    if (i % 3 == 2) rgba.push_back(255);
  }
  return place->second = makeTexture(renderer, rgba, LookBall::side, LookBall::side);
}

SDL_Texture* Thumbnails::textureOf(SDL_Renderer* renderer, const Thumbnail* thumbnail) {
  if (!thumbnail || thumbnail->width == 0) return nullptr;
  const auto [place, isNew] = thumbnails_.try_emplace(thumbnail->number, nullptr);
  if (!isNew) return place->second;
  SDL_Texture* const texture =
      makeTexture(renderer, thumbnail->rgba, thumbnail->width, thumbnail->height);
  if (!texture) return nullptr;
  SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_BLEND);
  if (thumbnail->magnification() > 1) SDL_SetTextureScaleMode(texture, SDL_ScaleModeNearest);
  return place->second = texture;
}

} // namespace vv
