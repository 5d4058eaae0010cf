// custom_shaders.h: ORTShader nodes as OpenRT shaders, whatever they are used for: surfaces,
// lights, cameras, environments. Made by the mapper's thread when first used.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mapper/ration.h"
#include "mapper/rt.h"
#include "mapper/shading/shader_options.h"
#include "mapper/shading/textures.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

class CustomShaders {
 public:
  CustomShaders(World& world, ShaderClasses& classes, Textures& textures)
      : world_(world), classes_(classes), textures_(textures),
        ration_(world, "options of shaders") {}

  // Sets parameters that the world gives by other means than the options, which come after it and
  // so have the last word.
  using Preset = std::function<void(ShaderSetup& shader, const ShaderClass& shaderClass)>;
  // Of an ORTShader node (rendered) for a role, RT_SURFACE ...; 0: there is no such class, or it is
  // for another role (said). A user whose preset differs from that of others has a shader of its
  // own; null: one for all that have none.
  RTid of(nodes::ORTShader& node, RTenum role, const Node* user = nullptr,
          const Preset& preset = {});
  // The fields of the node are others; who uses it has to ask again.
  void changed(const Node& node);
  // Deletes what was made for this user.
  void forget(const Node& user);
  // Deletes shaders that others have taken the place of; when nothing in the scene uses them any
  // more.
  void sweep();
  void clear(); // deletes everything
  uint64_t parametersSet() const { return sets_; }

 private:
  struct Made {
    NodeRef node;
    RTid shader = 0;
    std::string name, file;
    std::vector<std::string> options; // names of the parameters it has been given
    uint64_t bytes = 0;               // taken from the world's budget for them
    bool stale = false;
  };
  void make(Made& made, RTenum role, const Preset& preset);
  void refresh(Made& made, RTenum role, const Preset& preset);
  // The options that the node has now, counted as this shader's; none, after a message, if the
  // world's budget does not allow them.
  std::vector<ShaderOption> optionsOf(Made& made, std::vector<std::string>& errors);
  bool take(Made& made, uint64_t bytes);
  void setOption(const ShaderOption& option, Made& made, RTenum role);

  World& world_;
  ShaderClasses& classes_;
  Textures& textures_;
  std::map<std::pair<const Node*, const Node*>, Made> made_; // by ORTShader and user
  Ration ration_;
  std::vector<RTid> replaced_;
  std::set<const Node*> told_; // whose options have been complained of
  uint64_t sets_ = 0;
};

} // namespace xvrml::mapper
