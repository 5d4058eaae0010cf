// picture.cpp: Implements the Python class Picture: planes are numpy arrays that share the
// picture's memory. [GIL held]
#include <cstring>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/files/atomic_file.h"
#include "libpicture/files/formats.h"
#include "libpicture/transport.h"
#include "merge.h"
#include "objects.h"
#include "picture_object.h"
#include "render_request.h"

const picture::Format& formatFor(const std::string& path) {
  const picture::Format* const format = picture::formatOf(path);
  if (!format)
    throw py::value_error(fmt::format("a file name with one of the suffixes {} expected, not {}",
                                      picture::formatSuffixes(), path));
  return *format;
}

void describePicture(py::dict& stats, const RTstats& s) {
  stats["transport"] = picture::transportName(s.transport.chosen);
  stats["transport_reason"] = s.transport.reason;
  stats["transport_leaves_out"] = picture::omittedLightNames(s);
  py::dict left; // the keys have the names of vv --stats
  left["cut_by_depth"] = s.leftOut.cutByDepth;
  left["cut_by_energy"] = s.leftOut.cutByEnergy;
  left["clipped"] = s.leftOut.clipped;
  left["unreached_lights"] = s.transport.unreachedLights;
  left["shader_faults"] = s.leftOut.shaderFaults;
  left["wrong_hits"] = s.rejected.hits;
  left["rejected_rays"] = s.rejected.rays;
  stats["left_out"] = left;
  if (s.error.pixels == 0) return; // no error estimate was requested
  stats["error_mean"] = s.error.mean;
  stats["error_mean_interval"] = s.error.meanInterval;
  stats["error_half_width"] = s.error.halfWidth;
  stats["error_p99"] = s.error.p99;
  stats["error_trusted"] = double(s.error.trusted) / double(s.error.pixels);
  stats["error_unmet"] = s.error.unmet;
  stats["error_method"] = s.error.method;
}

