// mapper.h: draws a world through the OpenRT API (library xvrml_openrt). The mapper translates
// scene-graph nodes to rt* calls.
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
  std::string name; // DEF name, may be empty
  std::string description;
  NodeRef node;
  double matrix[16]; // local to world, column-major
};

// A place of an ORTSensor or of an ORTLight.
struct SensorInfo {
  std::string name; // DEF name, may be empty
  NodeRef node;
  double matrix[16]; // local to world, column-major
};

struct MapOptions {
  // Decodes sRGB colours (docs/decisions/0007-two-colour-modes.md). If false, the standard's
  // equation is applied to the numbers as written.
  bool linearColor = true;
  enum class Headlight : uint8_t { automatic, on, off } headlight = Headlight::automatic;
  // aspect: width / height. The smaller angle of view is the Viewpoint's fieldOfView (clause 6.53).
  double aspect = 4.0 / 3.0;
};

// Returns a camera that looks along the view's -z (camera to world, column-major) and has all of
// `bounds` in the picture.
CameraSettings cameraAround(const Bounds& bounds, const double view[16], double fovy,
                            double aspect);

// A signed axis of the world's coordinate system.
enum class Axis : uint8_t { x, y, z, minusX, minusY, minusZ };
// Writes the unit vector along an axis.
void upVector(Axis axis, double up[3]);

// A guess which axis points up in a world that has no Viewpoint, and the reason for it (a clause of
// a sentence). frontal: the world is a figure in the x-y plane, to be seen from the front.
struct UpGuess {
  Axis axis = Axis::y;
  std::string reason;
  bool frontal = false;
};

// The sphere around the centre of the bounds that encloses all that is drawn. empty: nothing is
// drawn.
struct BoundingSphere {
  double center[3] = {0, 0, 0};
  double radius = 0;
  bool empty = true;
};
// Writes the rotation of a camera (camera to world, column-major) that looks at a model from 35
// degrees to the right of its front and 25 degrees above.
void threeQuarterView(Axis up, double view[16]);
// Returns whether a camera far away that looks along the view's -z sees nothing but backs of faces
// that have one side, which are not drawn. False for a world without faces.
bool facesAway(const World& world, const double view[16]);
// Returns a camera that looks along the view's -z at the centre of a sphere. The picture holds the
// whole sphere, with a margin.
CameraSettings cameraAround(const BoundingSphere& sphere, const double view[16], double fovy,
                            double aspect);

struct MapStats {
  uint64_t shapes = 0, triangles = 0, lights = 0, textures = 0, objects = 0, instances = 0;
  uint64_t missingTextures = 0; // ImageTextures and panoramas without a readable picture
  // Work done since the mapper was made:
  uint64_t objectsDefined = 0; // definitions of OpenRT objects, redefinitions included
  uint64_t instancesMoved = 0; // calls of rtInstanceMatrix
  uint64_t parametersSet = 0;  // calls of rtParameter* for shaders that already existed
  uint64_t texturesLoaded = 0; // pictures passed to OpenRT
  uint64_t lightsChanged = 0;  // lights made, moved or removed
  uint64_t regroupings = 0;    // updates that changed how static nodes are grouped into objects
};

// An OpenRT object and the reason why it is an object of its own.
struct ExplainedObject {
  // Path of names from the root, "Town/House". A node without a name appears as its type and line.
  std::string name;
  // "merged static geometry of 5312 shapes, each with its own material", "split: ORTInstance" ...
  std::string reason;
  uint64_t triangles = 0; // triangles of one instance, without those of nested objects
  uint64_t shapes = 0;
  uint64_t bytes = 0;     // estimated: arrays and acceleration structure
  uint64_t instances = 0; // instances of this object in the definitions of all objects
};

// Maps a world into the current OpenRT context. There is one mapper per context. [the context's
// thread]
class OpenRTMapper {
 public:
  OpenRTMapper(World& world, const MapOptions& options);
  ~OpenRTMapper();

