// render.cpp: Implements World.render(): checks the options and renders without the GIL, with
// Ctrl-C and progress callbacks. [GIL held]
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "cluster_object.h"
#include "libpicture/quality.h"
#include "libpicture/transport.h"
#include "numbers.h"
#include "picture_object.h"

using namespace xvrml;

namespace {

// Checks a value against the range that the library gives a quality setting (RT_*).
int inRange(const char* name, RTenum quality, long long value) {
  const RTqualityInfo info = picture::qualityInfo(quality);
  if (!picture::isQualityInRange(quality, double(value)))
    throw py::value_error(fmt::format("{}: {:.10g} to {:.10g} expected, not {}", name, info.minimum,
                                      info.maximum, value));
  return int(value);
}

int inRange(const char* name, long long value, long long minimum, long long maximum) {
  if (value < minimum || value > maximum)
    throw py::value_error(
        fmt::format("{}: {} to {} expected, not {}", name, minimum, maximum, value));
  return int(value);
}

std::string typeOf(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

// Returns width and height, any whole numbers.
std::pair<long long, long long> sizeOf(const py::object& size) {
  try {
    const auto sides = size.cast<std::vector<long long>>();
    if (sides.size() == 2) return {sides[0], sides[1]};
  } catch (const py::cast_error&) {}
  const std::string text = "size: (width, height) expected, whole numbers from 1 to 65536, not " +
                           std::string(py::repr(size));
  if (py::isinstance<py::str>(size) || !PySequence_Check(size.ptr())) throw py::type_error(text);
  throw py::value_error(text);
}

MapOptions::Headlight headlightOf(const py::object& value) {
  using Headlight = MapOptions::Headlight;
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? Headlight::on : Headlight::off;
  const std::string text = py::isinstance<py::str>(value) ? value.cast<std::string>() : "";
  if (text == "auto") return Headlight::automatic;
  if (text == "on" || text == "off") return text == "on" ? Headlight::on : Headlight::off;
  throw py::value_error("headlight: 'auto', 'on', 'off', True or False expected");
}

// Converts a pose: a camera-to-world matrix that looks along -z with +y up, as in VRML.
picture::LookAt posed(const std::vector<std::vector<double>>& rows) {
  picture::LookAt camera;
  camera.saysUp = true;
  double products[3][3] = {}, last = 0;
  for (size_t i = 0; i < 4; ++i) {
    if (rows[i].size() != 4) throw py::cast_error();
    for (size_t k = 0; k < 4; ++k)
      if (!std::isfinite(rows[i][k])) throw py::cast_error();
    last = std::max(last, std::abs(rows[3][i] - (i == 3 ? 1 : 0)));
  }
  double off = last;
  for (size_t a = 0; a < 3; ++a)
    for (size_t b = 0; b < 3; ++b) {
      for (size_t i = 0; i < 3; ++i) products[a][b] += rows[i][a] * rows[i][b];
      off = std::max(off, std::abs(products[a][b] - (a == b ? 1 : 0)));
    }
  double handed = 0;
  for (size_t i = 0; i < 3; ++i)
    handed += rows[i][0] * (rows[(i + 1) % 3][1] * rows[(i + 2) % 3][2] -
                            rows[(i + 2) % 3][1] * rows[(i + 1) % 3][2]);
  if (off > 1e-4 || handed < 0)
    throw py::value_error(
        "camera: the 4x4 matrix must turn and move only, with 0 0 0 1 as its last row");
  for (size_t i = 0; i < 3; ++i) {
    camera.position[i] = rows[i][3];
    camera.target[i] = rows[i][3] - rows[i][2];
    camera.up[i] = rows[i][1];
  }
  return camera;
}

// Returns whether an array is a rotation, which gives a camera's direction but not its position.
bool isRotation(const py::object& given, const std::vector<std::vector<double>>& rows) {
  if (rows.size() != 3 || !py::isinstance<py::array>(given)) return false;
  double off = 0;
  for (size_t a = 0; a < 3; ++a)
    for (size_t b = 0; b < 3; ++b) {
      double product = 0;
      for (size_t i = 0; i < 3; ++i) product += rows[a].at(i) * rows[b].at(i);
      off = std::max(off, std::abs(product - (a == b ? 1 : 0)));
    }
  return off < 1e-4;
}

picture::LookAt cameraOf(const py::object& given) {
  picture::LookAt camera;
  double matrix[16];
  try {
    auto rows = given.cast<std::vector<std::vector<double>>>();
    if (rows.size() == 4) return posed(rows);
    if (rows.size() != 2 && rows.size() != 3) throw py::cast_error();
    for (const auto& row : rows)
      if (row.size() != 3) throw py::cast_error();
    if (isRotation(given, rows))
      throw py::value_error(
          "camera: a 3x3 rotation does not say where the camera stands: a 4x4 matrix from camera "
          "to world expected; position, target and up are given as a tuple");
    camera.saysUp = rows.size() == 3;
    double* targets[] = {camera.position, camera.target, camera.up};
    for (size_t i = 0; i < rows.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) {
        if (!std::isfinite(rows[i][k])) throw py::cast_error();
        targets[i][k] = rows[i][k];
      }
    }
  } catch (const py::cast_error&) {
    throw py::value_error("camera: a Pinhole, a 4x4 matrix from camera to world, or (position, "
                          "target) or (position, target, up) of 3 numbers each expected, not " +
                          shown(given));
  }
  if (!picture::lookAtMatrix(camera, matrix))
    throw py::value_error("camera: position and target are the same point");
  return camera;
}

// Converts a Pinhole (xvrml/_camera.py). The rays of a symmetric camera with square pixels and the
// same focal length fy are sheared to those of the Pinhole.
picture::View::Pinhole pinholeOf(const py::object& given, int width, int height) {
  const auto [numbers, pose] =
      given.attr("_numbers")().cast<std::pair<std::array<double, 5>, std::array<double, 16>>>();
  const auto [fx, fy, cx, cy, skew] = numbers;
  picture::View::Pinhole camera{};
  camera.fovy = 2 * std::atan(height / 2.0 / fy);
  const double up = (cy - height / 2.0) / fy, right = (width / 2.0 - cx) / fx + skew / fx * up;
  for (size_t i = 0; i < 3; ++i) { // the pose's y points down and its z forward
    const double x = pose[4 * i], y = -pose[4 * i + 1], z = -pose[4 * i + 2];
    const double columns[] = {x, y, z, pose[4 * i + 3]};
    const double sheared[] = {x * fy / fx, y + x * skew / fx, z - x * right - y * up,
                              pose[4 * i + 3]};
    for (size_t k = 0; k < 4; ++k) {
      camera.matrix[4 * k + i] = columns[k];
      camera.sheared[4 * k + i] = sheared[k];
    }
  }
  camera.matrix[15] = camera.sheared[15] = 1;
  return camera;
}

// Converts depths from the picture's centre direction to the view axis. They differ if the
// principal point is off-centre.
void measureAlongAxis(const picture::View::Pinhole& camera, picture::Picture& picture) {
  const std::vector<float>& position = picture.planes.at(RT_POSITION);
  std::vector<float>& depth = picture.planes.at(RT_DEPTH);
  const double* m = camera.matrix;
  for (size_t i = 0; i < depth.size(); ++i) {
    if (!std::isfinite(depth[i])) continue;
    double along = 0;
    for (size_t k = 0; k < 3; ++k) along -= (double(position[3 * i + k]) - m[12 + k]) * m[8 + k];
    depth[i] = float(along);
  }
}

picture::Background backgroundOf(const py::object& given) {
  if (given.is_none()) return {};
  std::string text;
  if (py::isinstance<py::str>(given)) {
    text = fromText(given);
  } else if (py::hasattr(given, "__fspath__")) {
    text = toPath(given);
  } else {
    try {
      const auto rgb = given.cast<std::array<double, 3>>();
      text = fmt::format("{},{},{}", rgb[0], rgb[1], rgb[2]);
    } catch (const py::cast_error&) {
      throw py::value_error(fmt::format("background: {} expected", picture::backgroundForms));
    }
  }
  try {
    return picture::readBackground(text);
  } catch (const std::invalid_argument& error) {
    throw py::value_error(std::string("background: ") + error.what());
  }
}

// Returns the index of the viewpoint with this name or number.
size_t viewpointIndex(const std::vector<ViewpointInfo>& list, const py::object& wanted) {
  if (py::isinstance<py::int_>(wanted) && !py::isinstance<py::bool_>(wanted)) {
    int overflow = 0;
    long long index = PyLong_AsLongLongAndOverflow(wanted.ptr(), &overflow);
    if (index < 0) index += static_cast<long long>(list.size());
    if (overflow || index < 0 || index >= static_cast<long long>(list.size()))
      throw py::index_error(fmt::format("viewpoint: the world has {}", list.size()));
    return size_t(index);
  }
  if (!py::isinstance<py::str>(wanted))
    throw py::type_error("viewpoint: a name, a number or None expected");
  const std::string name = fromText(wanted);
  const int index = picture::findViewpoint(list, name);
  if (index >= 0) return size_t(index);
  std::vector<std::string> known;
  for (const ViewpointInfo& v : list) known.push_back(v.name.empty() ? v.description : v.name);
  throw py::key_error(
      fmt::format("viewpoint: the world has no {}{}", name, didYouMean(name, known)));
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
  describePicture(stats, s);
  return stats;
}

py::object render(const WorldPtr& self, const py::object& size, std::optional<long long> spp,
                  const py::object& viewpoint, const py::object& camera, bool fit,
                  std::optional<double> fov, long long seed, long long threads, bool shadows,
                  const std::string& colour, const py::object& headlight, long long depth,
                  const py::object& channels, const std::string& transport, double error,
                  double timeLimit, double clamp, const py::object& cluster,
                  const py::object& progress, bool multiplyTextures,
                  const std::optional<std::string>& up, const py::object& background) {
  picture::RenderSettings settings;
  settings.multiplyTextures = multiplyTextures;
  const auto [width, height] = sizeOf(size);
  settings.width = inRange("size", width, 1, 65536);
  settings.height = inRange("size", height, 1, 65536);
  if (int64_t(settings.width) * settings.height > (int64_t(1) << 28))
    throw py::value_error("size: at most 2^28 pixels expected");
  settings.seed = inRange("seed", seed, 0, 2147483647);
  settings.threads = inRange("threads", threads, 0, 1024);
  settings.depth = inRange("depth", RT_MAX_DEPTH, depth);
  settings.shadows = shadows;
  if (colour != "linear" && colour != "vrml97")
    throw py::value_error("colour: 'linear' or 'vrml97' expected, not '" + colour + "'");
  settings.linear = colour == "linear";
  settings.headlight = headlightOf(headlight);
  const std::optional<int> following = picture::transportNamed(transport);
  if (!following)
    throw py::value_error(
        fmt::format("transport: {} expected, not '{}'", picture::transportNames(), transport));
  settings.transport = *following;
  const auto limited = [](const char* name, RTenum quality, double value) {
    if (picture::isQualityInRange(quality, value)) return value;
    throw py::value_error(fmt::format("{}: {} expected", name, picture::qualityRange(quality)));
  };
  settings.error = limited("error", RT_TARGET_ERROR, error);
  settings.timeLimit = limited("time_limit", RT_TIME_LIMIT, timeLimit);
  settings.clamp = limited("clamp", RT_CLAMP, clamp);
  const long long most = settings.timeLimit > 0 ? 65536
                         : settings.error > 0   ? 4096
                                                : settings.samples;
  settings.samples = inRange("spp", RT_SAMPLES_PER_PIXEL, spp.value_or(most));
  settings.channels =
      channels.is_none()
          ? uint32_t(RT_RGBA | RT_DEPTH | (settings.error > 0 ? RT_ERROR | RT_TRUST : 0))
          : channelsOf(channels);

  settings.progressive = picture::isWorthProgressive(settings);

  picture::View view;
  const bool pinhole = py::hasattr(camera, "_numbers");
  if (!viewpoint.is_none() && (!camera.is_none() || fit))
    throw py::value_error("viewpoint: not with camera or fit, which look from elsewhere");
  if (pinhole && (fit || fov))
    throw py::value_error("camera: a Pinhole says all of the view: not with fit or fov");
  if (fov && !(*fov > 0 && *fov < 180))
    throw py::value_error("fov: an angle between 0 and 180 degrees expected");
  if (pinhole)
    view.pinhole = pinholeOf(camera, settings.width, settings.height);
  else if (!camera.is_none())
    view.lookAt = cameraOf(camera);
  if (up && !(view.up = picture::axisNamed(*up)))
    throw py::value_error("up: 'x', 'y', 'z', '-x', '-y' or '-z' expected, not '" + *up + "'");
  settings.background = backgroundOf(background);
  const uint32_t wanted = settings.channels;
  if (pinhole && (wanted & RT_DEPTH)) settings.channels |= RT_POSITION;
  view.fit = fit;
  view.fov = fov;

  const py::object bar = progressOf(progress);
  settings.cluster = clusterFor(cluster, self); // before the lock: it may wait for another world
  picture::RenderResult result;
  const auto lock = self->lockDrawing();
  if (self->isRenderingHere)
    throw picture::RenderError("a picture is being made: its progress cannot make another");
  struct Drawing { // meanwhile changes by this thread are rejected, and those of other threads wait
    WorldObject& world;
    explicit Drawing(WorldObject& w) : world(w) { world.isRenderingHere = true; }
    ~Drawing() { world.isRenderingHere = false; }
  };
  const auto pictureOf = [&] {
    auto made = std::make_unique<PictureObject>();
    made->stats = statsOf(self->graph(), result);
    made->time = self->browser() ? self->browser()->now() : 0;
    if (view.pinhole && (wanted & RT_DEPTH)) measureAlongAxis(*view.pinhole, result.picture);
    if (!(wanted & RT_POSITION)) result.picture.planes.erase(RT_POSITION);
    if (!result.hasCameraShader) made->place = result.camera;
    if (pinhole) made->camera = camera;
    made->picture = std::move(result.picture);
    made->nodes.reserve(result.nodes.size());
    for (xvrml::NodeRef& node : result.nodes) made->nodes.emplace_back(self, std::move(node));
    return py::cast(std::move(made));
  };
  std::shared_ptr<picture::Renderer> renderer;
  try {
    const Drawing drawing(*self);
    interruptible([&](picture::ProgressCallback watch) {
      renderer = self->renderer(settings, std::move(watch));
      renderer->setProgressCallback({}); // the callback's captures end here
    });
    if (!viewpoint.is_none()) view.viewpoint = viewpointIndex(renderer->viewpoints(), viewpoint);
    interruptible(
        [&](picture::ProgressCallback watch) {
          renderer->setProgressCallback(std::move(watch));
          try {
            result = renderer->render(view);
          } catch (...) {
            renderer->setProgressCallback({});
            throw;
          }
          renderer->setProgressCallback({});
          renderer.reset();
        },
        bar);
  } catch (py::error_already_set& stopped) {
    if (py::hasattr(bar, "close")) bar.attr("close")();
    // the finished part of the picture
    if (!result.picture.planes.empty()) stopped.value().attr("image") = pictureOf();
    throw;
  }
  if (py::hasattr(bar, "close")) bar.attr("close")();
  return pictureOf();
}

} // namespace

