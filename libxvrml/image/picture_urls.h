// picture_urls.h: the URLs of pictures in worlds. [the thread that owns the nodes]
#pragma once

#include <functional>
#include <string>

#include "xvrml/world.h"

namespace xvrml {

// Opens a file or data: URL. Returns false, and the reason in `why`, if it cannot be used.
using OpenPicture = std::function<bool(const std::string& path, std::string& why)>;

// Calls open() with what each URL leads to, until it returns true. Returns what is wrong with the
// first URL; this has no meaning if a call returned true. node: holds the URLs; its file is the
// base of relative ones, else that of the world.
std::string openFirst(const MFString& urls, const Node& node, const World& world,
                      const OpenPicture& open);

} // namespace xvrml
