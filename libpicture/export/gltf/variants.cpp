#include "libpicture/export/gltf/variants.h"

#include <fmt/format.h>

namespace picture::gltf {

using xvrml::Node;
using xvrml::nodeCast;
namespace nodes = xvrml::nodes;

namespace {

std::string nameOf(const xvrml::AppearanceParts& parts, const nodes::Shape& shape) {
  for (const Node* node : {parts.appearance, parts.material})
    if (node && !node->defName.empty()) return node->defName;
  return shape.defName;
}

} // namespace

std::vector<Look> looksOf(const nodes::Switch& node) {
  std::vector<Look> looks;
  std::unordered_map<std::string, const Node*> appearances; // by name
  const Node* geometry = nullptr;
  for (const xvrml::NodeRef& choice : node.choice) {
    const auto* shape = nodeCast<nodes::Shape>(xvrml::renderedNode(choice.get()));
    const Node* own = shape ? xvrml::renderedNode(shape->geometry.get()) : nullptr;
    if (!own || (geometry && own != geometry)) return {};
    geometry = own;
    Look& look = looks.emplace_back();
    look.parts = xvrml::resolveAppearance(shape->appearance.get());
    look.name = nameOf(look.parts, *shape);
    const auto named = appearances.try_emplace(look.name, look.parts.appearance).first;
    const bool taken = named->second != look.parts.appearance;
    const std::string scope = node.defName.empty() ? "Switch" : node.defName;
    if (look.name.empty() || taken)
      look.name = fmt::format("{} {}", look.name.empty() ? scope : look.name, looks.size() - 1);
  }
  if (looks.size() < 2) looks.clear();
  return looks;
}

size_t Variants::of(const std::string& name) {
  const auto [found, fresh] = indices_.try_emplace(name, names_.size());
  if (fresh) names_.push_back(name);
  return found->second;
}

void Variants::write(Document& document) const {
  if (names_.empty()) return;
  Json list = Json::array();
  for (const std::string& name : names_) list.push_back({{"name", name}});
  document.addExtension("KHR_materials_variants", {{"variants", std::move(list)}});
}

} // namespace picture::gltf
