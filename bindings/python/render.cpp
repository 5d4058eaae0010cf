// render.cpp: Implements World.render() and World.measure(): they render without the GIL, with
// Ctrl-C and progress callbacks. [GIL held]
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "cluster_object.h"
#include "libpicture/bare_model.h"
#include "libpicture/measure.h"
#include "numbers.h"
#include "parameters.h"
#include "picture_object.h"
#include "presets.h"
#include "quality_parameters.h"
#include "render_request.h"

using namespace xvrml;

namespace {

py::dict statsOf(const World& world, const picture::RenderResult& result) {
  const RTstats& s = result.stats;
  py::dict stats;
  stats["nodes"] = world.nodeCount;
  stats["shapes"] = result.map.shapes;
  stats["triangles"] = s.scene.triangles;
  stats["unique_triangles"] = s.scene.uniqueTriangles;
  stats["objects"] = s.scene.objects;
  stats["instances"] = s.scene.instances;
  stats["lights"] = s.scene.lights;
  stats["textures"] = s.scene.textures;
  stats["camera_rays"] = s.rays.camera;
  stats["shadow_rays"] = s.rays.shadow;
  stats["secondary_rays"] = s.rays.secondary;
  stats["parse_seconds"] = world.times.parse;
  stats["map_seconds"] = result.mapSeconds;
  stats["build_seconds"] = s.time.commit + s.time.build;
  stats["render_seconds"] = result.renderSeconds;
  stats["threads"] = s.machine.threads;
  describePicture(stats, s);
  return stats;
}

// A picture that is being made.
struct Making {
  const WorldPtr& world;
  const RenderArguments& given;
  RenderRequest request;
  py::object bar; // receives the progress
  picture::RenderResult result;

