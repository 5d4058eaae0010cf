// screen.cpp: Implements Screen with SDL. Without OpenGL, as under Xvfb and on remote displays,
// SDL's own software renderer scales and draws.
#include "window/screen.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <SDL.h>
#include <fmt/format.h>

#include "options/values.h"
#include "printable.h"
#include "session/input/world_keys.h"
#include "window/gui.h"
#include "window/window.h"

namespace vv {

namespace {

[[noreturn]] void fail() {
  throw Failure{exitRender, fmt::format("no window: {}; -o picture.png makes a picture without one",
                                        SDL_GetError())};
}

// Tells whether a key has different positions on different keyboards; such keys are read as text.
bool isTextKey(const std::string& key) {
  return key == "[" || key == "]" || key == "?" || key == "\\";
}

void setModifiers(InputEvent& event, int modifiers) {
  event.shift = modifiers & KMOD_SHIFT;
  event.control = modifiers & KMOD_CTRL;
  event.alt = modifiers & KMOD_ALT;
}

// Tells whether OpenGL is emulated in software. Emulation takes CPU time from rendering, more than
// SDL's own renderer.
bool isEmulated(SDL_Renderer* renderer) {
  SDL_RendererInfo info;
  if (SDL_GetRendererInfo(renderer, &info) != 0 ||
      !std::string_view(info.name).starts_with("opengl"))
    return false;
  using GetString = const unsigned char* (*)(unsigned);
  const auto get = reinterpret_cast<GetString>(SDL_GL_GetProcAddress("glGetString"));
  const unsigned char* text = get ? get(0x1F01) : nullptr; // queries GL_RENDERER
  const std::string_view name = text ? reinterpret_cast<const char*>(text) : "";
  return name.find("llvmpipe") != name.npos || name.find("softpipe") != name.npos ||
         name.find("Software") != name.npos;
}

struct Texture {
  SDL_Texture* texture = nullptr;
  int width = 0, height = 0;
  void drop() {
    if (texture) SDL_DestroyTexture(texture);
    texture = nullptr;
  }
  bool fit(SDL_Renderer* renderer, uint32_t format, int w, int h) {
    if (texture && width == w && height == h) return true;
    drop();
    width = w;
    height = h;
    texture = SDL_CreateTexture(renderer, format, SDL_TEXTUREACCESS_STREAMING, w, h);
    return texture != nullptr;
  }
};

} // namespace

struct Screen::Impl {
  SDL_Window* window = nullptr;
  SDL_Renderer* renderer = nullptr;
  SDL_Cursor *arrow = nullptr, *hand = nullptr;
  Texture picture, cover;
  double coverPart = 1;
  FreePart free;
  std::array<Texture, places> panels;
  std::unique_ptr<Gui> gui;     // null: there are no widgets
  std::vector<uint32_t> pixels; // scratch storage for the picture
  bool changed = true, isHand = false, pressed = false;
  std::string typed; // what the last key types by its name
  int modifiers = 0; // keys that were held when the present event came; SDL knows those of now

  ~Impl() {
    gui.reset();
    picture.drop();
    cover.drop();
    for (Texture& panel : panels) panel.drop();
    if (arrow) SDL_FreeCursor(arrow);
    if (hand) SDL_FreeCursor(hand);
    if (renderer) SDL_DestroyRenderer(renderer);
    if (window) SDL_DestroyWindow(window);
    SDL_Quit();
  }

  InputEvent pointer(InputEvent::Kind kind, int x, int y) const {
    int w = 1, h = 1;
    SDL_GetWindowSize(window, &w, &h);
    InputEvent event;
    event.kind = kind;
    event.x = (2 * x + 1.0) / std::max(1, w) - 1;
    event.y = 1 - (2 * y + 1.0) / std::max(1, h);
    setModifiers(event, modifiers);
    return event;
  }