namespace {

// Returns the plane without a copy. The array keeps the picture alive, and save() saves what is
// written to it.
py::array floats(const py::object& self, const picture::Channel& channel) {
  picture::Picture& p = self.cast<PictureObject&>().picture;
  std::vector<py::ssize_t> shape{p.height, p.width};
  if (channel.components > 1) shape.push_back(channel.components);
  return py::array_t<float>(shape, p.planes.at(channel.bit).data(), self);
}

py::array counts(const picture::Picture& p, const picture::Channel& channel) {
  const std::vector<float>& plane = p.planes.at(channel.bit);
  py::array_t<uint32_t> array({p.height, p.width});
  for (size_t i = 0; i < plane.size(); ++i)
    array.mutable_data()[i] = plane[i] > 0 ? uint32_t(plane[i]) : 0;
  return array;
}

py::object rgba(const py::object& self) { return floats(self, *picture::findChannel("rgba")); }

py::object item(const py::object& self, const py::object& key) {
  if (!py::isinstance<py::str>(key)) return rgba(self)[key];
  const picture::Picture& p = self.cast<const PictureObject&>().picture;
  const std::string name = fromText(key);
  const picture::Channel* channel = picture::findPictureChannel(name);
  if (!channel || !p.planes.count(channel->bit)) {
    std::string known;
    for (const picture::Channel& one : picture::pictureChannels())
      if (p.planes.count(one.bit)) known += (known.empty() ? "" : ", ") + std::string(one.name);
    throw py::key_error(fmt::format("no channel {}; the picture has {}", name, known));
  }
  if (channel->isWhole) return counts(p, *channel);
  return floats(self, *channel);
}

py::array errorBars(const py::object& self) {
  const picture::Channel& channel = *picture::findChannel("error");
  const picture::Picture& picture = self.cast<const PictureObject&>().picture;
  if (!picture.denoisedBy.empty())
    throw py::attribute_error("the picture is denoised: error bars belong to the picture before");
  if (!picture.planes.count(channel.bit))
    throw py::attribute_error("the picture was made without error bars: render(error=0.02) or "
                              "channels=('error',) makes some");
  return floats(self, channel);
}

py::object asArray(const py::object& self, const py::object& type, const py::object& copy) {
  py::object array = rgba(self);
  if (!type.is_none() && !type.equal(array.attr("dtype"))) return array.attr("astype")(type);
  return !copy.is_none() && copy.cast<bool>() ? array.attr("copy")() : array;
}

py::array display(const PictureObject& self) {
  std::vector<uint8_t> bytes = picture::displayBytes(self.picture);
  py::array_t<uint8_t> array({self.picture.height, self.picture.width, 3});
  std::memcpy(array.mutable_data(), bytes.data(), bytes.size());
  return array;
}

void save(const PictureObject& self, const py::object& file) {
  const std::string path = toPath(file);
  const picture::Format& format = formatFor(path);
  if (!self.picture.denoisedBy.empty() && !format.keepsNote)
    throw py::value_error(fmt::format("{} files cannot say that they are denoised; {} files can",
                                      format.name,
                                      picture::formatsWith(&picture::Format::keepsNote)));
  std::string failure;
  {
    const ReleaseGil release;
    const std::string bytes = format.encode(self.picture);
    try {
      picture::writeFile(path, bytes);
    } catch (const std::runtime_error& error) { failure = error.what(); }
  }
  raiseOsError(failure);
}

py::tuple textsOf(const std::vector<std::string>& texts) {
  py::tuple out(texts.size());
  for (size_t i = 0; i < texts.size(); ++i) out[i] = toText(texts[i]);
  return out;
}

py::tuple names(const PictureObject& self) { return textsOf(self.picture.names); }

py::object nodes(PictureObject& self) {
  if (self.nodeList) return self.nodeList;
  py::tuple out(self.nodes.size());
  for (size_t i = 0; i < self.nodes.size(); ++i)
    out[i] = asNode(self.nodes[i].world(), self.nodes[i].node);
  return self.nodeList = out;
}

py::object camera(PictureObject& self) {
  const picture::Picture& made = self.picture;
  const bool isPart = made.wholeWidth > 0;
  if (!self.camera && self.place.fovy > 0) {
    self.camera = py::module_::import("xvrml._camera")
                      .attr("_of")(std::vector<double>(self.place.matrix, self.place.matrix + 16),
                                   self.place.fovy, isPart ? made.wholeWidth : made.width,
                                   isPart ? made.wholeHeight : made.height);
    if (isPart) self.camera = self.camera.attr("cropped")(made.left, made.top);
  }
  return self.camera ? self.camera : py::none();
}

py::tuple channels(const PictureObject& self) {
  py::list out;
  for (const picture::Channel& channel : picture::pictureChannels())
    if (self.picture.planes.count(channel.bit)) out.append(py::str(std::string(channel.name)));
  return py::tuple(out);
}

void setExposure(PictureObject& self, const py::object& given) {
  picture::Picture& shown = self.picture;
  const std::optional<double> stops = exposureOf(given);
  if (!shown.linear && (!stops || *stops != 0))
    throw py::value_error("exposure: the picture has no linear light (colour='vrml97')");
  shown.view.exposure = stops ? *stops : picture::fittingExposure(shown);
}

void setCurve(PictureObject& self, const std::string& name) {
  const picture::ViewCurve curve = curveOf(name);
  if (!self.picture.linear && curve != picture::ViewCurve::standard)
    throw py::value_error("view: the picture has no linear light (colour='vrml97')");
  self.picture.view.curve = curve;
}

constexpr int pickleVersion = 2;

[[noreturn]] void refusePickle() {
  throw py::value_error("this is no pickled Picture of this version");
}

// Returns references to all members. The compiler refuses a list in which one is missing.
template <class Facts> auto membersOf(Facts& facts) {
  auto& [width, height, linear, depthAlongRay, view, transparent, backdrop, wholeWidth, wholeHeight,
         left, top, names, note, denoisedBy] = facts;
  return std::tie(width, height, linear, depthAlongRay, view, transparent, backdrop, wholeWidth,
                  wholeHeight, left, top, names, note, denoisedBy);
}

// Convert members for pickles.
template <class T> py::object toPickle(const T& value) { return py::cast(value); }
py::object toPickle(const std::string& text) { return toText(text); }
py::object toPickle(const std::vector<std::string>& texts) { return textsOf(texts); }
py::object toPickle(const picture::ViewTransform& view) {
  return py::make_tuple(view.exposure, std::string(picture::curveName(view.curve)));
}

template <class T> void fromPickle(const py::handle& from, T& to) { to = from.cast<T>(); }
void fromPickle(const py::handle& from, std::string& to) {
  if (!py::isinstance<py::str>(from)) refusePickle();
  to = fromText(from);
}
void fromPickle(const py::handle& from, std::vector<std::string>& to) {
  if (!py::isinstance<py::tuple>(from)) refusePickle();
  for (const py::handle text : from) fromPickle(text, to.emplace_back());
}
void fromPickle(const py::handle& from, picture::ViewTransform& to) {
  const auto [exposure, curve] = from.cast<std::pair<py::object, py::object>>();
  std::string name;
  fromPickle(curve, name);
  to = {exposureOf(exposure).value_or(0), curveOf(name)};
}

// Checks what the rest of the program relies on.
void checkFacts(const picture::PictureFacts& facts) {
  constexpr int most = 65536;
  const auto lies = [](int begin, int size, int whole) {
    return begin >= 0 && whole <= most && begin <= whole - size;
  };
  const bool isWhole =
      facts.wholeWidth == 0 && facts.wholeHeight == 0 && facts.left == 0 && facts.top == 0;
  if (facts.width < 1 || facts.height < 1 || facts.width > most || facts.height > most ||
      !(isWhole || (lies(facts.left, facts.width, facts.wholeWidth) &&
                    lies(facts.top, facts.height, facts.wholeHeight))) ||
      (facts.note + facts.denoisedBy).find_first_of("\n\r") != std::string::npos)
    refusePickle();
}

// Returns the pickled members: version, facts, {channel name: numbers}, time, stats, camera.
py::tuple pickled(const py::object& self) {
  PictureObject& object = self.cast<PictureObject&>();
  const picture::PictureFacts& made = object.picture;
  const py::tuple facts = std::apply(
      [](const auto&... member) { return py::make_tuple(toPickle(member)...); }, membersOf(made));
  py::dict planes;
  for (const picture::Channel& channel : picture::pictureChannels())
    if (object.picture.planes.count(channel.bit))
      planes[py::str(std::string(channel.name))] = floats(self, channel);
  return py::make_tuple(pickleVersion, facts, planes, object.time, object.stats, camera(object));
}

picture::Picture unpickledPicture(const py::tuple& facts, const py::dict& planes) {
  picture::Picture made;
  const auto members = membersOf<picture::PictureFacts>(made);
  if (facts.size() != std::tuple_size_v<decltype(members)>) refusePickle();
  size_t next = 0;
  std::apply([&](auto&... member) { (fromPickle(facts[next++], member), ...); }, members);
  checkFacts(made);
  for (const auto& [name, numbers] : planes) {
    const picture::Channel* const channel = picture::findPictureChannel(fromText(name));
    const auto plane =
        py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(numbers);
    const auto pixels = size_t(made.width) * size_t(made.height);
    if (!channel || !plane || size_t(plane.size()) != pixels * size_t(channel->components))
      refusePickle();
    made.planes[channel->bit].assign(plane.data(), plane.data() + plane.size());
  }
  if (!made.planes.count(RT_RGBA)) refusePickle();
  return made;
}

PictureObject unpickled(const py::tuple& state) {
  if (state.size() != 6 || !py::isinstance<py::int_>(state[0]) ||
      state[0].cast<int>() != pickleVersion || !py::isinstance<py::tuple>(state[1]) ||
      !py::isinstance<py::dict>(state[2]) || !py::isinstance<py::dict>(state[4]))
    refusePickle();
  PictureObject object;
  try {
    object.picture = unpickledPicture(state[1], state[2]);
    object.time = state[3].cast<double>();
  } catch (const py::cast_error&) { refusePickle(); }
  object.stats = state[4];
  if (!state[5].is_none()) {
    if (!py::isinstance(state[5], py::module_::import("xvrml._camera").attr("Pinhole")))
      refusePickle();
    object.camera = state[5];
  }
  return object;
}

} // namespace