  // Renders without the GIL. The caller holds the world's lock and releases the renderer before it.
  void draw(std::shared_ptr<picture::Renderer>& renderer);
  // Converts the result, which may be unfinished.
  py::object picture();
  void closeBar() const {
    if (py::hasattr(bar, "close")) bar.attr("close")();
  }
};

void Making::draw(std::shared_ptr<picture::Renderer>& renderer) {
  const Drawing drawing(*world);
  if (given.viewpoint.is_none() && picture::mayLeaveCameraOut(world->graph(), request.view))
    request.view.authored = picture::View::Authored::unlessCut;
  interruptible([&](picture::ProgressCallback watch) {
    if (request.isLookOpen) {
      picture::choose(picture::lookOf(world->graph(), world->shadersGiven), request.settings);
      const picture::ViewTransform view = std::exchange(request.settings.view, {});
      if (request.shown.isPlain() && !request.fitExposure) request.shown = view;
    }
    renderer = world->renderer(request.settings, std::move(watch));
    renderer->setProgressCallback({}); // the callback's captures end here
  });
  if (!given.viewpoint.is_none())
    request.view.viewpoint = viewpointIndex(renderer->viewpoints(), given.viewpoint);
  interruptible(
      [&](picture::ProgressCallback watch) {
        renderer->setProgressCallback(std::move(watch));
        try {
          result = renderer->render(request.view);
        } catch (...) {
          renderer->setProgressCallback({});
          throw;
        }
        renderer->setProgressCallback({});
        renderer.reset();
      },
      bar);
}

py::object Making::picture() {
  auto made = std::make_unique<PictureObject>();
  made->stats = statsOf(world->graph(), result);
  made->time = world->browser() ? world->browser()->now() : 0;
  if (!result.hasCameraShader) made->place = result.camera;
  if (request.view.pinhole) made->camera = given.camera;
  if (const picture::Crop& crop = request.settings.crop; request.view.pinhole && crop.width > 0)
    made->camera = given.camera.attr("cropped")(crop.x, crop.y);
  made->picture = std::move(result.picture);
  made->picture.view = request.shown;
  if (request.fitExposure) made->picture.view.exposure = picture::fittingExposure(made->picture);
  made->nodes.reserve(result.nodes.size());
  for (xvrml::NodeRef& node : result.nodes) made->nodes.emplace_back(world, std::move(node));
  return py::cast(std::move(made));
}

// Gives shapes the shaders of a preset, unless the world has them from it.
void giveShaders(const WorldPtr& self, const std::string& preset,
                 const std::vector<std::string>& rules) {
  if (rules.empty() || self->presetGiven == preset) return;
  std::vector<picture::ShaderRule> all;
  for (const std::string& rule : rules) all.push_back({rule, "preset:", {}, true});
  applyRules(self, all);
  self->presetGiven = preset;
}

py::object render(const WorldPtr& self, const RenderArguments& asked) {
  RenderArguments given = asked;
  const std::vector<std::string> rules = applyPreset(given);
  Making making{self, given, requestOf(given), progressOf(given.progress), {}};
  giveShaders(self, given.preset.value_or(""), rules);
  // Look for the cluster before taking the lock, because this may wait for another world.
  making.request.settings.cluster = clusterFor(given.cluster, self);
  if (making.request.settings.cluster && given.isa != "auto")
    throw py::value_error("isa: a cluster has its own: xvrml.Cluster(isa=...) sets it");
  const auto lock = self->lockDrawing();
  if (self->isRenderingHere)
    throw picture::RenderError("a picture is being made: its progress cannot make another");
  std::shared_ptr<picture::Renderer> renderer;
  try {
    making.draw(renderer);
  } catch (py::error_already_set& stopped) {
    making.closeBar();
    // the finished part of the picture
    if (!making.result.picture.planes.empty()) stopped.value().attr("image") = making.picture();
    throw;
  }
  making.closeBar();
  return making.picture();
}

// Reads the ORTSensors of the world.
std::vector<picture::Measurement> measure(const WorldPtr& self, const RenderArguments& given) {
  constexpr long long samples = 4096; // as vv --measure
  RenderArguments arguments = given;
  const bool limited = given.quality[RT_TARGET_ERROR] > 0 || given.quality[RT_TIME_LIMIT] > 0;
  if (!arguments.spp && !limited) arguments.spp = samples;
  RenderRequest request = requestOf(arguments);
  const py::object bar = progressOf(given.progress);
  request.settings.cluster = clusterFor(given.cluster, self);
  const auto lock = self->lockDrawing();
  if (self->isRenderingHere)
    throw picture::RenderError("a picture is being made: its progress cannot measure");
  std::vector<picture::Measurement> sensors;
  {
    const Drawing drawing(*self);
    interruptible(
        [&](picture::ProgressCallback watch) {
          std::shared_ptr<picture::Renderer> renderer =
              self->renderer(request.settings, std::move(watch));
          try {
            sensors = renderer->measure(request.view);
          } catch (...) {
            renderer->setProgressCallback({});
            throw;
          }
          renderer->setProgressCallback({});
        },
        bar);
  }
  if (py::hasattr(bar, "close")) bar.attr("close")();
  return sensors;
}

// Python gets this for a Measurement: pickled objects have the statistics, not the struct of C.
struct MeasurementObject {
  picture::Measurement readings;
  py::dict stats;
};

std::vector<MeasurementObject> measureForPython(const WorldPtr& self,
                                                const RenderArguments& given) {
  std::vector<MeasurementObject> made;
  for (picture::Measurement& readings : measure(self, given)) {
    MeasurementObject object{std::move(readings), {}};
    describePicture(object.stats, object.readings.stats);
    made.push_back(std::move(object));
  }
  return made;
}

// Returns a copy of a vector as an array of rows and columns.
template <class T>
py::array_t<T> gridOf(const picture::Measurement& m, const std::vector<T>& values) {
  return py::array_t<T>({m.sensor.rows, m.sensor.columns}, values.data());
}

py::array_t<double> positionsOf(const picture::Measurement& m) {
  py::array_t<double> out({m.sensor.rows, m.sensor.columns, 3});
  for (int row = 0; row < m.sensor.rows; ++row)
    for (int column = 0; column < m.sensor.columns; ++column)
      m.sensor.pointAt(column, row, out.mutable_data(row, column, 0));
  return out;
}

using Place = std::array<double, 3>;
Place placeOf(const double (&from)[3]) { return {from[0], from[1], from[2]}; }

constexpr int pickleVersion = 2;

// Returns the pickled members: version, name, quantity, cells, first, column, row, direction,
// values, half-widths, trusted, samples, stats, outdoors.
py::tuple pickled(const MeasurementObject& object) {
  const picture::Measurement& m = object.readings;
  const picture::PlacedSensor& s = m.sensor;
  return py::make_tuple(pickleVersion, s.name, int(s.quantity), s.cells, placeOf(s.first),
                        placeOf(s.column), placeOf(s.row), placeOf(s.direction), gridOf(m, m.value),
                        gridOf(m, m.halfWidth), gridOf(m, m.trusted), gridOf(m, m.samples),
                        object.stats, m.outdoors);
}

MeasurementObject unpickled(const py::tuple& state) {
  const auto refuse = [] {
    throw py::value_error("this is no pickled Measurement of this version");
  };
  if (state.size() != 14 || !py::isinstance<py::int_>(state[0]) ||
      state[0].cast<int>() != pickleVersion)
    refuse();
  MeasurementObject object;
  picture::Measurement& m = object.readings;
  picture::PlacedSensor& s = m.sensor;
  try {
    s.name = state[1].cast<std::string>();
    const int quantity = state[2].cast<int>();
    if (quantity < 0 || quantity >= int(std::size(picture::quantityTable))) refuse();
    s.quantity = picture::Quantity(quantity);
    s.cells = state[3].cast<bool>();
    double(*const places[])[3] = {&s.first, &s.column, &s.row, &s.direction};
    for (size_t i = 0; i < 4; i++) {
      const auto place = state[4 + i].cast<Place>();
      std::copy(place.begin(), place.end(), *places[i]);
    }
    if (!py::isinstance<py::dict>(state[12])) refuse();
    object.stats = py::reinterpret_borrow<py::dict>(state[12]);
    m.outdoors = state[13].cast<double>();
  } catch (const py::cast_error&) { refuse(); }
  bool first = true;
  const auto take = [&](size_t member, auto& to) {
    using T = typename std::remove_reference_t<decltype(to)>::value_type;
    const auto grid =
        py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(state[member]);
    constexpr py::ssize_t most = 1 << 24; // the largest number of rows and of columns
    if (!grid || grid.ndim() != 2 || grid.shape(0) < 1 || grid.shape(1) < 1 ||
        grid.shape(0) > most || grid.shape(1) > most)
      refuse();
    if (first) {
      s.rows = int(grid.shape(0));
      s.columns = int(grid.shape(1));
    }
    if (grid.shape(0) != s.rows || grid.shape(1) != s.columns) refuse();
    first = false;
    to.assign(grid.data(), grid.data() + grid.size());
  };
  take(8, m.value);
  take(9, m.halfWidth);
  take(10, m.trusted);
  take(11, m.samples);
  return object;
}

} // namespace