  void fill(Texture& texture, int width, int height, const std::vector<uint8_t>& rgb) {
    // SDL's own renderer can scale this format linearly.
    if (!texture.fit(renderer, SDL_PIXELFORMAT_XRGB8888, width, height)) return;
    pixels.resize(rgb.size() / 3);
    for (size_t i = 0; i < pixels.size(); ++i)
      pixels[i] =
          uint32_t(rgb[3 * i]) << 16 | uint32_t(rgb[3 * i + 1]) << 8 | uint32_t(rgb[3 * i + 2]);
    SDL_SetTextureScaleMode(texture.texture, SDL_ScaleModeLinear);
    SDL_SetTextureBlendMode(texture.texture, SDL_BLENDMODE_NONE);
    SDL_UpdateTexture(texture.texture, nullptr, pixels.data(), width * 4);
    changed = true;
  }

  void drawCover(int width, int height) const {
    if (!cover.texture) return;
    const SDL_Rect from{0, 0, int(coverPart * cover.width + .5), cover.height};
    const SDL_Rect to{0, 0, int(double(from.w) * width / cover.width + .5), height};
    if (from.w > 0) SDL_RenderCopy(renderer, cover.texture, &from, &to);
  }

  static void key(InputEvent::Kind kind, const std::string& name, int modifiers,
                  std::vector<InputEvent>& out) {
    InputEvent event;
    event.kind = kind;
    event.text = name;
    setModifiers(event, modifiers);
    out.push_back(std::move(event));
  }

  void windowEvent(const SDL_WindowEvent& e, std::vector<InputEvent>& out) {
    changed = true;
    if (e.event == SDL_WINDOWEVENT_LEAVE && !pressed)
      out.push_back(pointer(InputEvent::Kind::leave, 0, 0));
    if (e.event == SDL_WINDOWEVENT_FOCUS_LOST)
      out.push_back(pointer(InputEvent::Kind::leave, 0, 0));
  }

