#include "window/gui.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <SDL.h>
#include <fmt/format.h>
#include <imgui.h>

#include "window/panel.h"
#include "window/window.h"

namespace vv {

namespace {

// Frames after an event until the panels have come to rest: a click opens a popup in the next
// frame, whose size is known in the one after.
constexpr int framesToSettle = 3;

struct KeyPair {
  ImGuiKey key;
  SDL_Scancode code;
};
constexpr KeyPair keys[] = {
    {ImGuiKey_Tab, SDL_SCANCODE_TAB},
    {ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT},
    {ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT},
    {ImGuiKey_UpArrow, SDL_SCANCODE_UP},
    {ImGuiKey_DownArrow, SDL_SCANCODE_DOWN},
    {ImGuiKey_PageUp, SDL_SCANCODE_PAGEUP},
    {ImGuiKey_PageDown, SDL_SCANCODE_PAGEDOWN},
    {ImGuiKey_Home, SDL_SCANCODE_HOME},
    {ImGuiKey_End, SDL_SCANCODE_END},
    {ImGuiKey_Insert, SDL_SCANCODE_INSERT},
    {ImGuiKey_Delete, SDL_SCANCODE_DELETE},
    {ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE},
    {ImGuiKey_Space, SDL_SCANCODE_SPACE},
    {ImGuiKey_Enter, SDL_SCANCODE_RETURN},
    {ImGuiKey_Escape, SDL_SCANCODE_ESCAPE},
    {ImGuiKey_KeyPadEnter, SDL_SCANCODE_KP_ENTER},
    {ImGuiKey_A, SDL_SCANCODE_A},
    {ImGuiKey_C, SDL_SCANCODE_C},
    {ImGuiKey_V, SDL_SCANCODE_V},
    {ImGuiKey_X, SDL_SCANCODE_X},
    {ImGuiKey_Y, SDL_SCANCODE_Y},
    {ImGuiKey_Z, SDL_SCANCODE_Z},
};

// Returns the content of a font that Dear ImGui can read; empty if there is none.
std::string readFont() {
  std::ifstream file(findFontFile("sans"), std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  constexpr std::string_view kinds[] = {std::string_view("\0\1\0\0", 4), "true", "OTTO", "ttcf"};
  const bool known = std::any_of(std::begin(kinds), std::end(kinds),
                                 [&](std::string_view kind) { return bytes.starts_with(kind); });
  return known ? bytes : std::string();
}

// Returns the mouse button of Dear ImGui; -1: it has none.
int buttonOf(uint8_t button) {
  return button == SDL_BUTTON_LEFT     ? 0
         : button == SDL_BUTTON_RIGHT  ? 1
         : button == SDL_BUTTON_MIDDLE ? 2
                                       : -1;
}

const char* readClipboard(void* kept) {
  auto& text = *static_cast<std::string*>(kept);
  char* const copied = SDL_GetClipboardText();
  text = copied ? copied : "";
  SDL_free(copied);
  return text.c_str();
}

} // namespace

struct Gui::Impl {
  SDL_Window* const window;
  SDL_Renderer* const renderer;
  const std::function<void()> panels;
  ImGuiContext* const context = ImGui::CreateContext();
  SDL_Texture* font = nullptr;
  std::string clipboard;
  std::set<int> down; // buttons and keys that the widgets have seen go down
  uint64_t drawn = SDL_GetTicks64();
  int unsettled = framesToSettle;
  bool isKeyLeft = false; // the last event was a key that the widgets have left to others

  Impl(SDL_Window* window, SDL_Renderer* renderer, double scale, std::function<void()> panels)
      : window(window), renderer(renderer), panels(std::move(panels)) {
    ImGui::SetCurrentContext(context);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigInputTextCursorBlink = false; // nothing is drawn anew while nothing happens
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.BackendRendererUserData = renderer; // for those who make textures
    // Without it, the edges of panels cannot be dragged. The pointer's shape stays; edges light up.
    io.BackendFlags |= ImGuiBackendFlags_HasMouseCursors;
    std::fill(std::begin(io.KeyMap), std::end(io.KeyMap), -1);
    for (const KeyPair& pair : keys) io.KeyMap[pair.key] = pair.code;
    io.GetClipboardTextFn = readClipboard;
    io.SetClipboardTextFn = [](void*, const char* text) { SDL_SetClipboardText(text); };
    io.ClipboardUserData = &clipboard;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 0;
    loadFont(scale);
  }

  ~Impl() {
    if (font) SDL_DestroyTexture(font);
    ImGui::DestroyContext(context);
  }

