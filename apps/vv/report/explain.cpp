#include "explain.h"

#include <algorithm>

#include <fmt/format.h>

#include "describe.h"
#include "json_text.h"
#include "libpicture/transport.h"
#include "material_list.h"
#include "transport_words.h"
#include "xvrml/nodes.h"

namespace vv {

namespace {

// Counts what --compat changes, or would change.
struct Compat {
  uint64_t scripts = 0;  // Scripts that hold nodes without directOutput TRUE
  uint64_t textures = 0; // appearances with a texture and a diffuseColor that is not white
};

Compat compatOf(const xvrml::World& world) {
  Compat compat;
  forEachNode(world, [&](const xvrml::Node& node) {
    if (const auto* script = xvrml::nodeCast<xvrml::ScriptNode>(&node)) {
      const xvrml::FieldInfo* flag = node.type().find("directOutput");
      const bool allowed = flag && node.get(*flag) == xvrml::Value(true);
      const bool holds = std::any_of(script->type().fields.begin(), script->type().fields.end(),
                                     [&](const xvrml::FieldInfo& field) {
                                       if (field.access == xvrml::Access::eventIn)
                                         // events may send nodes to it
                                         return field.type == xvrml::FieldType::SFNode ||
                                                field.type == xvrml::FieldType::MFNode;
                                       if (field.access != xvrml::Access::field) return false;
                                       const xvrml::Value value = node.get(field);
                                       const auto* one = std::get_if<xvrml::NodeRef>(&value);
                                       const auto* many = std::get_if<xvrml::MFNode>(&value);
                                       return (one && *one) || (many && !many->empty());
                                     });
      compat.scripts += !allowed && holds;
    } else if (node.type().index == xvrml::nodes::Appearance::typeIndex) {
      const auto* appearance = static_cast<const xvrml::nodes::Appearance*>(&node);
      const auto* material =
          xvrml::nodeCast<xvrml::nodes::Material>(xvrml::renderedNode(appearance->material.get()));
      compat.textures +=
          appearance->texture && material && material->diffuseColor != xvrml::Color{1, 1, 1};
    }
  });
  return compat;
}

std::string compatText(const Options& options, const Compat& compat) {
  std::string text;
  if (compat.scripts > 0)
    text += fmt::format("compat scripts {}: {} without directOutput TRUE; {}\n",
                        options.run.directOutputAlways ? "on" : "off",
                        compat.scripts == 1 ? "1 Script holds nodes"
                                            : fmt::format("{} Scripts hold nodes", compat.scripts),
                        options.run.directOutputAlways
                            ? "their changes to these nodes are carried out, as in browsers of 1997"
                            : "their changes to these nodes are ignored (6.40); --compat scripts "
                              "carries them out, as browsers of 1997 did");
  if (compat.textures > 0)
    text += fmt::format(
        "compat textures {}: {} appearance{} with a texture and a diffuseColor that is not white; "
        "{}\n",
        options.render.multiplyTextures ? "on" : "off", compat.textures,
        compat.textures == 1 ? "" : "s",
        options.render.multiplyTextures ? "a colour texture multiplies diffuseColor, as in X3D"
                                        : "a colour texture replaces diffuseColor (4.14.3); "
                                          "--compat textures multiplies them, as X3D does");
  return text;
}

} // namespace

namespace {

Json materialsJson(const std::vector<MaterialUse>& uses) {
  Json list = Json::array();
  for (const MaterialUse& use : uses)
    list.push_back({{"name", use.name},
                    {"by_colour", use.byColour},
                    {"colour", use.colour},
                    {"rule", use.rule.empty() ? Json(nullptr) : Json(use.rule)},
                    {"shapes", use.shapes},
                    {"area", use.area}});
  return list;
}

} // namespace

std::string explainWorld(const Options& options, const xvrml::World& world, const RTstats& stats,
                         const std::vector<xvrml::ExplainedObject>& objects) {
  std::vector<MaterialUse> materials;
  if (!options.shaders.empty()) materials = materialUses(options.shaders, world);
  const Compat compat = compatOf(world);
  uint64_t triangles = 0, bytes = 0, instances = 0, shapes = 0;
  for (const xvrml::ExplainedObject& o : objects) {
    triangles += o.triangles;
    bytes += o.bytes;
    instances += o.instances;
    shapes += o.shapes;
  }
  if (options.json) {
    Json list = Json::array();
    for (const xvrml::ExplainedObject& o : objects)
      list.push_back({{"name", o.name},
                      {"reason", o.reason},
                      {"triangles", o.triangles},
                      {"shapes", o.shapes},
                      {"bytes", o.bytes},
                      {"instances", o.instances}});
    return dump(
        {{"transport", transportJson(stats, options.render)},
         {"compat",
          {{"scripts", {{"on", options.run.directOutputAlways}, {"affected", compat.scripts}}},
           {"textures", {{"on", options.render.multiplyTextures}, {"affected", compat.textures}}}}},
         {"materials", materialsJson(materials)},
         {"objects", std::move(list)},
         {"totals",
          {{"objects", objects.size()},
           {"shapes", shapes},
           {"triangles", triangles},
           {"bytes", bytes},
           {"instances", instances},
           {"instanced_triangles", stats.scene.triangles}}}});
  }
  std::string text =
      fmt::format("transport {}: {}\n  {}\n", picture::transportName(stats.transport.chosen),
                  stats.transport.reason, transportClaim(stats, options.render));
  text += compatText(options, compat);
  if (!materials.empty()) text += materialText(materials);
  text += fmt::format("{:>10} {:>8} {:>12} {:>9}  {}\n", "triangles", "shapes", "bytes",
                      "instances", "object: reason");
  for (const xvrml::ExplainedObject& o : objects)
    text += fmt::format("{:>10} {:>8} {:>12} {:>9}  {}: {}\n", o.triangles, o.shapes, o.bytes,
                        o.instances, oneLine(o.name), oneLine(o.reason));
  return text +
         fmt::format("{:>10} {:>8} {:>12} {:>9}  {} objects, {} triangles with all instances\n",
                     triangles, shapes, bytes, instances, objects.size(), stats.scene.triangles);
}

} // namespace vv
