// movie_texture.cpp: MovieTexture (clause 6.28): its events and its current picture, which is
// decoded on request.
#include <atomic>
#include <exception>
#include <stdexcept>

#include "behaviour/media.h"
#include "event/live.h"
#include "image/film.h"
#include "image/image.h"
#include "xvrml/media.h"

namespace xvrml {
namespace {

// Pixels of all films being decoded in this process. A world must not open thousands of large
// films.
std::atomic<uint64_t> openPixels{0};

struct State : Media {
  ~State() override { close(); }

  double load(Events& events, Node& node) override {
    close();
    film = nullptr;
    image = {};
    wanted = shown = none;
    limits = loadOptions(events).limits;
    share = mediaShare(events);
    readFirst(events, node, static_cast<nodes::MovieTexture&>(node).url,
              [&](const std::string& path) {
                if (decodesFilms()) {
                  auto read = FilmData::read(path, limits);
                  if (!share.take(read->bytes()))
                    throw std::runtime_error(overBudgetMessage(read->bytes(), *share.budget()));
                  film = std::move(read);
                } else { // without a decoder show at least the picture of a GIF
                  try {
                    image = readImage(path, {limits, ~uint64_t(0), share.budget().get()});
                  } catch (const std::exception&) { FilmData::read(path, limits); } // throws why
                  wanted = shown = 0;
                  events.diagnostics().warn(
                      node.source,
                      "MovieTexture: the first picture only: this build has no decoder of films");
                }
                return true;
              });
    if (film) wanted = static_cast<nodes::MovieTexture&>(node).speed < 0 ? film->pictures() - 1 : 0;
    return film ? film->duration() : -1;
  }

  TimeFields fields(const Node& node) const override {
    const auto& n = static_cast<const nodes::MovieTexture&>(node);
    return {n.startTime, n.stopTime, duration > 0 ? duration / std::abs(double(n.speed)) : 0,
            n.loop,      true,       n.pauseTime,
            n.resumeTime};
  }

  void play(Events& events, Node& node, const TimeStep& step) override {
    if (!film) return;
    const auto& n = static_cast<const nodes::MovieTexture&>(node);
    // The end of a cycle is the start of the next one. If none follows, the last picture stays.
    const double fraction = step.fraction == 1 && n.loop && !step.ends ? 0 : step.fraction;
    const size_t picture = n.speed == 0 ? 0
                                        : film->pictureAt(n.speed < 0 ? duration * (1 - fraction)
                                                                      : duration * fraction);
    if (picture == wanted) return;
    wanted = picture;
    events.changed(node, fieldOf<nodes::MovieTexture>("url"));
  }

  const Image* picture() {
    if (film && wanted != shown) decode();
    if (!time.active()) close(); // one picture is enough now
    return image.components > 0 ? &image : nullptr;
  }

 private:
  static constexpr size_t none = ~size_t(0);

  void decode() {
    shown = wanted; // it is not tried twice
    try {
      if (!reader) {
        if (openPixels.load() > limits.imagePixels) return;
        reader = std::make_unique<FilmReader>(film, limits);
      }
      reader->read(wanted, image);
    } catch (const std::exception&) { return; } // the previous picture stays
    const uint64_t pixels = uint64_t(image.width) * uint64_t(image.height);
    openPixels += pixels - counted;
    counted = pixels;
  }

  void close() {
    reader = nullptr;
    openPixels -= counted;
    counted = 0;
  }

  Limits limits;
  Share share;                          // share of the world's budget for the compressed pictures
  std::shared_ptr<const FilmData> film; // null: no file could be read
  std::unique_ptr<FilmReader> reader;
  Image image;
  size_t wanted = none, shown = none; // picture numbers
  uint64_t counted = 0;               // this film's part of openPixels
};

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  return beginMedia(events, node, std::make_unique<State>());
}

} // namespace

const Image* currentImage(const Node& node) {
  if (node.type().index != nodes::MovieTexture::typeIndex || !node.live || !liveOf(node)->part)
    return nullptr;
  auto* state = static_cast<State*>(liveOf(node)->part->state.get());
  return state ? state->picture() : nullptr;
}

void addMovieTextureBehaviours(const AddBehaviour& add) {
  addMedia(add, nodes::MovieTexture::nodeType(), begin);
}

} // namespace xvrml
