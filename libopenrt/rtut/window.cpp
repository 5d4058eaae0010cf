// window.cpp: Implements the window by SDL 2, with pictures copied to its surface.
#include "rtut/window.h"

#include <SDL.h>

#include <map>
#include <stdexcept>

#include "openrt/rtut.h"

namespace rtut {
namespace {

// Returns RTUT_KEY_*, or 0.
int specialKey(SDL_Keycode key) {
  if (key >= SDLK_F1 && key <= SDLK_F12) return RTUT_KEY_F1 + (key - SDLK_F1);
  switch (key) {
  case SDLK_LEFT: return RTUT_KEY_LEFT;
  case SDLK_UP: return RTUT_KEY_UP;
  case SDLK_RIGHT: return RTUT_KEY_RIGHT;
  case SDLK_DOWN: return RTUT_KEY_DOWN;
  case SDLK_PAGEUP: return RTUT_KEY_PAGE_UP;
  case SDLK_PAGEDOWN: return RTUT_KEY_PAGE_DOWN;
  case SDLK_HOME: return RTUT_KEY_HOME;
  case SDLK_END: return RTUT_KEY_END;
  case SDLK_INSERT: return RTUT_KEY_INSERT;
  default: return 0;
  }
}

// Returns whether a key comes as a text event, too.
bool isPrintable(SDL_Keycode key) { return key >= ' ' && key < 127; }

Event pointerEvent(Event::Kind kind, int code, int state, int x, int y) {
  return {kind, code, state, x, y};
}

// Returns the event of a key that comes as no text; Event::none for others.
Event keyEvent(const SDL_KeyboardEvent& event) {
  Event out;
  SDL_GetMouseState(&out.x, &out.y);
  out.state = event.type == SDL_KEYDOWN ? RTUT_DOWN : RTUT_UP;
  const SDL_Keycode key = event.keysym.sym;
  out.code = specialKey(key);
  if (out.code) {
    out.kind = Event::special;
  } else if ((event.keysym.mod & KMOD_CTRL) && key >= 'a' && key <= 'z') {
    out.kind = Event::key;
    out.code = key - 'a' + 1;
  } else if (key > 0 && key < 128 && !isPrintable(key)) { // Escape, Return and the like
    out.kind = Event::key;
    out.code = key;
  }
  return out;
}

} // namespace

struct Window::Parts {
  SDL_Window* window = nullptr;
  bool ignoresRepeats = false;
  bool repeats = false; // the last key that went down is held
  SDL_Scancode last = SDL_SCANCODE_UNKNOWN;
  std::map<SDL_Scancode, int> typed; // the characters of keys that are down
};

Window::Window(const std::string& title, int x, int y, int width, int height)
    : parts_(std::make_unique<Parts>()) {
  // SDL would try all its drivers, of which some show nothing.
  if (!SDL_getenv("DISPLAY") && !SDL_getenv("WAYLAND_DISPLAY") && !SDL_getenv("SDL_VIDEODRIVER"))
    throw std::runtime_error("there is no display");
  if (SDL_Init(SDL_INIT_VIDEO) != 0) throw std::runtime_error(SDL_GetError());
  const auto place = [](int at) { return at < 0 ? int(SDL_WINDOWPOS_UNDEFINED) : at; };
  parts_->window =
      SDL_CreateWindow(title.c_str(), place(x), place(y), width, height, SDL_WINDOW_RESIZABLE);
  if (!parts_->window) {
    const std::string reason = SDL_GetError();
    SDL_Quit();
    throw std::runtime_error(reason);
  }
}

Window::~Window() {
  SDL_DestroyWindow(parts_->window);
  SDL_Quit();
}

void Window::size(int& width, int& height) const {
  SDL_GetWindowSize(parts_->window, &width, &height);
}
void Window::resize(int width, int height) { SDL_SetWindowSize(parts_->window, width, height); }
void Window::fullScreen() {
  SDL_SetWindowFullscreen(parts_->window, SDL_WINDOW_FULLSCREEN_DESKTOP);
}
void Window::setTitle(const std::string& title) {
  SDL_SetWindowTitle(parts_->window, title.c_str());
}

void Window::show(const unsigned char* rgb, int width, int height) {
  SDL_Surface* to = SDL_GetWindowSurface(parts_->window);
  SDL_Surface* from = SDL_CreateRGBSurfaceWithFormatFrom(
      const_cast<unsigned char*>(rgb), width, height, 24, 3 * width, SDL_PIXELFORMAT_RGB24);
  if (to && from) {
    SDL_BlitSurface(from, nullptr, to, nullptr);
    SDL_UpdateWindowSurface(parts_->window);
  }
  SDL_FreeSurface(from);
}

void Window::ignoreRepeats(bool ignore) { parts_->ignoresRepeats = ignore; }

Event Window::keyDown(const SDL_KeyboardEvent& event) {
  parts_->last = event.keysym.scancode;
  parts_->repeats = event.repeat != 0;
  if (parts_->repeats && parts_->ignoresRepeats) return {};
  return keyEvent(event);
}

// Returns the event of the key's character, as it was when the key went down.
Event Window::keyUp(const SDL_KeyboardEvent& event) {
  Event out = keyEvent(event);
  const auto found = parts_->typed.find(event.keysym.scancode);
  if (found == parts_->typed.end()) return out;
  out.kind = Event::key;
  out.code = found->second;
  parts_->typed.erase(found);
  return out;
}

Event Window::text(const SDL_TextInputEvent& event) {
  if (parts_->repeats && parts_->ignoresRepeats) return {};
  Event out = {Event::key, static_cast<unsigned char>(event.text[0]), RTUT_DOWN, 0, 0};
  parts_->typed[parts_->last] = out.code;
  SDL_GetMouseState(&out.x, &out.y);
  return out;
}

Event Window::next(int milliseconds) {
  SDL_Event event;
  if (!SDL_WaitEventTimeout(&event, milliseconds)) return {};
  switch (event.type) {
  case SDL_QUIT: return {Event::close, 0, 0, 0, 0};
  case SDL_WINDOWEVENT:
    if (event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED)
      return {Event::resize, 0, 0, event.window.data1, event.window.data2};
    if (event.window.event == SDL_WINDOWEVENT_EXPOSED) return {Event::expose, 0, 0, 0, 0};
    return {};
  case SDL_KEYDOWN: return keyDown(event.key);
  case SDL_KEYUP: return keyUp(event.key);
  case SDL_TEXTINPUT: return text(event.text);
  case SDL_MOUSEWHEEL: {
    if (event.wheel.y == 0) return {};
    Event out = {Event::wheel, event.wheel.y > 0 ? 3 : 4, 0, 0, 0};
    SDL_GetMouseState(&out.x, &out.y);
    return out;
  }
  case SDL_MOUSEBUTTONDOWN:
  case SDL_MOUSEBUTTONUP:
    return pointerEvent(Event::button, event.button.button - 1,
                        event.type == SDL_MOUSEBUTTONDOWN ? RTUT_DOWN : RTUT_UP, event.button.x,
                        event.button.y);
  case SDL_MOUSEMOTION:
    return pointerEvent(Event::motion, 0, event.motion.state != 0, event.motion.x, event.motion.y);
  default: return {};
  }
}

int Window::modifiers() const {
  const SDL_Keymod held = SDL_GetModState();
  return (held & KMOD_SHIFT ? RTUT_ACTIVE_SHIFT : 0) | (held & KMOD_CTRL ? RTUT_ACTIVE_CTRL : 0) |
         (held & KMOD_ALT ? RTUT_ACTIVE_ALT : 0);
}

} // namespace rtut
