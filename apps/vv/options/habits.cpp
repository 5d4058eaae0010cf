#include "habits.h"

#include <algorithm>

#include <fmt/format.h>

#include "libpicture/files/film.h"
#include "libpicture/files/formats.h"
#include "number_text.h"

namespace vv {

namespace {

struct ForeignOption {
  std::string_view option, instead;
};

// Options of view3dscene, F3D, Blender, Mitsuba, LuxCore, POV-Ray and ImageMagick under their names
// there.
constexpr ForeignOption habits[] = {
    {"--resolution", "--size 800x600 sets the size of the picture"},
    {"--geometry", "--size 800x600 sets the size of the picture"},
    {"--width", "--size 800x600 sets width and height"},
    {"--height", "--size 800x600 sets width and height"},
    {"--screenshot", "-o FILE writes a picture; --time SECONDS chooses the moment"},
    {"--screenshot-range", "--frames FIRST-LAST with -o 'picture-{frame:4}.png' writes a sequence"},
    {"--render-output", "-o FILE writes a picture"},
    {"--outfile", "-o FILE writes a picture"},
    {"--video", "-o film.mp4 with --frames FIRST-LAST or --turntable N writes a film"},
    {"--sample-count", "--spp N sets the samples per pixel"},
    {"--quality", "--spp N sets the samples per pixel, --error 2% the precision"},
    {"--noise-threshold", "--error 2% sets the precision"},
    {"--max-depth", "--depth N sets the length of paths"},
    {"--integrator", "--transport NAME chooses the light transport algorithm"},
    {"--engine", "--transport NAME chooses the light transport algorithm"},
    {"--hdri", "--environment FILE lights the world from all around"},
    {"--hdri-file", "--environment FILE lights the world from all around"},
    {"--envmap", "--environment FILE lights the world from all around"},
    {"--camera-position", "--camera PX,PY,PZ:TX,TY,TZ sets position and target"},
    {"--camera-index", "--viewpoint N chooses a viewpoint by its number"},
    {"--frame", "--frames N, or --time SECONDS, chooses the moment"},
    {"--animation-time", "--time SECONDS chooses the moment"},
    {"--jobs", "--threads N sets the number of threads"},
    {"--no-render", "--check reads the world and makes no picture"},
    {"--validate", "--check reads the world and reports its problems"},
    {"--batch", "-o FILE writes a picture and opens no window"},
    {"--no-window", "-o FILE writes a picture and opens no window"},
    {"--offscreen", "-o FILE writes a picture and opens no window"},
    {"--headless", "-o FILE writes a picture and opens no window"},
};

bool isCount(std::string_view text, int& value) { return isNumber(text, value) && value > 0; }

} // namespace

std::string sizeHint(std::string_view text) {
  const size_t apart = text.find_first_of(",*: X");
  int width = 0, height = 0;
  if (apart == text.npos) {
    if (!isCount(text, width)) return "";
    return fmt::format(": did you mean --size {}x{}? Width and height are both needed", width,
                       std::max(1, width * 3 / 4));
  }
  if (!isCount(text.substr(0, apart), width) || !isCount(text.substr(apart + 1), height)) return "";
  return fmt::format(": did you mean --size {}x{}?", width, height);
}

std::string optionHint(std::string_view option) {
  for (const ForeignOption& habit : habits)
    if (habit.option == option)
      return fmt::format("there is no option {}: {}", option, habit.instead);
  return "";
}

std::string secondFileHint(const std::string& first, const std::string& second) {
  if (picture::formatOf(second) || picture::filmOf(second) != picture::FilmKind::none)
    return fmt::format("\"{}\" looks like a picture to be written: vv {} -o {}", second, first,
                       second);
  return fmt::format("one world at a time: \"{}\" is one too many; in a shell: for w in {} {} ...; "
                     "do vv \"$w\" -o \"${{w%.*}}.png\"; done",
                     second, first, second);
}

} // namespace vv
