#include "image/picture_urls.h"

#include "base/data_url.h"
#include "base/locator.h"

namespace xvrml {

std::string openFirst(const MFString& urls, const Node& node, const World& world,
                      const OpenPicture& open) {
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