uint32_t channelsOf(const py::object& list) {
  uint32_t bits = RT_RGBA;
  const bool one = py::isinstance<py::str>(list);
  if (!one && !PySequence_Check(list.ptr()) && !PyAnySet_Check(list.ptr()))
    throw py::type_error("channels: a name or several expected, not an object of the class " +
                         typeOf(list));
  for (const py::handle name : one ? py::object(py::make_tuple(list)) : list) {
    const picture::Channel* channel =
        py::isinstance<py::str>(name) ? picture::findChannel(fromText(name)) : nullptr;
    if (!channel) {
      std::string known;
      for (const picture::Channel& c : picture::channelTable())
        known += (known.empty() ? "" : ", ") + std::string(c.name);
      throw py::value_error(
          fmt::format("channels: out of {} expected, not {}", known, std::string(py::str(name))));
    }
    bits |= channel->bit;
  }
  return bits;
}

py::object progressOf(const py::object& given) {
  if (given.is_none() || given.ptr() == Py_False) return py::none();
  if (given.ptr() == Py_True) return py::module_::import("xvrml._progress").attr("Bar")();
  if (PyCallable_Check(given.ptr())) return given;
  throw py::type_error(
      "progress: True, False, None or a function expected, not an object of the class " +
      typeOf(given));
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

void defineRender(py::object worldClass) {
  auto world = py::reinterpret_borrow<py::class_<WorldObject, WorldPtr>>(worldClass);
  world.def(
      "render", render, py::arg("size") = py::make_tuple(800, 600), py::arg("spp") = py::none(),
      py::arg("viewpoint") = py::none(), py::arg("camera") = py::none(), py::arg("fit") = false,
      py::arg("fov") = py::none(), py::arg("seed") = 0, py::arg("threads") = 0,
      py::arg("shadows") = true, py::arg("colour") = "linear", py::arg("headlight") = "auto",
      py::arg("depth") = 25, py::arg("channels") = py::none(), py::arg("transport") = "auto",
      py::arg("error") = 0.0, py::arg("time_limit") = 0.0, py::arg("clamp") = 0.0,
      py::arg("cluster") = py::none(), py::arg("progress") = py::none(),
      py::arg("multiply_textures") = false, py::arg("up") = py::none(),
      py::arg("background") = py::none(),
      "Renders the world as it is now; of one that runs, the scene is kept from one picture to the "
      "next. Options as those of the program vv. spp: samples a pixel, 16; with an error at most "
      "so many, 4096; with a time limit 65536. channels: rgba and z, and with an error also error "
      "and trust. progress: True for a bar, or a function that is called with the fraction done. "
      "Ctrl-C raises KeyboardInterrupt; its attribute image is what was finished. camera: a "
      "Pinhole, a 4x4 matrix from camera to world (looking along -z, +y up), or (position, target) "
      "or (position, target, up); with fit only its direction counts. up: the axis that is up "
      "('z', '-y' ...) in a world without Viewpoint. background: 'none', a colour or a file.");
}