  // Returns the viewpoints in the order of the file, prototypes and Inlines expanded.
  const std::vector<ViewpointInfo>& viewpoints() const;
  // Returns the index of the viewpoint that is bound first, -1 if there is none. It belongs to the
  // file itself, not to its Inlines (clause 4.6.10).
  int boundViewpoint() const;
  // Returns the sensors in the order of the file, prototypes and Inlines expanded. A sensor that is
  // used several times has several places.
  std::vector<SensorInfo> sensors() const;
  // Returns the places of the ORTLights that are on, likewise.
  std::vector<SensorInfo> lamps() const;
  // Returns the camera of a viewpoint (index into viewpoints()), or the standard's default camera
  // (0 0 10) if the index is out of range.
  CameraSettings viewpointCamera(size_t index) const;
  // Returns a camera along -z of the first viewpoint (or of the world) that shows the whole world.
  CameraSettings fitCamera(double fovy) const;
  // Returns a camera that looks along the view's -z and has all that is drawn in the picture. It is
  // nearer than one around the bounds where the world does not fill its box.
  CameraSettings cameraAround(const double view[16], double fovy, double aspect) const;
  // Returns whether a camera sees all that is drawn, but for a few hundredths of the picture.
  bool seesAll(const CameraSettings& camera, double aspect) const;
  // Returns facesAway() of the world; the answer is kept until the world changes.
  bool facesAway(const double view[16]) const;
  Bounds bounds() const;
  BoundingSphere boundingSphere() const;
  // Guesses the axis that points up, by the rules of docs/decisions/0040-models.md.
  UpGuess guessUp() const;

  // Sets the bound nodes (camera.h); by default the first of each kind in the file. Takes effect
  // with the next map().
  void bind(const BoundNodes& bound);
  // Overrides MapOptions::headlight from the next map() on.
  void setHeadlight(MapOptions::Headlight headlight);
  // If true, a colour texture multiplies diffuseColor (X3D's rule) instead of replacing it (clause
  // 4.14.3). Call it before the first map().
  void setMultiplyTextures(bool multiply);
  // If true, Cylinder and Cone are drawn without facets (rtCylinder, rtCone). Call it before the
  // first map().
  void setExactShapes(bool exact);
  // Sets the diameters at which points are drawn as balls and lines as rods, in the units of their
  // Shape. They are then lit, in the colours that they have as points and lines, and cast shadows.
  // 0: they are thin and unlit (clauses 6.24, 6.36). Call it before the first map().
  void setThickness(double points, double lines);
  // If true, three soft lights around the camera replace the automatic headlight in a world that
  // leaves its lighting open: one without Viewpoint, NavigationInfo, lights and ORT nodes. Takes
  // effect with the next map(); false by default.
  void setModelLight(bool on);
  // Shows or hides the bound Background or ORTBackground from the next map() on; shown by default.
  void setBackground(bool on);
  // Applies the changes that takeChanges() returned, between frames. Updates only what the changes
  // affect. A world whose nodes change without such records needs a new mapper.
  void update(const FieldChanges& changes);
  // If true, update() leaves out what appears with a large mesh until threads of their own have
  // read the mesh. A node that gets it shows its former content meanwhile. If false, update()
  // waits; this is the default. The scene is the same in the end.
  void setPatient(bool patient);
  // Returns whether the last update() has left something out. Call it again then, also without
  // changes.
  bool isBehind() const;
  // Returns how many large meshes such threads have read since the mapper was made.
  uint64_t readBeside() const;
  // Returns the present objects, those with the most triangles first. Call it after map().
  std::vector<ExplainedObject> explain() const;

  // Makes all rt* calls for this camera: geometry once, then lights, environment, headlight, and
  // the billboards and LODs for the camera.
  void map(const CameraSettings& camera);
  MapStats stats() const;
  // The meaning of the numbers in the name channel (RT_NAME). Each Shape node has one number,
  // wherever and however often it is drawn, and keeps it until the Shape is removed. The number may
  // then be given to a new Shape. 0 means nothing.
  // - names(): the Shape's DEF name, else that of the nearest group above it, else "Shape".
  // - nodes(): the Shape itself.
  const std::vector<std::string>& names() const;
  std::vector<NodeRef> nodes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns whether a class of surface shaders has a parameter for the colour of a Material or
// PhysicalMaterial: diffuseColor, baseColor, color or reflectance. `library` is the file of the
// class, or empty. Loads the class in the current context; false if there is none. [its thread]
bool takesMaterialColor(const std::string& shaderClass, const std::string& library);

} // namespace xvrml