py::object progressOf(const py::object& given) {
  if (given.is_none() || given.ptr() == Py_False) return py::none();
  if (given.ptr() == Py_True) return py::module_::import("xvrml._progress").attr("Bar")();
  if (PyCallable_Check(given.ptr())) return given;
  throw py::type_error(
      "progress: True, False, None or a function expected, not an object of the class " +
      typeName(given));
}

void interruptible(const std::function<void(picture::ProgressCallback watch)>& work,
                   const py::object& progress) {
  if (interpreterEnds()) throw std::runtime_error("the interpreter is ending");
  bool stopped = false, signalled = false;
  std::exception_ptr failure;
  {
    const ReleaseGil release;
    try {
      work([&](float done) {
        if (stopped) return true;
        const AcquireGil acquire;
        if (!acquire) return stopped = true;
        stopped = signalled = PyErr_CheckSignals() != 0;
        if (stopped || progress.is_none()) return stopped;
        try {
          progress(done);
        } catch (...) {
          failure = std::current_exception();
          stopped = true;
        }
        return stopped;
      });
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  if (signalled) throw py::error_already_set();
  if (failure) std::rethrow_exception(failure);
}

void defineMeasurement(py::module_& module) {
  using M = MeasurementObject;
  py::class_<M>(module, "Measurement",
                "The readings of one ORTSensor. Arrays have a row for each row of the sensor; each "
                "value lies within half_widths of the truth with a probability of 95 %.")
      .def_property_readonly("name", [](const M& m) { return m.readings.sensor.name; })
      .def_property_readonly(
          "quantity", [](const M& m) { return picture::infoOf(m.readings.sensor.quantity).name; })
      .def_property_readonly(
          "unit", [](const M& m) { return picture::infoOf(m.readings.sensor.quantity).unit; })
      .def_property_readonly("direction",
                             [](const M& m) {
                               const double* d = m.readings.sensor.direction;
                               return py::make_tuple(d[0], d[1], d[2]);
                             })
      .def_property_readonly("positions", [](const M& m) { return positionsOf(m.readings); })
      .def_property_readonly("values",
                             [](const M& m) { return gridOf(m.readings, m.readings.value); })
      .def_property_readonly("half_widths",
                             [](const M& m) { return gridOf(m.readings, m.readings.halfWidth); })
      .def_property_readonly(
          "trusted",
          [](const M& m) { return gridOf(m.readings, m.readings.trusted).attr("astype")("bool"); })
      .def_property_readonly("samples",
                             [](const M& m) { return gridOf(m.readings, m.readings.samples); })
      .def_property_readonly("stats", [](const M& m) { return m.stats; })
      .def_property_readonly(
          "outdoors", [](const M& m) { return m.readings.outdoors; },
          "Lux of a horizontal plane in the open, under an overcast sky; 0: there is none. Values "
          "over it are daylight factors.")
      .def("__repr__",
           [](const M& m) {
             return fmt::format("<xvrml.Measurement {}, {} x {} points>", m.readings.sensor.name,
                                m.readings.sensor.columns, m.readings.sensor.rows);
           })
      .def(py::pickle(&pickled, &unpickled));
}

void defineRender(py::object worldClass) {
  using A = RenderArguments;
  auto world = py::reinterpret_borrow<py::class_<WorldObject, WorldPtr>>(worldClass);
  defineMethod(
      world, "measure", measureForPython, parameterList(),
      parameterList(parameter("spp", &A::spp), qualityParameter<long long>(RT_SEED),
                    parameter("threads", &A::threads), qualityParameter<long long>(RT_MAX_DEPTH),
                    qualityParameter<std::string>(RT_TRANSPORT),
                    qualityParameter<double>(RT_TARGET_ERROR),
                    qualityParameter<double>(RT_TIME_LIMIT), parameter("cluster", &A::cluster),
                    parameter("progress", &A::progress), parameter("exact_shapes", &A::exactShapes),
                    parameter("point_size", &A::pointSize), parameter("line_width", &A::lineWidth),
                    parameter("sky", &A::sky)),
      "Reads the ORTSensors of the world in its current state and returns a list of "
      "Measurement, in the order of the file: lux, cd/m2 or UGR with 95 % intervals. The "
      "options are those of vv --measure. spp: samples per point (default 4096; with "
      "error and time_limit the maximum). error: the mean relative half-width at which "
      "sampling ends. sky: daylight, as --sky.");
  defineMethod(
      world, "render", render,
      parameterList(
          parameter("size", &A::size), parameter("spp", &A::spp),
          parameter("viewpoint", &A::viewpoint), parameter("camera", &A::camera),
          parameter("fit", &A::fit), parameter("fov", &A::fov),
          qualityParameter<long long>(RT_SEED), parameter("threads", &A::threads),
          qualityParameter<Switch>(RT_SHADOWS), parameter("colour", &A::colour),
          parameter("headlight", &A::headlight), qualityParameter<long long>(RT_MAX_DEPTH),
          parameter("channels", &A::channels), qualityParameter<std::string>(RT_TRANSPORT),
          qualityParameter<double>(RT_TARGET_ERROR), qualityParameter<double>(RT_TIME_LIMIT),
          qualityParameter<double>(RT_CLAMP), parameter("cluster", &A::cluster),
          parameter("progress", &A::progress), parameter("multiply_textures", &A::multiplyTextures),
          parameter("up", &A::up), parameter("background", &A::background),
          parameter("isa", &A::isa), qualityParameter<Switch>(RT_FOLLOW_IMAGES),
          qualityParameter<Switch>(RT_JITTER), qualityParameter<long long>(RT_LIGHT_STRIDE),
          parameter("exact_shapes", &A::exactShapes)),
      parameterList(parameter("exposure", &A::exposure), parameter("view", &A::view),
                    parameter("crop", &A::crop), qualityParameter<std::string>(RT_DEPTH_ALONG),
                    parameter("preset", &A::preset), parameter("studio", &A::studio),
                    parameter("from_", &A::from), parameter("ortho", &A::ortho),
                    parameter("raster", &A::raster), parameter("point_size", &A::pointSize),
                    parameter("line_width", &A::lineWidth), parameter("sky", &A::sky)),
      "Renders the world in its current state. While a world runs, the scene is kept between "
      "pictures. The options are those of the program vv. spp: samples per pixel (default 16); "
      "with error the maximum (default 4096), with time_limit too (default 65536). seed: 0 to "
      "2147483647, as in vv. channels: "
      "default rgba and z, with error also error and trust. camera: a Pinhole, a 4x4 matrix from "
      "camera to world (looking along -z, +y up), (position, target) or (position, target, up). "
      "fit: keeps only the direction of the camera and shows everything. ortho: shows a parallel "
      "view of this height, in units of the world. up: the axis that points "
      "up ('z', '-y' ...) in a world without a Viewpoint. background: 'none', a colour or a file. "
      "isa: instruction set of the ray kernels ('avx2', ...); machines give the same bytes with "
      "the same one. "
      "exposure (in stops, or 'auto') and view ('standard', 'filmic', 'agx'): how the picture is "
      "shown; Picture.exposure and Picture.view change them later. "
      "crop: (x, y, width, height), the part of the picture to make. depth_along: 'axis' or 'ray', "
      "what the channel z measures. "
      "preset: 'studio', 'product', 'technical' or 'pcb', as --preset of vv; the shaders that it "
      "gives to shapes stay. studio: light of a studio before a backdrop of this colour. from_: "
      "'three-quarter', 'front', 'top' ..., as --from. A model without light, viewpoint and "
      "background is shown before a grey backdrop; studio=False or background='black' leaves it. "
      "sky: daylight instead of the world's Background, as --sky of vv. "
      "raster: draws by a z-buffer instead of rays, for a first look at a large world, as "
      "--preview-raster of vv; the picture has the channel rgba alone. "
      "progress: True for a bar, or a function that is called with the fraction done. Ctrl-C "
      "raises KeyboardInterrupt, whose attribute image is the picture so far.");
}
