#include "window/sound/speaker.h"

#include <SDL.h>

namespace vv {

namespace {

void fill(void* user, Uint8* bytes, int count) {
  constexpr double rate = 48000;
  static_cast<Mixer*>(user)->fill({reinterpret_cast<float*>(bytes), size_t(count) / sizeof(float)},
                                  rate);
}

} // namespace

std::string Speaker::open() {
  tried_ = true;
  if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) return SDL_GetError();
  SDL_AudioSpec wanted{};
  wanted.freq = 48000;
  wanted.format = AUDIO_F32SYS;
  wanted.channels = 2;
  wanted.samples = 1024;
  wanted.callback = fill;
  wanted.userdata = &mixer_;
  // SDL converts to the device's format
  device_ = SDL_OpenAudioDevice(nullptr, 0, &wanted, nullptr, 0);
  if (device_ == 0) return SDL_GetError();
  SDL_PauseAudioDevice(device_, 0);
  return "";
}

Speaker::~Speaker() {
  if (device_ != 0) SDL_CloseAudioDevice(device_);
}

} // namespace vv
