// denoise.cpp: Implements Picture.denoised(), denoise() for arrays, and the list of optional
// features. [GIL held]
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/denoiser.h"
#include "libpicture/doubt.h"
#include "libpicture/features.h"
#include "libpicture/live/oidn.h"
#include "numbers.h"
#include "picture_object.h"

namespace {

// Denoises without the GIL.
picture::Picture run(const picture::Picture& noisy, long long threads) {
  if (threads < 0 || threads > 1024)
    throw py::value_error(fmt::format("threads: 0 to 1024 expected, not {}", threads));
  const ReleaseGil release;
  return picture::PictureDenoiser(int(threads)).denoised(noisy);
}

void refuseInfinite(const std::vector<float>& plane, const char* name) {
  for (const float v : plane)
    if (!std::isfinite(v))
      throw py::value_error(fmt::format("{}: finite numbers expected, not {}", name, v));
}

void needErrorBars(const picture::Picture& picture) {
  if (!picture.denoisedBy.empty())
    throw py::value_error("the picture is denoised: its error bars belong to the picture before");
  for (const char* const name : {"error", "trust"})
    if (!picture.planes.count(picture::findChannel(name)->bit))
      throw py::value_error(fmt::format("the picture has no channel {}, which doubt needs: "
                                        "render(channels=('error', 'trust'))",
                                        name));
}

py::object denoised(const PictureObject& self, long long threads, bool audit) {
  if (!self.picture.denoisedBy.empty()) throw py::value_error("the picture is denoised already");
  for (const char* const name : {"albedo", "normal"})
    if (!self.picture.planes.count(picture::findChannel(name)->bit))
      throw py::value_error(fmt::format("the picture has no channel {}, which denoising needs: "
                                        "render(channels=('albedo', 'normal'))",
                                        name));
  if (audit) needErrorBars(self.picture);
  refuseInfinite(picture::rgbaOf(self.picture), "colours");
  auto made = std::make_unique<PictureObject>();
  made->picture = run(self.picture, threads);
  for (const NodeObject& node : self.nodes) made->nodes.push_back(node);
  made->time = self.time;
  made->place = self.place;
  made->camera = self.camera;
  for (const auto& [key, value] : self.stats) // the error is that of the picture before
    if (!fromText(key).starts_with("error_")) made->stats[key] = value;
  made->stats["denoised_by"] = made->picture.denoisedBy;
  if (audit) {
    std::vector<float> doubt = picture::doubtOf(self.picture, picture::rgbaOf(made->picture));
    const picture::DoubtCounts counts = picture::countDoubt(doubt);
    made->stats["doubt_judged"] = counts.judged;
    made->stats["doubt_share"] =
        counts.judged ? py::object(py::float_(counts.share())) : py::none();
    made->picture.planes[picture::doubtBit] = std::move(doubt);
  }
  return py::cast(std::move(made));
}

py::array doubt(const PictureObject& self, const py::object& colours) {
  needErrorBars(self.picture);
  const py::array_t<float> image = imageArray(colours, "colours", true);
  const picture::Picture& raw = self.picture;
  if (image.shape(0) != raw.height || image.shape(1) != raw.width)
    throw py::value_error(fmt::format("colours: an array of the size of the picture expected, "
                                      "{}x{}, not {}x{}",
                                      raw.width, raw.height, image.shape(1), image.shape(0)));
  const std::vector<float> made = picture::doubtOf(raw, rgbaOfImage(image));
  py::array_t<float> out({raw.height, raw.width});
  std::copy(made.begin(), made.end(), out.mutable_data());
  return out;
}

void addGuide(picture::Picture& picture, const char* name, const py::object& given) {
  const py::array_t<float> image = imageArray(given, name, false);
  if (image.shape(0) != picture.height || image.shape(1) != picture.width)
    throw py::value_error(fmt::format("{}: an array of the size of colour expected, {}x{}, not "
                                      "{}x{}",
                                      name, picture.width, picture.height, image.shape(1),
                                      image.shape(0)));
  std::vector<float>& plane = picture.planes[picture::findChannel(name)->bit];
  plane.assign(image.data(), image.data() + image.size());
  refuseInfinite(plane, name);
}

py::array denoise(const py::object& colour, const py::object& albedo, const py::object& normal,
                  long long threads) {
  const py::array_t<float> image = imageArray(colour, "colour", true);
  if (albedo.is_none() != normal.is_none())
    throw py::value_error("albedo and normal: both or none expected");
  const auto components = size_t(image.shape(2));
  picture::Picture noisy;
  noisy.transparent = components == 4;
  noisy.height = int(image.shape(0));
  noisy.width = int(image.shape(1));
  noisy.planes[RT_RGBA] = rgbaOfImage(image);
  refuseInfinite(noisy.planes[RT_RGBA], "colour");
  if (!albedo.is_none()) {
    addGuide(noisy, "albedo", albedo);
    addGuide(noisy, "normal", normal);
  }
  const picture::Picture made = run(noisy, threads);
  py::array_t<float> out({image.shape(0), image.shape(1), image.shape(2)});
  const std::vector<float>& result = picture::rgbaOf(made);
  float* to = out.mutable_data();
  for (size_t i = 0; i < result.size(); i += 4, to += components)
    std::copy_n(&result[i], components, to);
  return out;
}

py::list features() {
  std::vector<picture::Feature> rows;
  {
    const ReleaseGil release;
    rows = picture::listFeatures();
  }
  py::list out;
  for (const picture::Feature& row : rows)
    out.append(py::make_tuple(toText(row.name), toText(row.text), row.available, toText(row.detail),
                              toText(row.file), toText(row.how)));
  return out;
}

} // namespace

void defineDenoise(py::module_& module) {
  py::reinterpret_borrow<py::class_<PictureObject>>(module.attr("Picture"))
      .def("denoised", denoised, py::kw_only(), py::arg("threads") = 0, py::arg("audit") = false,
           "Returns the picture without noise, by Open Image Denoise 2, which must be installed "
           "(pip install xvrml[denoise]). The picture needs the channels albedo and normal. The "
           "result is biased; it says so in repr(), stats and files, and has no error bars. With "
           "audit "
           "it has the channel 'doubt' (see doubt()), and stats has doubt_judged and doubt_share; "
           "the picture then needs the channels error and trust, too.")
      .def("doubt", doubt, py::arg("colours"),
           "Returns how far denoised colours leave the error bars of this picture, for colours of "
           "any denoiser: float32 of shape (height, width), in half-widths of the 99 % interval, "
           "at most 99. Above 1 they are doubtful; -1: the pixel has no error bars that can be "
           "trusted. The picture needs the channels error and trust. colours: radiance of shape "
           "(height, width, 3) or (height, width, 4), such as a Picture.")
      .def_property_readonly(
          "note", [](const PictureObject& self) { return toText(self.picture.note); },
          "What files say about the picture: how it was denoised; '' if it is as it was rendered.");
  module.def("denoise", denoise, py::arg("colour"), py::arg("albedo") = py::none(),
             py::arg("normal") = py::none(), py::kw_only(), py::arg("threads") = 0,
             "Returns an image without noise, by Open Image Denoise 2: float32 of the shape of "
             "colour. colour: radiance in any unit, of shape (height, width, 3), or with alpha "
             "(height, width, 4), which is premultiplied. albedo: reflectances from 0 to 1, and "
             "normal: vectors of length 0 to 1, of shape (height, width, 3); without them textures "
             "become blurred.");
  module.def("_features", features);
  module.def("_look_in",
             [](const py::object& folder) { picture::live::OidnLibrary::lookIn(toPath(folder)); });
}
