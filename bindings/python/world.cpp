// world.cpp: the Python class World: names, problems, writing, rendering. Called with the GIL held; parsing and rendering
// release it.
#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "cluster_object.h"
#include "objects.h"
#include "picture/atomic_file.h"
#include "picture/nearest.h"
#include "picture/transport.h"
#include "picture_object.h"

using namespace xvrml;

namespace {

const char* severityName(Severity severity) {
  switch (severity) {
  case Severity::note: return "note";
  case Severity::warning: return "warning";
  case Severity::error: break;
  }
  return "error";
}

// Runs `work` without the GIL while Ctrl-C is watched for: the watch that it gets ends the picture.
template <class Work> void interruptible(Work work) {
  bool signalled = false;
  std::exception_ptr failure;
  {
    py::gil_scoped_release release;
    try {
      work([&signalled](float) {
        if (signalled) return true;
        py::gil_scoped_acquire acquire;
        signalled = PyErr_CheckSignals() != 0;
        return signalled;
      });
    } catch (...) { failure = std::current_exception(); }
  }
  if (signalled) throw py::error_already_set();
  if (failure) std::rethrow_exception(failure);
}

py::object getNode(const WorldPtr& self, const std::string& name) {
  const auto& names = self->graph().scope.names;
  auto found = names.find(name);
  if (found != names.end()) return py::cast(NodeObject{self, found->second});
  std::vector<std::string> known;
  for (const auto& [one, node] : names) known.push_back(one);
  const std::string near = picture::nearest(name, known);
  throw py::key_error(fmt::format("no node is called {}{}", name, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

py::tuple names(const WorldPtr& self) {
  py::list out;
  for (const auto& [name, node] : self->graph().scope.names) out.append(toText(name));
  return py::tuple(out);
}

py::tuple roots(const WorldPtr& self) {
  py::list out;
  for (const NodeRef& root : self->graph().scope.roots) out.append(NodeObject{self, root});
  return py::tuple(out);
}

std::vector<Diagnostic> warnings(const WorldPtr& self) {
  auto lock = self->lock();
  return self->graph().diagnostics.list();
}

picture::RenderSettings withoutPicture() {
  picture::RenderSettings settings;
  settings.backend = "null";
  return settings;
}

std::vector<ViewpointInfo> viewpoints(const WorldPtr& self) {
  std::vector<ViewpointInfo> list;
  auto lock = self->lock();
  interruptible(
      [&](picture::Watch watch) { list = picture::Renderer(self->graph(), withoutPicture(), std::move(watch)).viewpoints(); });
  return list;
}

py::str toVrml(const WorldPtr& self) {
  auto lock = self->lock();
  return toText(writeWorld(self->graph()));
}

void writeTo(const WorldPtr& self, const py::object& file) {
  const std::string path = toPath(file);
  std::string failure;
  {
    auto lock = self->lock();
    try {
      picture::writeFile(path, writeWorld(self->graph()));
    } catch (const std::runtime_error& error) { failure = error.what(); }
  }
  if (failure.empty()) return;
  PyErr_SetString(PyExc_OSError, failure.c_str());
  throw py::error_already_set();
}

int inRange(const char* name, long long value, long long minimum, long long maximum) {
  if (value < minimum || value > maximum)
    throw py::value_error(fmt::format("{}: {} to {} expected, not {}", name, minimum, maximum, value));
  return int(value);
}

MapOptions::Headlight headlightOf(const py::object& value) {
  using Headlight = MapOptions::Headlight;
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? Headlight::on : Headlight::off;
  const std::string text = py::isinstance<py::str>(value) ? value.cast<std::string>() : "";
  if (text == "auto") return Headlight::automatic;
  if (text == "on" || text == "off") return text == "on" ? Headlight::on : Headlight::off;
  throw py::value_error("headlight: 'auto', 'on', 'off', True or False expected");
}

uint32_t channelsOf(const py::object& list) {
  uint32_t bits = RT_RGBA;
  const bool one = py::isinstance<py::str>(list);
  for (const py::handle name : one ? py::object(py::make_tuple(list)) : list) {
    const picture::Channel* channel = py::isinstance<py::str>(name) ? picture::findChannel(fromText(name)) : nullptr;
    if (!channel) {
      std::string known;
      for (const picture::Channel& c : picture::channelTable()) known += (known.empty() ? "" : ", ") + std::string(c.name);
      throw py::value_error(fmt::format("channels: out of {} expected, not {}", known, std::string(py::str(name))));
    }
    bits |= channel->bit;
  }
  return bits;
}

picture::LookAt cameraOf(const py::object& given) {
  picture::LookAt camera;
  double matrix[16];
  try {
    auto rows = given.cast<std::vector<std::vector<double>>>();
    if (rows.size() != 2 && rows.size() != 3) throw py::cast_error();
    double* targets[] = {camera.position, camera.target, camera.up};
    for (size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].size() != 3) throw py::cast_error();
      for (size_t k = 0; k < 3; ++k) {
        if (!std::isfinite(rows[i][k])) throw py::cast_error();
        targets[i][k] = rows[i][k];
      }
    }
  } catch (const py::cast_error&) {
    throw py::value_error("camera: (position, target) or (position, target, up) of 3 numbers each expected");
  }
  if (!picture::lookAtMatrix(camera, matrix)) throw py::value_error("camera: position and target are the same point");
  return camera;
}

// Index of the viewpoint asked for by name or number.
size_t viewpointIndex(const std::vector<ViewpointInfo>& list, const py::object& wanted) {
  if (py::isinstance<py::int_>(wanted) && !py::isinstance<py::bool_>(wanted)) {
    long long index = wanted.cast<long long>();
    if (index < 0) index += static_cast<long long>(list.size());
    if (index < 0 || index >= static_cast<long long>(list.size()))
      throw py::index_error(fmt::format("viewpoint: the world has {}", list.size()));
    return size_t(index);
  }
  if (!py::isinstance<py::str>(wanted)) throw py::type_error("viewpoint: a name, a number or None expected");
  const std::string name = fromText(wanted);
  const int index = picture::findViewpoint(list, name);
  if (index >= 0) return size_t(index);
  std::vector<std::string> known;
  for (const ViewpointInfo& v : list) known.push_back(v.name.empty() ? v.description : v.name);
  const std::string near = picture::nearest(name, known);
  throw py::key_error(
      fmt::format("viewpoint: the world has no {}{}", name, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

py::dict statsOf(const World& world, const picture::RenderResult& result) {
  const RTstats& s = result.stats;
  py::dict stats;
  stats["nodes"] = world.nodeCount;
  stats["shapes"] = result.map.shapes;
  stats["triangles"] = s.triangles;
  stats["unique_triangles"] = s.uniqueTriangles;
  stats["objects"] = s.objects;
  stats["instances"] = s.instances;
  stats["lights"] = s.lights;
  stats["textures"] = s.textures;
  stats["camera_rays"] = s.cameraRays;
  stats["shadow_rays"] = s.shadowRays;
  stats["secondary_rays"] = s.secondaryRays;
  stats["parse_seconds"] = world.times.parse;
  stats["map_seconds"] = result.mapSeconds;
  stats["build_seconds"] = s.commitSeconds + s.buildSeconds;
  stats["render_seconds"] = result.renderSeconds;
  stats["threads"] = s.threads;
  stats["transport"] = picture::transportName(s.transport);
  stats["transport_reason"] = s.transportReason;
  if (s.errorPixels > 0) {
    stats["error_mean"] = s.errorMean;
    stats["error_mean_interval"] = s.errorMeanInterval;
    stats["error_half_width"] = s.errorHalfWidth;
    stats["error_p99"] = s.errorP99;
    stats["error_trusted"] = double(s.errorTrusted) / double(s.errorPixels);
    stats["error_method"] = s.errorMethod;
  }
  return stats;
}

std::unique_ptr<PictureObject> render(const WorldPtr& self, const py::object& size, long long spp, const py::object& viewpoint,
                                      const py::object& camera, bool fit, std::optional<double> fov, long long seed,
                                      long long threads, bool shadows, const std::string& colour, const py::object& headlight,
                                      long long depth, const py::object& channels, const std::string& transport, double error,
                                      double timeLimit, double clamp, const py::object& cluster) {
  picture::RenderSettings settings;
  const auto sides = size.cast<std::vector<long long>>();
  if (sides.size() != 2) throw py::value_error("size: (width, height) expected");
  settings.width = inRange("size", sides[0], 1, 65536);
  settings.height = inRange("size", sides[1], 1, 65536);
  if (int64_t(settings.width) * settings.height > (int64_t(1) << 28)) throw py::value_error("size: at most 2^28 pixels expected");
  settings.samples = inRange("spp", spp, 1, 65536);
  settings.seed = inRange("seed", seed, 0, 2147483647);
  settings.threads = inRange("threads", threads, 0, 1024);
  settings.depth = inRange("depth", depth, 0, 10000);
  settings.shadows = shadows;
  if (colour != "linear" && colour != "vrml97")
    throw py::value_error("colour: 'linear' or 'vrml97' expected, not '" + colour + "'");
  settings.linear = colour == "linear";
  settings.headlight = headlightOf(headlight);
  const std::optional<int> following = picture::transportNamed(transport);
  if (!following) throw py::value_error(fmt::format("transport: {} expected, not '{}'", picture::transportNames, transport));
  settings.transport = *following;
  const auto limited = [](const char* name, double value, double maximum) {
    if (value >= 0 && value <= maximum) return value;
    throw py::value_error(fmt::format("{}: a number from 0 to {} expected", name, maximum));
  };
  settings.error = limited("error", error, 1);
  settings.timeLimit = limited("time_limit", timeLimit, 1e6);
  settings.clamp = limited("clamp", clamp, 1e30);
  settings.channels = channelsOf(channels);

  picture::View view;
  if (!viewpoint.is_none() + !camera.is_none() + fit > 1)
    throw py::value_error("only one of viewpoint, camera and fit can be used");
  if (fov && !(*fov > 0 && *fov < 180)) throw py::value_error("fov: an angle between 0 and 180 degrees expected");
  if (!camera.is_none()) view.lookAt = cameraOf(camera);
  view.fit = fit;
  view.fov = fov;

  settings.cluster = clusterFor(cluster, self); // before the lock: it may wait for another world
  picture::RenderResult result;
  auto lock = self->lock();
  std::shared_ptr<picture::Renderer> renderer;
  interruptible([&](picture::Watch watch) {
    renderer = self->renderer(settings, std::move(watch));
    renderer->setWatch({}); // what it refers to ends here
  });
  if (!viewpoint.is_none()) view.viewpoint = viewpointIndex(renderer->viewpoints(), viewpoint);
  interruptible([&](picture::Watch watch) {
    renderer->setWatch(std::move(watch));
    try {
      result = renderer->render(view);
    } catch (...) {
      renderer->setWatch({});
      throw;
    }
    renderer->setWatch({});
    renderer.reset();
  });
  auto made = std::make_unique<PictureObject>();
  made->stats = statsOf(self->graph(), result);
  made->picture = std::move(result.picture);
  return made;
}

py::array matrixOf(const ViewpointInfo& v) {
  py::array_t<double> matrix({4, 4}); // rows as on paper: column vectors
  for (size_t i = 0; i < 16; ++i) matrix.mutable_at(py::ssize_t(i % 4), py::ssize_t(i / 4)) = v.matrix[i];
  return matrix;
}

} // namespace

void defineWorld(py::module_& module) {
  py::class_<Diagnostic>(module, "Diagnostic", "A problem of a world, with its place.")
      .def_property_readonly("severity", [](const Diagnostic& d) { return severityName(d.severity); })
      .def_property_readonly("file", [](const Diagnostic& d) { return toText(d.file); })
      .def_readonly("line", &Diagnostic::line)
      .def_readonly("column", &Diagnostic::column)
      .def_property_readonly("message", [](const Diagnostic& d) { return toText(d.message); })
      .def("__str__", [](const Diagnostic& d) { return toText(d.text()); })
      .def("__repr__", [](const Diagnostic& d) { return toText("<" + d.text().substr(0, d.text().find('\n')) + ">"); });
  py::class_<ViewpointInfo>(module, "Viewpoint", "A viewpoint of a world.")
      .def_property_readonly(
          "name", [](const ViewpointInfo& v) { return toText(v.name); }, "DEF name, '' if it has none.")
      .def_property_readonly("description", [](const ViewpointInfo& v) { return toText(v.description); })
      .def_property_readonly("matrix", matrixOf, "Its local coordinates to world coordinates, 4x4 for column vectors.")
      .def("__repr__",
           [](const ViewpointInfo& v) { return toText("<Viewpoint " + (v.name.empty() ? v.description : v.name) + ">"); });
  py::class_<WorldObject, WorldPtr>(module, "World", "A loaded world. world['NAME'] is the node that DEF NAME names.")
      .def_property_readonly("path", [](const WorldPtr& self) { return toText(self->graph().path); })
      .def_property_readonly("warnings", warnings, "Every problem found so far, in order: errors too.")
      .def_property_readonly("names", names, "DEF names of the file.")
      .def_property_readonly("roots", roots, "Nodes of the file's top level.")
      .def_property_readonly("viewpoints", viewpoints, "Viewpoints in the order of the file.")
      .def("__getitem__", [](const WorldPtr& self, const py::str& name) { return getNode(self, fromText(name)); })
      .def("__contains__",
           [](const WorldPtr& self, const py::object& name) {
             return py::isinstance<py::str>(name) && self->graph().scope.names.count(fromText(name)) > 0;
           })
      .def("__iter__", [](const WorldPtr& self) { return py::iter(names(self)); })
      .def("__len__", [](const WorldPtr& self) { return self->graph().scope.names.size(); })
      .def("to_vrml", toVrml, "The world as VRML97 text.")
      .def("write", writeTo, py::arg("path"), "Writes the world as a VRML97 file.")
      .def("__repr__", [](const WorldPtr& self) { return toText("<World " + self->graph().path + ">"); })
      .def("render", render, py::arg("size") = py::make_tuple(800, 600), py::arg("spp") = 16, py::arg("viewpoint") = py::none(),
           py::arg("camera") = py::none(), py::arg("fit") = false, py::arg("fov") = py::none(), py::arg("seed") = 0,
           py::arg("threads") = 0, py::arg("shadows") = true, py::arg("colour") = "linear", py::arg("headlight") = "auto",
           py::arg("depth") = 25, py::arg("channels") = py::make_tuple("rgba"), py::arg("transport") = "auto",
           py::arg("error") = 0.0, py::arg("time_limit") = 0.0, py::arg("clamp") = 0.0, py::arg("cluster") = py::none(),
           "Renders the world as it is now: the scene is made anew for each picture, a Browser's is kept from one to the next. "
           "Options as "
           "those of the program vv.");
}
