// fogs.h: the fields of Fog and LocalFog as parameters of the class VRML97Environment, and the
// LocalFogs of a world (ISO/IEC 19775-1 24.4.4): each lies in front of what is below its parent
// group. Called by the mapper for every camera, on its thread.
#pragma once

#include <unordered_set>

#include "mapper/graph/places.h"
#include "mapper/ration.h"
#include "mapper/rt.h"

namespace xvrml::mapper {

// Sets the parameters of a Fog or LocalFog. world: from its coordinate system, in which distances
// are measured (clause 6.19), to the world; local: from the shader's coordinate system to the
// world.
void setFog(ShaderSetup& shader, const Node& fog, const Matrix& world, const Matrix& local,
            bool linear, Diagnostics& diagnostics);

class Fogs {
 public:
  Fogs(World& world, bool linearColor, ShaderClasses& classes)
      : world_(world), linear_(linearColor), classes_(classes), quota_(world, "local fogs") {}

  // Gives the group around each LocalFog its fog. The places' instances must exist. The last
  // one in a group counts that is enabled.
  void updateForFrame(const Graph& graph, Places& places);
  // Returns the place of the LocalFog that counts at the top level of the file, which has no
  // instance of its own: it takes the place of the bound Fog. Returns `none` if there is none.
  static int32_t outermost(const Graph& graph, const Places& places);
  void changed(const Node& node) { changed_.insert(&node); } // its fields have changed
  void remove(const std::vector<Place>& gone); // removes the fogs of places that are gone
  void clear(Places& places);                  // removes everything
  uint64_t parametersSet() const { return sets_; }

 private:
  void makeOrMove(Place& place, const Node& node);
  void removeFog(Place& place);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  Quota quota_;
  std::unordered_set<const Node*> changed_; // since the last frame
  uint64_t sets_ = 0;
};

} // namespace xvrml::mapper
