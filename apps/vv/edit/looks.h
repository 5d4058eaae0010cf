// looks.h: How the surfaces of Shapes look: the materials of the standards, the classes of shader
// plug-ins, and the user's own files. A user chooses one of them for the Shapes that are selected.
// They throw xvrml::EditError. [the browser's thread, while the world can be used]
#pragma once

#include <string>
#include <vector>

#include "edit/world_editor.h"

namespace vv {

struct Look {
  std::string name;    // the type of a material, the class of a shader, or the name of a file
  std::string library; // the plug-in that holds the class; "": no shader
  std::string text;    // what it is
  std::string file{};  // a world whose first Appearance it is (material_files.h); "": none
  bool isShader() const { return !library.empty(); }
};

// How a Shape looks now.
struct ShapeLook {
  std::string name;          // "Material", "Glass", or "" for no material
  xvrml::NodeRef appearance; // null: there is none
  xvrml::NodeRef surface;    // the material or the shader; null: there is none
  size_t places = 0;         // in how many places the appearance stands
};

// Returns what can be chosen everywhere: materials first.
std::vector<Look> looksFor(WorldEditor& editor);
// Returns what the files of a folder give. [any thread]
std::vector<Look> looksIn(const std::string& folder);
// Leaves the places of the appearance to be counted.
ShapeLook lookOf(const xvrml::Node& shape);
// Returns the option of vv that gives the shader of a Shape to one of its name:
// "--shader Lens=Glass:index=1.8". Empty if the Shape has no name, or no shader that an option can
// give as a whole.
std::string shaderOption(const xvrml::Node& shape);

// Gives the Shapes that are selected another look. A Shape without an appearance gets one. A
// texture stays, and so do colour and transparency where the new material has them; the Appearance
// of a file is copied as a whole. onlyHere: an appearance that also stands elsewhere is copied
// first, so that other Shapes stay as they are; the selected Shapes share the copy if they have
// shared the appearance.
void setLook(WorldEditor& editor, const Look& look, bool onlyHere);

// Selects all Shapes of the file whose surface is that of the selected Shape, or is the selected
// material, shader or appearance: the same node, or one with equal values.
void selectSameLook(WorldEditor& editor);

} // namespace vv
