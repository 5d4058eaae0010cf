// mapper.h: draws a world through the OpenRT API: the mapper of scene-graph nodes to rt* calls
// (library xvrml_openrt).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "xvrml/camera.h"
#include "xvrml/change.h"
#include "xvrml/world.h"

namespace xvrml {

struct ViewpointInfo {
  std::string name; // DEF, may be empty
  std::string description;
  NodeRef node;
  double matrix[16]; // local to world, column-major
};

struct MapOptions {
  bool linearColor = true; // decode sRGB (vv-cli.md "Colour"); false: the standard's equation on
                           // the numbers as written
  enum class Headlight : uint8_t { automatic, on, off } headlight = Headlight::automatic;
  double aspect =
      4.0 /
      3.0; // width / height: the smaller angle of view is the Viewpoint's fieldOfView (clause 6.53)
};

// A camera that looks along the view's -z (camera to world, column-major) from where all of bounds
// is in the picture.
CameraSettings cameraAround(const Bounds& bounds, const double view[16], double fovy,
                            double aspect);

// An axis of the world's coordinate system, in its direction or against it.
enum class Axis : uint8_t { x, y, z, minusX, minusY, minusZ };
// Writes the unit vector along an axis.
void upVector(Axis axis, double up[3]);

// Which axis points up in a world that has no Viewpoint, and what makes one think so (a clause of a
// sentence). frontal: it is a figure in the x-y plane, to be looked at from the front.
struct UpGuess {
  Axis axis = Axis::y;
  std::string reason;
  bool frontal = false;
};

// The sphere about the middle of the bounds that reaches to what is drawn farthest from there.
// empty: nothing is drawn.
struct BoundingSphere {
  double center[3] = {0, 0, 0};
  double radius = 0;
  bool empty = true;
};
// Writes the rotation of a camera (camera to world, column-major) that looks at a model from 35
// degrees to the right of its front and 25 degrees above.
void threeQuarterView(Axis up, double view[16]);
// A camera that looks along the view's -z at the middle of a sphere, from where the picture holds
// all of it, with a margin.
CameraSettings cameraAround(const BoundingSphere& sphere, const double view[16], double fovy,
                            double aspect);

struct MapStats {
  uint64_t shapes = 0, triangles = 0, lights = 0, textures = 0, objects = 0, instances = 0;
  uint64_t missingTextures = 0; // ImageTextures and panoramas without a picture that could be read
  // Work done since the mapper was made.
  uint64_t objectsDefined = 0; // definitions of OpenRT objects, redefinitions included
  uint64_t instancesMoved = 0; // rtInstanceMatrix
  uint64_t parametersSet = 0;  // rtParameter* of shaders that were there already
  uint64_t texturesLoaded = 0; // pictures handed over
  uint64_t lightsChanged = 0;  // lights made, moved or removed
  uint64_t regroupings = 0;    // updates that changed what is grouped with what
};

// One OpenRT object and why it is one.
struct ExplainedObject {
  std::string
      name; // path of names from the root, "Town/House"; a node without a name: its type and line
  std::string reason; // "static geometry of 5312 shapes", "ROUTE from Clock.fraction_changed" ...
  uint64_t triangles = 0; // of one instance; without those of objects that it instantiates
  uint64_t shapes = 0;
  uint64_t bytes = 0;     // estimated: arrays and acceleration structure
  uint64_t instances = 0; // of this object, in all objects' definitions
};

// Maps a world into the current OpenRT context. One mapper per context; every call on the context's
// thread.
class OpenRTMapper {
 public:
  OpenRTMapper(World& world, const MapOptions& options);
  ~OpenRTMapper();

  // Viewpoints in the order of the file (prototypes and Inlines expanded).
  const std::vector<ViewpointInfo>& viewpoints() const;
  // The viewpoint that is bound first: of the file itself, not of its Inlines (clause 4.6.10); -1
  // if there is none.
  int boundViewpoint() const;
  // Camera of a viewpoint (index into viewpoints()); of the standard's default (0 0 10) if there is
  // none.
  CameraSettings viewpointCamera(size_t index) const;
  // A camera along -z of the first viewpoint (or the world) that shows all of it.
  CameraSettings fitCamera(double fovy) const;
  Bounds bounds() const;
  BoundingSphere boundingSphere() const;
  // By the rules of docs/decisions/0040-models.md.
  UpGuess guessUp() const;

  // From here on these nodes (camera.h) are bound; without a call those that are first in the file
  // are. Takes effect with the next map().
  void bind(const BoundNodes& bound);
  // Instead of MapOptions::headlight, from the next map() on.
  void setHeadlight(MapOptions::Headlight headlight);
  // A colour texture multiplies diffuseColor (X3D's rule) instead of replacing it (clause 4.14.3).
  // Before the first map().
  void setMultiplyTextures(bool multiply);
  // Whether an automatic headlight gives way to three soft lights about the camera in a world that
  // leaves its light open: without Viewpoint, NavigationInfo, lights and nodes of this renderer's
  // own. From the next map() on; false at first.
  void setModelLight(bool on);
  // Whether the bound Background, or ORTBackground, is there, from the next map() on; true at
  // first.
  void setBackground(bool on);
  // Between frames, with what the world's takeChanges() returned: does what the changes cost, and
  // no more. A world whose nodes change without records of it must get a mapper anew.
  void update(const FieldChanges& changes);
  // The objects as they now are: those with the most triangles first. After map().
  std::vector<ExplainedObject> explain() const;

  // Makes all rt* calls for this camera: geometry once, then lights, environment, headlight,
  // billboards and LODs for the camera.
  void map(const CameraSettings& camera);
  MapStats stats() const;
  // What the numbers of the name channel (RT_NAME) stand for: each Shape node has one, wherever and
  // however often it is drawn. It keeps it as long as it is there; the number of a shape that has
  // gone is given to a new one. 0 is nothing. names(): the shape's DEF name, else that of the
  // nearest group above it, else "Shape"; nodes(): the shape itself.
  const std::vector<std::string>& names() const;
  std::vector<NodeRef> nodes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace xvrml