  void take(const SDL_Event& e, std::vector<InputEvent>& out) {
    using Kind = InputEvent::Kind;
    if (e.type == SDL_KEYDOWN || e.type == SDL_KEYUP) modifiers = e.key.keysym.mod;
    if (e.type == SDL_WINDOWEVENT && e.window.event == SDL_WINDOWEVENT_FOCUS_GAINED)
      modifiers = SDL_GetModState();
    if (gui && gui->take(e)) return;
    switch (e.type) {
    case SDL_QUIT: out.push_back(pointer(Kind::quit, 0, 0)); break;
    case SDL_WINDOWEVENT: windowEvent(e.window, out); break;
    case SDL_MOUSEMOTION: out.push_back(pointer(Kind::move, e.motion.x, e.motion.y)); break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP: {
      if (e.button.button < SDL_BUTTON_LEFT || e.button.button > SDL_BUTTON_RIGHT) break;
      pressed = e.type == SDL_MOUSEBUTTONDOWN;
      InputEvent event = pointer(pressed ? Kind::press : Kind::release, e.button.x, e.button.y);
      event.button = e.button.button == SDL_BUTTON_LEFT     ? Button::left
                     : e.button.button == SDL_BUTTON_MIDDLE ? Button::middle
                                                            : Button::right;
      out.push_back(event);
      break;
    }
    case SDL_MOUSEWHEEL: {
      int x = 0, y = 0;
      SDL_GetMouseState(&x, &y);
      InputEvent event = pointer(Kind::wheel, x, y);
      event.amount =
          double(e.wheel.preciseY) * (e.wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -1 : 1);
      out.push_back(event);
      break;
    }
    case SDL_KEYDOWN:
    case SDL_KEYUP: {
      const std::string name = SDL_GetKeyName(e.key.keysym.sym);
      if (!e.key.repeat && !name.empty() && !isTextKey(name)) // some keys have no name
        key(e.type == SDL_KEYDOWN ? Kind::down : Kind::up, name, e.key.keysym.mod, out);
      if (e.type == SDL_KEYUP) break;
      InputEvent pressed;
      pressed.text = name;
      setModifiers(pressed, e.key.keysym.mod);
      typed = typedBy(pressed);
      break;
    }
    case SDL_TEXTINPUT:
      if (!isTextKey(e.text.text)) {
        if (typed != e.text.text) key(Kind::type, e.text.text, 0, out);
        break;
      }
      key(Kind::down, e.text.text, 0, out);
      key(Kind::up, e.text.text, 0, out);
      break;
    case SDL_DROPFILE: {
      InputEvent event;
      event.kind = Kind::open;
      event.text = e.drop.file;
      SDL_free(e.drop.file);
      out.push_back(std::move(event));
      break;
    }
    case SDL_RENDER_TARGETS_RESET:
    case SDL_RENDER_DEVICE_RESET: changed = true; break;
    default: break;
    }
  }
};

Screen::Screen(const std::string& title, int width, int height) : impl_(std::make_unique<Impl>()) {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1"); // vv installs its own signal handlers
  SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
  SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
  SDL_SetMainReady();
  // SDL would try all its drivers
  if (!SDL_getenv("DISPLAY") && !SDL_getenv("WAYLAND_DISPLAY") && !SDL_getenv("SDL_VIDEODRIVER")) {
    SDL_SetError("there is no display");
    fail();
  }
  // Only drivers with a real display: SDL's others open windows that nobody can see.
  if (!SDL_getenv("SDL_VIDEODRIVER"))
    SDL_SetHint(SDL_HINT_VIDEODRIVER, !SDL_getenv("DISPLAY")          ? "wayland"
                                      : SDL_getenv("WAYLAND_DISPLAY") ? "x11,wayland"
                                                                      : "x11");
  if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) fail();
  impl_->window = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED,
                                   width, height, SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
  if (!impl_->window) fail();
  impl_->renderer = SDL_CreateRenderer(impl_->window, -1, SDL_RENDERER_ACCELERATED);
  if (impl_->renderer && isEmulated(impl_->renderer)) {
    SDL_DestroyRenderer(impl_->renderer);
    impl_->renderer = nullptr;
  }
  if (!impl_->renderer)
    impl_->renderer = SDL_CreateRenderer(impl_->window, -1, SDL_RENDERER_SOFTWARE);
  if (!impl_->renderer) fail();
  impl_->arrow = SDL_CreateSystemCursor(SDL_SYSTEM_CURSOR_ARROW);
  impl_->hand = SDL_CreateSystemCursor(SDL_SYSTEM_CURSOR_HAND);
  SDL_EventState(SDL_DROPFILE, SDL_ENABLE);
  SDL_StartTextInput();
  // The requested size is that of the picture.
  if (const double s = scale(); s > 1.01)
    SDL_SetWindowSize(impl_->window, int(width / s), int(height / s));
}

Screen::~Screen() = default;

namespace {
int milliseconds(double seconds) { return std::clamp(int(seconds * 1000), 0, 1000); }
} // namespace

void Screen::wait(double seconds, std::vector<InputEvent>& events,
                  const std::function<bool()>& isEnough) {
  SDL_Event event;
  if (SDL_WaitEventTimeout(&event, milliseconds(seconds)) == 0) return;
  do impl_->take(event, events);
  while (!isEnough() && SDL_PollEvent(&event));
}

void Screen::rest(double seconds) {
  SDL_PumpEvents(); // the system must not take the window for one that hangs
  SDL_Delay(uint32_t(milliseconds(seconds)));
}

int Screen::width() const {
  int w = 1, h = 1;
  SDL_GetRendererOutputSize(impl_->renderer, &w, &h);
  return std::max(1, w);
}

int Screen::height() const {
  int w = 1, h = 1;
  SDL_GetRendererOutputSize(impl_->renderer, &w, &h);
  return std::max(1, h);
}

double Screen::scale() const {
  int w = 1, h = 1;
  SDL_GetWindowSize(impl_->window, &w, &h);
  return double(width()) / std::max(1, w);
}

