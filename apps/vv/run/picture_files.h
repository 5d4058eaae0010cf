// picture_files.h: Writes the pictures of a run to its files and films: -o, --raw, --denoise,
// --exposure auto and --false-colour. [main thread]
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "libpicture/denoiser.h"
#include "libpicture/files/film.h"
#include "options/options.h"
#include "run/checkpoint.h"
#include "run/view_requests.h"
#include "xvrml/world.h"

namespace vv {

class PictureFiles {
 public:
  // checkpoint: has the sums that EXR files get behind their pixels; null: sums are not kept. The
  // arguments must live as long.
  PictureFiles(const Options& options, const xvrml::World& world, const Checkpoint* checkpoint)
      : options_(options), world_(world), checkpoint_(checkpoint) {}

  // The functions throw Failure and std::runtime_error, which name the option.

  // Prepares a picture for its files: chooses its exposure, writes the files of --raw, and denoises
  // it if the renderer has not done so. A picture that was interrupted stays as it is, in all
  // files. total: pictures of the run.
  void prepare(const PictureRequest& request, size_t total, picture::RenderResult& result);
  // Writes the files of a prepared picture, and adds it to the film of its view. falseColour: end
  // of the scale in cd/m2, 0: chosen by the first picture; none: false colours are not wanted.
  void write(const PictureRequest& request, std::optional<double> falseColour,
             const picture::RenderResult& result);
  // Writes the picture so far of one that goes on.
  void writePart(const PictureRequest& request, std::optional<double> falseColour,
                 picture::Picture soFar);
  // Ends the films and writes them.
  void finishFilms();

 private:
  // Says the files of which options get a picture.
  enum class Which : uint8_t { all, shown, raw };
  static bool isOf(const Output& output, Which only);

  std::optional<picture::Picture> inFalseColours(const picture::Picture& made,
                                                 std::optional<double> falseColour, bool complete);
  void writePictures(const PictureRequest& request, const picture::Picture& made,
                     const std::optional<picture::Picture>& coloured, bool complete, Which only);
  void addToFilms(const PictureRequest& request, const picture::Picture& made, Which only);
  picture::Picture denoised(const picture::Picture& noisy);

  const Options& options_;
  const xvrml::World& world_;
  const Checkpoint* checkpoint_;
  struct OpenFilm {
    const Output* of = nullptr;
    std::unique_ptr<picture::Film> film;
  };
  std::map<std::string, OpenFilm> films_;              // indexed by path
  std::unique_ptr<picture::PictureDenoiser> denoiser_; // null before the first use
  std::optional<double> exposure_; // what --exposure auto gave; none: no picture has been made
  double endOfScale_ = 0;          // brightest false colour in cd/m2; 0: no picture has been made
};

// Writes a file of -o or --raw. Errors name the option.
void writeOutput(const Output& output, const std::string& path, const std::string& bytes);

// Writes to a file, or to standard output if the path is "-".
void writeText(const std::string& path, const std::string& text);

} // namespace vv
