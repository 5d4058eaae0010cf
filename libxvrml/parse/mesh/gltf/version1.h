// version1.h: glTF 1.0 as glTF 2.0. A pure function, any thread.
#pragma once

#include "parse/mesh/gltf/json.h"

namespace xvrml::gltf {

// Changes a document of version 1 to one of version 2: objects that are named become lists with
// indices, techniques become materials that are no metal. Animations and skins are removed; returns
// whether there were any.
bool convertVersion1(Json& document);

} // namespace xvrml::gltf
