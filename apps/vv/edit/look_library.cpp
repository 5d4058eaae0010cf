#include "edit/look_library.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <system_error>
#include <utility>

#include "edit/material_files.h"
#include "libpicture/material_ball.h"
#include "xvrml/nodes.h"

namespace vv {

using namespace xvrml;
namespace fs = std::filesystem;

namespace {

std::string keyOf(const Look& look) {
  return look.file.empty() ? look.library + "\n" + look.name : look.file;
}

// Returns an Appearance with an installed look, in a world of its own.
UserMaterial installedMaterial(const Look& look) {
  const std::string node = look.isShader()
                               ? "ORTAppearance { shader DEF LOOK ORTShader { } }"
                               : "Appearance { material DEF LOOK " + look.name + " { } }";
  UserMaterial material;
  material.world = loadWorldFromMemory(
      "#VRML V2.0 utf8\nDEF BALL Shape { appearance " + node + " }\n", "look.wrl");
  const auto& names = material.world->scope.names;
  material.appearance = nodeCast<nodes::Shape>(names.at("BALL"))->appearance;
  if (auto* const shader = nodeCast<nodes::ORTShader>(names.at("LOOK"))) {
    shader->name = look.name;
    shader->file = look.library;
  }
  return material;
}

} // namespace

void LookLibrary::refresh() {
  own_ = looksIn(materialFolder());
  std::map<std::string, fs::file_time_type> changed;
  for (const Look& look : own_) {
    std::error_code none;
    const fs::file_time_type time = fs::last_write_time(look.file, none);
    changed.emplace(look.file, time);
    const auto known = changed_.find(look.file);
    if (known == changed_.end() || known->second == time) continue;
    balls_.erase(look.file);
    if (begun_ == look.file) interrupted_ = true;
  }
  changed_ = std::move(changed);
}

const LookBall* LookLibrary::ballOf(const Look& look) const {
  const auto found = balls_.find(keyOf(look));
  return found == balls_.end() || found->second.rgb.empty() ? nullptr : &found->second;
}

bool LookLibrary::advance(const std::vector<Look>& installed, const std::string& shaderPath,
                          bool mayRender) {
  using namespace std::chrono_literals;
  bool isNew = false;
  if (rendering_.valid()) {
    if (!mayRender) interrupted_ = true;
    if (rendering_.wait_for(0s) == std::future_status::timeout) return false;
    if (Pixels pixels = rendering_.get()) {
      balls_[begun_] = {++count_, std::move(*pixels)};
      isNew = true;
    }
  }
  if (const Look* const look = mayRender ? next(installed) : nullptr) begin(*look, shaderPath);
  return isNew;
}

// Returns the first look without a ball; null: all have one.
const Look* LookLibrary::next(const std::vector<Look>& installed) const {
  for (const std::vector<Look>* looks : {&own_, &installed})
    for (const Look& look : *looks)
      if (!balls_.contains(keyOf(look))) return &look;
  return nullptr;
}

void LookLibrary::begin(const Look& look, const std::string& shaderPath) {
  begun_ = keyOf(look);
  interrupted_ = false;
  const auto render = [this, look, shaderPath]() -> Pixels {
    try {
      const UserMaterial material =
          look.file.empty() ? installedMaterial(look) : readMaterial(look.file);
      std::vector<uint8_t> rgb =
          picture::drawMaterialBall(material.appearance, LookBall::side, shaderPath,
                                    [this](float) { return interrupted_.load(); });
      if (rgb.empty()) return std::nullopt;
      return rgb;
    } catch (const std::exception&) {
      if (interrupted_) return std::nullopt;
      return std::vector<uint8_t>(); // it has no ball
    }
  };
  try {
    rendering_ = std::async(std::launch::async, render);
  } catch (const std::system_error&) { balls_[begun_] = {}; } // there is no thread for it
}

} // namespace vv
