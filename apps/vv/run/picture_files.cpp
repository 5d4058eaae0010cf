#include "run/picture_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/false_colour.h"
#include "libpicture/files/atomic_file.h"
#include "libpicture/files/formats.h"
#include "libpicture/files/read_note.h"
#include "process/messages.h"
#include "report/progress.h"
#include "run/outputs.h"
#include "steady_clock.h"

namespace vv {

void writeOutput(const Output& output, const std::string& path, const std::string& bytes) {
  try {
    picture::writeFile(path, bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", output.option(), error.what()));
  }
}

void writeText(const std::string& path, const std::string& text) {
  if (path == "-")
    writeData(text);
  else
    picture::writeFile(path, text);
}

bool PictureFiles::isOf(const Output& output, Which only) {
  return only == Which::all || output.raw == (only == Which::raw);
}

void PictureFiles::prepare(const PictureRequest& request, size_t total,
                           picture::RenderResult& result) {
  if (options_.fitExposure) {
    if (!exposure_) {
      // The filter of previews spreads a trace of light to black pixels, which would count.
      exposure_ = picture::fittingExposure(result.sampled ? *result.sampled : result.picture);
      if (!options_.quiet)
        say(fmt::format("vv: --exposure auto is {:g} for {}", *exposure_,
                        total > 1 ? "all pictures" : "this picture"));
    }
    result.picture.view.exposure = *exposure_;
  }
  if (!options_.denoise) return;
  if (result.sampled) result.sampled->view = result.picture.view;
  const picture::Picture& before = result.sampled ? *result.sampled : result.picture;
  writePictures(request, before, {}, !result.interrupted, Which::raw);
  if (result.interrupted) return;
  addToFilms(request, before, Which::raw);
  const double start = steadySeconds();
  const StageProgress progress(request.name.text(), "denoising", options_.quiet);
  // The renderer has denoised previews.
  picture::Picture made = result.sampled ? std::move(result.picture) : denoised(before);
  if (options_.mostDoubt) {
    std::vector<float> doubt = picture::doubtOf(before, picture::rgbaOf(made));
    result.doubt = picture::countDoubt(doubt);
    made.planes[picture::doubtBit] = std::move(doubt);
  }
  result.picture = std::move(made);
  result.denoiseSeconds += steadySeconds() - start;
}

picture::Picture PictureFiles::denoised(const picture::Picture& noisy) {
  if (!denoiser_) denoiser_ = std::make_unique<picture::PictureDenoiser>(options_.render.threads);
  return denoiser_->denoised(noisy);
}

void PictureFiles::write(const PictureRequest& request, std::optional<double> falseColour,
                         const picture::RenderResult& result) {
  const auto coloured = inFalseColours(result.picture, falseColour, !result.interrupted);
  writePictures(request, result.picture, coloured, !result.interrupted, Which::shown);
  if (!result.interrupted) addToFilms(request, coloured ? *coloured : result.picture, Which::shown);
}

void PictureFiles::writePart(const PictureRequest& request, std::optional<double> falseColour,
                             picture::Picture soFar) {
  if (options_.fitExposure)
    soFar.view.exposure = exposure_ ? *exposure_ : picture::fittingExposure(soFar);
  writePictures(request, soFar, inFalseColours(soFar, falseColour, false), false, Which::all);
}

void PictureFiles::finishFilms() {
  for (auto& [path, film] : films_) {
    protectFilesOf(world_, path);
    writeOutput(*film.of, path, film.film->finish());
  }
  films_.clear();
}

// Returns the picture in false colours, if they are wanted. All pictures of a run have one scale,
// so that they can be compared and have one size: the given one, or that of the first picture.
std::optional<picture::Picture> PictureFiles::inFalseColours(const picture::Picture& made,
                                                             std::optional<double> falseColour,
                                                             bool complete) {
  if (!falseColour) return {};
  double most = *falseColour > 0 ? *falseColour : endOfScale_;
  if (!(most > 0)) most = picture::mostLuminance(made);
  if (complete) endOfScale_ = most;
  return picture::falseColours(made, most);
}

// coloured: the picture in false colours, for files that are made for screens. complete: it is
// finished. only: the options whose files are written; every other file is left as it is.
void PictureFiles::writePictures(const PictureRequest& request, const picture::Picture& made,
                                 const std::optional<picture::Picture>& coloured, bool complete,
                                 Which only) {
  const picture::Picture wanted =
      picture::withChannels(made, options_.render.channels | picture::doubtBit);
  const auto encoded = [&](const picture::Format& format, const picture::Picture& one) {
    if (complete) return format.encode(one);
    picture::Picture part = one;
    part.note = picture::unfinishedNote;
    return format.encode(part);
  };
  for (const Output& output : options_.outputs) {
    if (output.film != picture::FilmKind::none || !request.isStill || !isOf(output, only)) continue;
    const bool shows = coloured && output.format->appliesCurve;
    std::string bytes = encoded(*output.format, shows ? *coloured : wanted);
    if (options_.sums && complete && output.format->encode == picture::encodeExr)
      picture::appendSums(bytes, checkpoint_->behindPixels());
    if (output.path == "-") {
      picture::writeDescriptor(STDOUT_FILENO, bytes, "standard output");
      continue;
    }
    const std::string path = pathFor(output.path, request.name);
    protectFilesOf(world_, path);
    writeOutput(output, path, bytes);
  }
}

// Adds a picture to the film of its view.
void PictureFiles::addToFilms(const PictureRequest& request, const picture::Picture& made,
                              Which only) {
  for (const Output& output : options_.outputs) {
    if (output.film == picture::FilmKind::none || !request.turns || !isOf(output, only)) continue;
    const std::string path = pathFor(output.path, {request.name.viewpoint, {}});
    auto& [of, film] = films_[path];
    of = &output;
    try {
      if (!film)
        film = std::make_unique<picture::Film>(output.film, made.width, made.height, options_.fps,
                                               made.note);
      film->add(picture::displayBytes(made));
    } catch (const std::runtime_error& error) {
      throw Failure{exitRender, fmt::format("cannot make {}: {}", path, error.what())};
    }
  }
}

} // namespace vv
