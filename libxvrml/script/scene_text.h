// scene_text.h: scenes of Scripts as text: the world, the content of an Inline, and nodes that a
// program has made. [the browser's thread]
#pragma once

#include <string>
#include <vector>

#include "graph/inline_node.h"
#include "xvrml/world.h"

namespace xvrml {

// Returns what a file with these nodes at its top would hold: the nodes, the prototypes that the
// nodes and their descendants are instances of, and the routes that exist among them now.
Scope scopeOf(const MFNode& roots);

// Returns the text of a scene with a head. version: that of its file. exchange: what the file
// shares; may be null. asXml: X3D in XML; otherwise VRML97 or ClassicVRML, by the version.
std::string sceneText(Scope scene, std::shared_ptr<Exchange> exchange, const FileVersion& version,
                      bool asXml);

// Returns the encoding of such a text.
Encoding textEncoding(const FileVersion& version, bool asXml);

} // namespace xvrml
