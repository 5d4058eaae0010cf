#include "libpicture/denoiser.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "libpicture/live/oidn.h"

namespace picture {

namespace {

using live::OidnFilter;
using live::OidnGuides;
using live::OidnImages;

// The filter finds its own exposure, but treats values below 1e-8 as black and loses precision far
// above 1. So colours are brought to about 1 if their median is outside of this range.
constexpr float darkest = 0x1p-10f, brightest = 0x1p10f;
// Colours that are so many times brighter than the median stay as they are: the sun's disc would
// leave nothing of the filter's precision for the rest.
constexpr float mostContrast = 0x1p20f;

float finite(float v) { return std::isfinite(v) ? v : 0.0f; }

float brightestOf(const float* rgb) {
  return std::max({finite(rgb[0]), finite(rgb[1]), finite(rgb[2])});
}

// Returns the median brightness of the pixels that are not black; 1 if all are.
float medianOf(const std::vector<float>& rgba) {
  std::vector<float> values;
  values.reserve(rgba.size() / 4);
  for (size_t i = 0; i < rgba.size(); i += 4)
    if (const float v = brightestOf(&rgba[i]); v > 0) values.push_back(v);
  if (values.empty()) return 1;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Returns the power of two that the colours are multiplied by for the filter.
float scaleFor(float median) {
  if (median >= darkest && median <= brightest) return 1;
  int exponent = 0;
  std::frexp(median, &exponent);
  return std::ldexp(1.0f, std::clamp(-exponent, -126, 126));
}

// Tells whether a pixel and its eight neighbours have the same alpha. There alpha has no noise.
bool isEven(const Picture& picture, const std::vector<float>& rgba, int x, int y) {
  const auto alphaAt = [&](int column, int row) {
    return rgba[(size_t(row) * size_t(picture.width) + size_t(column)) * 4 + 3];
  };
  const float here = alphaAt(x, y);
  for (int row = std::max(0, y - 1); row <= std::min(picture.height - 1, y + 1); row++)
    for (int column = std::max(0, x - 1); column <= std::min(picture.width - 1, x + 1); column++)
      if (alphaAt(column, row) != here) return false;
  return true;
}

} // namespace

struct PictureDenoiser::Impl {
  std::shared_ptr<const live::OidnLibrary> library;
  int threads;
  // Each is made when it is needed first: with the guides, without them.
  std::unique_ptr<OidnFilter> guided, blind;

  void run(OidnImages& images, bool hasGuides) {
    std::unique_ptr<OidnFilter>& filter = hasGuides ? guided : blind;
    if (!filter)
      filter = std::make_unique<OidnFilter>(library, threads, live::OidnQuality::high,
                                            hasGuides ? OidnGuides::noisyAlbedo : OidnGuides::none);
    filter->denoise(images);
  }

  // Replaces the colours, where they can be given to the filter.
  void colours(OidnImages& images, bool hasGuides, std::vector<float>& rgba) {
    const float median = medianOf(rgba), scale = scaleFor(median), most = median * mostContrast;
    for (size_t i = 0, to = 0; i < rgba.size(); i += 4)
      for (size_t c = 0; c < 3; c++)
        images.colour[to++] = std::clamp(finite(rgba[i + c]), 0.0f, most) * scale;
    run(images, hasGuides);
    for (size_t i = 0, from = 0; i < rgba.size(); i += 4, from += 3) {
      if (brightestOf(&rgba[i]) > most) continue;
      for (size_t c = 0; c < 3; c++) {
        const float made = images.colour[from + c] / scale;
        rgba[i + c] = std::isfinite(made) ? made : finite(rgba[i + c]);
      }
    }
  }

  // Replaces alpha at the borders of what is seen, where it has the noise of the colours, if files
  // of the picture have alpha. Where nothing is seen, black stays black.
  void alpha(const Picture& picture, const std::vector<float>& before, OidnImages& images,
             bool hasGuides, std::vector<float>& rgba) {
    bool isPartial = false;
    if (picture.transparent)
      for (size_t i = 3; i < before.size(); i += 4) isPartial |= before[i] > 0 && before[i] < 1;
    if (isPartial) {
      for (size_t i = 3, to = 0; i < before.size(); i += 4)
        for (int c = 0; c < 3; c++) images.colour[to++] = std::clamp(finite(before[i]), 0.0f, 1.0f);
      run(images, hasGuides);
    }
    size_t pixel = 0;
    for (int y = 0; y < picture.height; y++)
      for (int x = 0; x < picture.width; x++, pixel++) {
        float* const colour = &rgba[4 * pixel];
        const float made = images.colour[3 * pixel];
        if (!isEven(picture, before, x, y)) {
          if (isPartial && std::isfinite(made)) colour[3] = std::clamp(made, 0.0f, 1.0f);
        } else if (before[4 * pixel + 3] == 0 && brightestOf(&before[4 * pixel]) == 0) {
          std::fill_n(colour, 3, 0.0f);
        }
      }
  }
};

namespace {

std::shared_ptr<const live::OidnLibrary> installed() {
  checkDenoiser(Denoiser::oidn);
  return live::OidnLibrary::find();
}

} // namespace

PictureDenoiser::PictureDenoiser(int threads) : PictureDenoiser(installed(), threads) {}
PictureDenoiser::PictureDenoiser(std::shared_ptr<const live::OidnLibrary> library, int threads)
    : impl_(std::make_unique<Impl>()) {
  impl_->library = std::move(library);
  impl_->threads = threads;
}
PictureDenoiser::~PictureDenoiser() = default;

const std::string& PictureDenoiser::name() const { return impl_->library->name(); }

Picture PictureDenoiser::denoised(const Picture& noisy) {
  const std::vector<float>& before = rgbaOf(noisy);
  Picture made = noisy;
  std::erase_if(made.planes, [](const auto& plane) { return plane.first & errorChannels; });
  std::vector<float>& rgba = made.planes.at(RT_RGBA);
  const auto albedo = noisy.planes.find(RT_ALBEDO), normal = noisy.planes.find(RT_NORMAL);
  const bool hasGuides = albedo != noisy.planes.end() && normal != noisy.planes.end();
  OidnImages images;
  images.resize(noisy.width, noisy.height);
  if (hasGuides) {
    std::transform(albedo->second.begin(), albedo->second.end(), images.albedo.begin(),
                   [](float v) { return std::clamp(finite(v), 0.0f, 1.0f); });
    std::transform(normal->second.begin(), normal->second.end(), images.normal.begin(),
                   [](float v) { return std::clamp(finite(v), -1.0f, 1.0f); });
  }
  try {
    impl_->colours(images, hasGuides, rgba);
    impl_->alpha(noisy, before, images, hasGuides, rgba);
  } catch (const live::OidnError& error) { throw RenderError(error.what()); }
  made.denoisedBy = name();
  made.note = fmt::format("denoised by {}, biased", name());
  return made;
}

} // namespace picture
