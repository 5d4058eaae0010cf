// custom_shaders.h: ORTShader nodes as OpenRT shaders for surfaces, lights, cameras and
// environments, made on first use. [the mapper's thread]
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mapper/ration.h"
#include "mapper/rt.h"
#include "mapper/shading/shader_fields.h"
#include "mapper/shading/textures.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

class CustomShaders {
 public:
  CustomShaders(World& world, ShaderClasses& classes, Textures& textures)
      : world_(world), classes_(classes), textures_(textures), quota_(world, "options of shaders") {
  }

  // Sets parameters that the world defines elsewhere, such as in a Material. The node's options are
  // set afterwards and override them.
  using Preset = std::function<void(ShaderSetup& shader, const ShaderClass& shaderClass)>;
  // Returns the shader of a rendered ORTShader node for a role (RT_SURFACE ...). Returns 0, after
  // an error message, if the class does not exist or has another role. A user with a preset of its
  // own has its own shader; null: the shader shared by all users without one.
  RTid shaderFor(nodes::ORTShader& node, RTenum role, const Node* user = nullptr,
                 const Preset& preset = {});
  // Marks the node's shaders as out of date. Their users have to call shaderFor() again.
  void changed(const Node& node);
  // Deletes the shaders made for this user with the next sweep(): the scene may still use them.
  void forget(const Node& user);
  // Deletes replaced shaders. Call it when nothing in the scene uses them any more.
  void sweep();
  void clear(); // deletes everything
  uint64_t parametersSet() const { return sets_; }

 private:
  struct ShaderEntry {
    NodeRef node;
    RTid shader = 0;
    std::string name, file;
    // Names of the parameters that have been set from options and declared fields.
    std::vector<std::string> options;
    uint64_t bytes = 0; // taken from the world's budget for the options
    bool stale = false;
    bool unreadable = false; // the file of an option could not be read
  };
  void make(ShaderEntry& made, RTenum role, const Preset& preset);
  void refresh(ShaderEntry& made, RTenum role, const Preset& preset);
  bool change(ShaderEntry& made, const std::vector<ShaderOption>& options, RTenum role,
              const Preset& preset);
  // Returns the node's current options and declared fields, and charges them to this shader.
  // Returns none, after a message, if the world's budget does not allow them. `errors` gets those
  // of options.
  std::vector<ShaderOption> optionsOf(ShaderEntry& made, const ShaderClass& shaderClass,
                                      std::vector<std::string>& errors);
  void say(const Node& node, const std::vector<FieldProblem>& problems);
  bool take(ShaderEntry& made, uint64_t bytes);
  void setOption(const ShaderOption& option, ShaderEntry& made, RTenum role);

  World& world_;
  ShaderClasses& classes_;
  Textures& textures_;
  std::map<std::pair<const Node*, const Node*>, ShaderEntry> entries_; // by ORTShader node and user
  Quota quota_;
  std::vector<RTid> replaced_;
  std::set<const Node*> reported_; // nodes whose option errors have been reported
  // Problems of the fields of nodes that have been reported. A route may change the values in every
  // picture.
  std::set<std::pair<const Node*, std::string>> said_;
  uint64_t sets_ = 0;
};

} // namespace xvrml::mapper
