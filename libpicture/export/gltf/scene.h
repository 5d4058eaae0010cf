// scene.h: The renderer that writes a world as a glTF document: the hierarchy of nodes, cameras and
// lights. [the thread that owns the world]
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "libpicture/export/export.h"
#include "libpicture/export/gltf/document.h"
#include "libpicture/export/gltf/meshes.h"
#include "libpicture/export/gltf/motion.h"
#include "xvrml/renderer.h"

namespace picture::gltf {

// Returns the intensity in candela that a point light needs to light a surface at a distance as the
// node does there: glTF's light falls off with the square of the distance. scale: metres per unit
// of the node's coordinates. irradiance: what the node gives where nothing attenuates it.
// attenuation: of the node.
double candelaOf(double irradiance, const xvrml::Vec3f& attenuation, double distance, double scale);

class Scene : public xvrml::Renderer {
 public:
  Scene(Document& document, Meshes& meshes, Motions& motions, Remarks& remarks);
  // Writes what needs the bounds of the world: lights and cameras. Call it after the walk.
  void finish();

  using Visit = xvrml::Visit;
  using State = xvrml::RenderState;
  Visit render(xvrml::Node& node, const State& state) override;
  Visit renderTransform(xvrml::nodes::Transform& node, const State& state) override;
  Visit renderCADPart(xvrml::nodes::CADPart& node, const State& state) override;
  Visit renderBillboard(xvrml::nodes::Billboard& node, const State& state) override;
  Visit renderLOD(xvrml::nodes::LOD& node, const State& state) override;
  Visit renderSwitch(xvrml::nodes::Switch& node, const State& state) override;
  Visit renderAnchor(xvrml::nodes::Anchor& node, const State& state) override;
  Visit renderShape(xvrml::nodes::Shape& node, const State& state) override;
  Visit renderViewpoint(xvrml::nodes::Viewpoint& node, const State& state) override;
  Visit renderOrthoViewpoint(xvrml::nodes::OrthoViewpoint& node, const State& state) override;
  Visit renderDirectionalLight(xvrml::nodes::DirectionalLight& node, const State& state) override;
  Visit renderPointLight(xvrml::nodes::PointLight& node, const State& state) override;
  Visit renderSpotLight(xvrml::nodes::SpotLight& node, const State& state) override;
  void leave(xvrml::Node& node, const State& state) override;
  void draw(const xvrml::DrawnShape& shape) override;

 private:
  // A node of the world whose children are being visited.
  struct Open {
    size_t depth = 0; // length of the path to it
    const xvrml::Node* node = nullptr;
    std::vector<Json> chain; // objects of glTF nodes, each of which holds the next one
    size_t scaleAt = 0;      // place in the chain with the scale
    Vec offset;              // added to an animated translation
    std::vector<size_t> children;
    struct Drawn {
      size_t mesh;
      std::string name;
    };
    std::vector<Drawn> shapes;
  };
  // A light or camera, whose numbers depend on how far away the world is.
  struct Deferred {
    Json object;
    Vec place;            // in the world
    double scale = 1;     // metres per unit
    double intensity = 0; // field of the light
    bool placed = false;  // it has a place, so its distance matters
    xvrml::Vec3f attenuation;
  };
  template <class T> Visit open(T& node, const State& state);
  void enter(const xvrml::Node& node, const State& state, std::vector<Json> chain);
  void close();
  void addShapes(Open& open, Json& innermost);
  void addChild(size_t node);
  // Adds a glTF node with a place of its own to the open one.
  void addPlaced(Json node, const Place& place, const xvrml::Node& of);
  template <class T> Deferred lightOf(const T& node, const char* type, const State& state);
  template <class T> Place placeLight(const T& node, const State& state, Deferred& light);
  bool isOff(bool on);
  void addLight(Deferred light, const Place& place, const xvrml::Node& node);
  void addCamera(Json camera, const std::string& name, const xvrml::Vec3f& position,
                 const xvrml::Rotation& orientation, const xvrml::Node& node, const State& state);
  bool choosesLooks(const xvrml::nodes::Switch& node);
  const xvrml::nodes::Switch* chooserOf(const State& state);
  void grow(const Box& box, const double matrix[16]);
  Vec centre() const;
  void finishCamera(Deferred& camera);
  double irradianceOfOne();
  void finishLight(Deferred& light, double irradiance);

  Document& document_;
  Meshes& meshes_;
  Motions& motions_;
  Remarks& remarks_;
  std::vector<Open> open_;
  std::unordered_map<const xvrml::Node*, bool> choosers_; // answers of choosesLooks()
  std::vector<Deferred> lights_, cameras_;
  bool hasPhysical_ = false, hasOthers_ = false; // lit materials that are drawn
  double low_[3], high_[3]; // bounds of what is drawn; low_[0] > high_[0]: nothing is
};

} // namespace picture::gltf