  void loadFont(double scale) {
    ImGuiIO& io = ImGui::GetIO();
    const float size = float(15 * scale);
    if (const std::string bytes = readFont(); !bytes.empty()) {
      static constexpr ImWchar ranges[] = {0x20,   0x24f,  // Latin
                                           0x370,  0x52f,  // Greek and Cyrillic
                                           0x2010, 0x2044, // punctuation
                                           0x2190, 0x21ff, // arrows
                                           0xfffd, 0xfffd, 0};
      void* const owned = IM_ALLOC(bytes.size());
      std::memcpy(owned, bytes.data(), bytes.size());
      io.Fonts->AddFontFromMemoryTTF(owned, int(bytes.size()), size, nullptr, ranges);
      io.FontGlobalScale = float(1 / scale);
    }
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    font = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ABGR8888, SDL_TEXTUREACCESS_STATIC, width,
                             height);
    if (!font) return;
    SDL_UpdateTexture(font, nullptr, pixels, 4 * width);
    SDL_SetTextureBlendMode(font, SDL_BLENDMODE_BLEND);
    SDL_SetTextureScaleMode(font, SDL_ScaleModeLinear);
    io.Fonts->SetTexID(font);
  }

  // Runs the widgets once, with the input so far.
  void frame() {
    ImGui::SetCurrentContext(context);
    ImGuiIO& io = ImGui::GetIO();
    int width = 1, height = 1, pixels = 1, rows = 1;
    SDL_GetWindowSize(window, &width, &height);
    SDL_GetRendererOutputSize(renderer, &pixels, &rows);
    io.DisplaySize = ImVec2(float(width), float(height));
    io.DisplayFramebufferScale =
        ImVec2(float(pixels) / float(std::max(1, width)), float(rows) / float(std::max(1, height)));
    const uint64_t now = SDL_GetTicks64();
    io.DeltaTime = std::max(1e-4f, float(now - std::exchange(drawn, now)) / 1000);
    // Menus and questions have keys of their own.
    const ImGuiConfigFlags flags = io.ConfigFlags;
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
      io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    ImGui::NewFrame();
    panels();
    ImGui::EndFrame();
    io.ConfigFlags = flags;
  }

  // Tells which button or key an event is about, as a number, and whether it goes down or up.
  struct Held {
    int number = 0;
    bool isDown = false, isUp = false;
  };
  static Held held(const SDL_Event& event) {
    if (event.type == SDL_MOUSEBUTTONDOWN || event.type == SDL_MOUSEBUTTONUP)
      return {-int(event.button.button), event.type == SDL_MOUSEBUTTONDOWN,
              event.type == SDL_MOUSEBUTTONUP};
    if (event.type == SDL_KEYDOWN || event.type == SDL_KEYUP)
      return {int(event.key.keysym.scancode), event.type == SDL_KEYDOWN, event.type == SDL_KEYUP};
    return {};
  }

  // Ctrl+S ends what is typed, which counts then, and is left to the window.
  bool endsTyping(const SDL_Event& event) {
    if (event.type != SDL_KEYDOWN || event.key.keysym.sym != SDLK_s ||
        !(event.key.keysym.mod & KMOD_CTRL) || !ImGui::GetIO().WantTextInput)
      return false;
    ImGui::SetWindowFocus(nullptr);
    frame();
    frame();
    return true;
  }

  // Keys work a panel (EditorPanels::passKeyboard) until the mouse is pressed, or Escape ends
  // nothing else there.
  static bool isWorkedByKeys() {
    return (ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0;
  }
  static bool endsWorkByKeys(const SDL_Event& event) {
    const bool isEscape = event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE &&
                          !ImGui::IsAnyItemActive() &&
                          !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    if (!isWorkedByKeys() || (!isEscape && event.type != SDL_MOUSEBUTTONDOWN)) return false;
    ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    if (isEscape) ImGui::SetWindowFocus(nullptr);
    return isEscape;
  }

  // Tells whether a key is the window's whatever the panels do: the one that passes the keyboard
  // on, and where nothing is typed, commands with Ctrl and function keys.
  static bool isCommand(const SDL_Event& event) {
    if (event.type != SDL_KEYDOWN) return false;
    const SDL_Keycode key = event.key.keysym.sym;
    const bool hasControl = (event.key.keysym.mod & KMOD_CTRL) != 0;
    if (key == SDLK_TAB) return hasControl;
    const bool isModifier = key == SDLK_LCTRL || key == SDLK_RCTRL || key == SDLK_LSHIFT ||
                            key == SDLK_RSHIFT || key == SDLK_LALT || key == SDLK_RALT;
    return isWorkedByKeys() && !ImGui::GetIO().WantTextInput &&
           ((hasControl && !isModifier) || (key >= SDLK_F1 && key <= SDLK_F12));
  }

  static bool wants(const SDL_Event& event) {
    const ImGuiIO& io = ImGui::GetIO();
    switch (event.type) {
    case SDL_MOUSEMOTION:
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
    case SDL_MOUSEWHEEL: return io.WantCaptureMouse;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
    case SDL_TEXTINPUT: // for a text, a drag, a question or a menu
      return io.WantCaptureKeyboard || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    default: return false;
    }
  }

  // Returns whether the event says something to the widgets.
  static bool feed(const SDL_Event& event) {
    ImGuiIO& io = ImGui::GetIO();
    switch (event.type) {
    case SDL_MOUSEMOTION: io.MousePos = ImVec2(float(event.motion.x), float(event.motion.y)); break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      if (buttonOf(event.button.button) < 0) return false;
      io.MousePos = ImVec2(float(event.button.x), float(event.button.y));
      io.MouseDown[buttonOf(event.button.button)] = event.type == SDL_MOUSEBUTTONDOWN;
      break;
    case SDL_MOUSEWHEEL:
      io.MouseWheel += event.wheel.preciseY;
      io.MouseWheelH += event.wheel.preciseX;
      break;
    case SDL_KEYDOWN:
    case SDL_KEYUP: {
      const auto code = size_t(event.key.keysym.scancode);
      if (code < std::size(io.KeysDown)) io.KeysDown[code] = event.type == SDL_KEYDOWN;
      const int modifiers = event.key.keysym.mod;
      io.KeyCtrl = (modifiers & KMOD_CTRL) != 0;
      io.KeyShift = (modifiers & KMOD_SHIFT) != 0;
      io.KeyAlt = (modifiers & KMOD_ALT) != 0;
      break;
    }
    case SDL_TEXTINPUT: io.AddInputCharactersUTF8(event.text.text); break;
    case SDL_WINDOWEVENT:
      if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) io.AddFocusEvent(false);
      if (event.window.event == SDL_WINDOWEVENT_LEAVE) io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
      break;
    default: return false;
    }
    return true;
  }

