// picture_urls.h: the URLs of pictures in worlds. [the thread that owns the nodes]
#pragma once

#include <string>

#include "base/data_url.h"
#include "base/locator.h"
#include "xvrml/world.h"

namespace xvrml {

// Calls open(path, why) with the file or data: URL that each URL leads to, until it returns true.
// open() sets `why` if it returns false. Returns what is wrong with the first URL; it has no
// meaning if a call returned true. node: holds the URLs; its file is the base of relative ones,
// else that of the world.
template <class Open> std::string openFirst(const MFString& urls, const Node& node,
                                            const World& world, const Open& open) {
  const std::string& base = node.source.file ? *node.source.file : world.path;
  std::string error;
  for (const std::string& url : urls) {
    const ResolvedUrl resolved =
        isDataUrl(url) ? ResolvedUrl{url, {}, {}} : resolveUrl(url, base, world.options);
    std::string why = resolved.error;
    if (why.empty() && open(resolved.path, why)) return {};
    if (error.empty())
      error = why.find(url) == std::string::npos ? shortenedUrl(url) + ": " + why : why;
  }
  return error;
}

} // namespace xvrml
