#include "libpicture/sums_merge.h"

#include <fmt/format.h>

#include "libpicture/renderer.h"

namespace picture {

namespace {

// Reads a file and returns its sums, without what is needed to continue it.
SumsFile readPart(const std::string& path) {
  SumsFile file = readSums(path);
  file.done = mergeSums(file.done, file.current);
  file.current = {};
  if (file.facts.background.kind == Background::Kind::file)
    throw RenderError("its background is a picture, which it does not hold", RT_SUMS_ERROR);
  return file;
}

} // namespace

MergedPicture mergePictures(const std::vector<std::string>& paths) {
  MergedPicture merged;
  SumsFile& all = merged.sums;
  for (const std::string& path : paths) {
    try {
      SumsFile part = readPart(path);
      if (!all.done) {
        all = std::move(part);
        continue;
      }
      if (!(part.facts == all.facts))
        throw RenderError("it was made with another --channels, --colour, --depth-along or "
                          "--background, or of another world, than the files before",
                          RT_SUMS_ERROR);
      all.done = mergeSums(all.done, part.done);
      if (!(part.view == all.view) && merged.warning.empty())
        merged.warning = fmt::format("{} was made with another --exposure or --view than {}, whose "
                                     "values the picture gets",
                                     path, paths[0]);
    } catch (const RenderError& error) {
      throw RenderError(fmt::format("cannot add {}: {}", path, error.what()), error.code);
    }
  }
  merged.picture = pictureOf(all.done, all.facts);
  merged.picture.view = all.view.transform;
  if (all.view.fits) merged.picture.view.exposure = fittingExposure(merged.picture);
  return merged;
}

} // namespace picture