bool Screen::visible() const {
  return !(SDL_GetWindowFlags(impl_->window) & (SDL_WINDOW_MINIMIZED | SDL_WINDOW_HIDDEN));
}

void Screen::setPicture(int width, int height, const std::vector<uint8_t>& rgb) {
  impl_->fill(impl_->picture, width, height, rgb);
}

void Screen::setCover(int width, int height, const std::vector<uint8_t>& rgb) {
  if (width > 0) return impl_->fill(impl_->cover, width, height, rgb);
  impl_->cover.drop();
  impl_->changed = true;
}

void Screen::setCoverPart(double part) {
  if (std::exchange(impl_->coverPart, part) != part) impl_->changed = true;
}

void Screen::setPanel(Place place, const Panel& panel) {
  Texture& texture = impl_->panels[place];
  impl_->changed = true;
  if (panel.width == 0 ||
      !texture.fit(impl_->renderer, SDL_PIXELFORMAT_RGBA32, panel.width, panel.height))
    return texture.drop();
  SDL_SetTextureBlendMode(texture.texture, SDL_BLENDMODE_BLEND);
  SDL_UpdateTexture(texture.texture, nullptr, panel.rgba.data(), panel.width * 4);
}

void Screen::setGui(std::function<void()> panels) {
  impl_->gui =
      panels ? std::make_unique<Gui>(impl_->window, impl_->renderer, scale(), std::move(panels))
             : nullptr;
  impl_->changed = true;
}

void Screen::setFree(const FreePart& part) {
  if (std::exchange(impl_->free, part) != part) impl_->changed = true;
}

int Screen::freeWidth() const {
  const int least = width() / 8; // panels that meet leave nothing
  return std::max(least, int((impl_->free.right - impl_->free.left) / 2 * width()));
}

void Screen::redraw() {
  impl_->changed = true;
  if (impl_->gui) impl_->gui->touch();
}

void Screen::present() {
  const bool guiChanged = impl_->gui && impl_->gui->hasChanged();
  if (!std::exchange(impl_->changed, false) && !guiChanged) return;
  SDL_Renderer* const r = impl_->renderer;
  SDL_SetRenderDrawColor(r, 24, 24, 28, 255);
  SDL_RenderClear(r);
  if (impl_->picture.texture) SDL_RenderCopy(r, impl_->picture.texture, nullptr, nullptr);
  const int w = width(), h = height();
  impl_->drawCover(w, h);
  for (int place = 0; place < places; ++place) {
    if (place == bottom && impl_->gui) impl_->gui->draw(); // messages stand before the widgets
    const Texture& panel = impl_->panels[size_t(place)];
    if (!panel.texture) continue;
    SDL_Rect at{0, 0, panel.width, panel.height};
    if (place == right) at.x = int((1 + impl_->free.right) / 2 * w) - panel.width;
    if (place == top) at.x = int((1 + impl_->free.left) / 2 * w);
    if (place == bottom) at.y = h - panel.height;
    if (place == middle) {
      at.x = (w - panel.width) / 2;
      at.y = (h - panel.height) / 2;
    }
    SDL_RenderCopy(r, panel.texture, nullptr, &at);
  }
  SDL_RenderPresent(r);
}

void Screen::setHand(bool hand) {
  if (std::exchange(impl_->isHand, hand) == hand) return;
  if (SDL_Cursor* cursor = hand ? impl_->hand : impl_->arrow) SDL_SetCursor(cursor);
}

void Screen::setTitle(const std::string& title) {
  SDL_SetWindowTitle(impl_->window, printable(title).c_str());
}

void Screen::toggleFullScreen() {
  const bool full = SDL_GetWindowFlags(impl_->window) & SDL_WINDOW_FULLSCREEN_DESKTOP;
  SDL_SetWindowFullscreen(impl_->window, full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
}

std::string windowLibrary() {
  SDL_version version;
  SDL_GetVersion(&version);
  return fmt::format("SDL {}.{}.{}", version.major, version.minor, version.patch);
}

} // namespace vv