void definePicture(py::module_& module) {
  py::class_<PictureObject>(
      module, "Picture",
      "A rendered picture. picture['z'] is a channel; any other index applies to the colours.")
      .def_property_readonly(
          "array", rgba,
          "Red, green, blue, alpha: float32 of shape (height, width, 4), first row at the top.")
      .def_property_readonly(
          "error", errorBars,
          "Half-widths of the 95 % intervals of red, green, blue: float32 of shape (height, width, "
          "3). Only pictures rendered with error= or this channel have it.")
      .def_property_readonly(
          "camera", camera,
          "The camera as a Pinhole; None for other cameras (orthographic ones, ORTViewpoints).")
      .def_readonly("time", &PictureObject::time,
                    "The world time of the picture, in seconds since the world was loaded.")
      .def_property_readonly("display", display,
                             "The colours for a screen: uint8 of shape (height, width, 3).")
      .def_property_readonly("shape",
                             [](const PictureObject& self) {
                               return py::make_tuple(self.picture.height, self.picture.width, 4);
                             })
      .def_property_readonly("channels", channels, "Names of the channels.")
      .def_property_readonly(
          "nodes", nodes,
          "The Shape for each number of the channels 'id' and 'cryptomatte': "
          "picture.nodes[picture['id'][row, column]]; None for 0. Empty in pictures without these "
          "channels and in copied or pickled pictures, because nodes belong to the world.")
      .def_property_readonly(
          "names", names,
          "A name for each number of the channels 'id' and 'cryptomatte': the Shape's DEF name, "
          "otherwise that of the nearest group above it, otherwise 'Shape'; '' for 0.")
      .def_readonly("stats", &PictureObject::stats,
                    "Statistics of the render: counts, seconds and errors.")
      .def_property_readonly(
          "colour",
          [](const PictureObject& self) { return self.picture.linear ? "linear" : "vrml97"; })
      .def_property(
          "exposure", [](const PictureObject& self) { return self.picture.view.exposure; },
          setExposure,
          "The exposure of display, save() of files for screens, and films, in stops. 'auto' sets "
          "one that fits the picture. The array and EXR files keep the light as it is.")
      .def_property(
          "view",
          [](const PictureObject& self) {
            return std::string(picture::curveName(self.picture.view.curve));
          },
          setCurve, "The curve of the same: 'standard', 'filmic' or 'agx'.")
      .def("__getitem__", item)
      .def("__array__", asArray, py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def("save", save, py::arg("path"),
           ("Writes a file; the suffix (" + picture::formatSuffixes() + ") selects the format.")
               .c_str())
      .def(
          "coco",
          [](const py::object& self, const py::args& given, const py::kwargs& named) {
            return py::module_::import("xvrml._masks").attr("coco")(self, *given, **named);
          },
          "coco(image_id=1, file_name='', categories=None, compressed=False, first_id=1): returns "
          "the annotations of the Shapes in the picture in COCO's format (images, categories, "
          "annotations), from the channel 'id': bounding box, area and run lengths in pixels. "
          "categories: a dict or a function from the names of Shapes to categories; Shapes without "
          "one are left out; None: the name is the category. compressed: run lengths as "
          "pycocotools packs them in a text. first_id: the number of the first annotation.")
      .def(
          "matte",
          [](const py::object& self, const py::args& names) {
            return py::module_::import("xvrml._masks").attr("matte")(self, *names);
          },
          "matte(*names): returns the share of each pixel that Shapes of these names cover, from "
          "the channel 'cryptomatte': float32 of shape (height, width), 0 to 1. In pictures of a "
          "Context, names are numbers. A share is that of the samples that hit such a Shape first, "
          "also where it is clear.")
      .def("_repr_png_",
           [](const PictureObject& self) { return py::bytes(picture::encodePng(self.picture)); })
      .def(py::pickle(&pickled, &unpickled))
      .def("__repr__", [](const PictureObject& self) {
        const std::string& by = self.picture.denoisedBy;
        return fmt::format("<Picture {}x{}{}{}>", self.picture.width, self.picture.height,
                           by.empty() ? "" : ", denoised by ", by);
      });
}