  void drawList(const ImDrawList& list, ImVec2 scale) const {
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback || command.ElemCount == 0) continue;
      const ImVec4& clip = command.ClipRect;
      const SDL_Rect area{int(clip.x * scale.x), int(clip.y * scale.y),
                          int((clip.z - clip.x) * scale.x), int((clip.w - clip.y) * scale.y)};
      if (area.w <= 0 || area.h <= 0) continue;
      SDL_RenderSetClipRect(renderer, &area);
      std::vector<ImDrawVert> scaled; // the vertices in pixels
      const ImDrawVert* first = list.VtxBuffer.Data + command.VtxOffset;
      const int count = list.VtxBuffer.Size - int(command.VtxOffset);
      if (scale.x != 1 || scale.y != 1) {
        scaled.assign(first, first + count);
        for (ImDrawVert& one : scaled) one.pos = ImVec2(one.pos.x * scale.x, one.pos.y * scale.y);
        first = scaled.data();
      }
      SDL_RenderGeometryRaw(renderer, static_cast<SDL_Texture*>(command.GetTexID()), &first->pos.x,
                            sizeof(ImDrawVert), reinterpret_cast<const SDL_Color*>(&first->col),
                            sizeof(ImDrawVert), &first->uv.x, sizeof(ImDrawVert), count,
                            list.IdxBuffer.Data + command.IdxOffset, int(command.ElemCount),
                            sizeof(ImDrawIdx));
    }
  }
};

std::string editorLibrary() { return fmt::format("Dear ImGui {}", ImGui::GetVersion()); }

Gui::Gui(SDL_Window* window, SDL_Renderer* renderer, double scale, std::function<void()> panels)
    : impl_(std::make_unique<Impl>(window, renderer, scale, std::move(panels))) {}
Gui::~Gui() = default;

bool Gui::take(const SDL_Event& event) {
  ImGui::SetCurrentContext(impl_->context);
  const bool isKeyLeft = std::exchange(impl_->isKeyLeft, false);
  if (event.type == SDL_TEXTINPUT && isKeyLeft) return false; // what that key types
  if (Impl::endsWorkByKeys(event)) {
    impl_->unsettled = framesToSettle;
    return true;
  }
  if (Impl::isCommand(event)) {
    impl_->isKeyLeft = true;
    return false;
  }
  // A move belongs to what is below its end, also if it comes from a panel at one jump.
  const bool before = event.type != SDL_MOUSEMOTION && Impl::wants(event);
  if (!Impl::feed(event)) return false;
  impl_->unsettled = framesToSettle;
  if (impl_->endsTyping(event)) return false;
  impl_->frame();
  const bool taken = before || Impl::wants(event);
  impl_->isKeyLeft = event.type == SDL_KEYDOWN && !taken;
  // A button or key belongs to those who saw it go down.
  const auto [number, isDown, isUp] = Impl::held(event);
  if (isDown && taken) impl_->down.insert(number);
  return isUp ? impl_->down.erase(number) > 0 : taken;
}

void Gui::draw() {
  impl_->frame();
  ImGui::Render();
  const ImDrawData* const data = ImGui::GetDrawData();
  for (int i = 0; i < data->CmdListsCount; ++i)
    impl_->drawList(*data->CmdLists[i], data->FramebufferScale);
  SDL_RenderSetClipRect(impl_->renderer, nullptr);
  if (impl_->unsettled > 0) --impl_->unsettled;
}

void Gui::touch() { impl_->unsettled = framesToSettle; }

bool Gui::hasChanged() const { return impl_->unsettled > 0; }

} // namespace vv
