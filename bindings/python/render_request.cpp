#include "render_request.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/quality.h"
#include "numbers.h"
#include "picture_object.h"
#include "picture_size.h"
#include "quality_parameters.h"

using namespace xvrml;

namespace {

int inRange(const char* name, long long value, long long minimum, long long maximum) {
  if (value < minimum || value > maximum)
    throw py::value_error(
        fmt::format("{}: {} to {} expected, not {}", name, minimum, maximum, value));
  return int(value);
}

// Returns width and height, any whole numbers.
std::pair<long long, long long> sizeOf(const py::object& size) {
  // without conversion: it would truncate the fractions of NumPy
  py::detail::make_caster<std::vector<long long>> sides;
  if (sides.load(size, false)) {
    const auto& found = py::detail::cast_op<const std::vector<long long>&>(sides);
    if (found.size() == 2) return {found[0], found[1]};
  }
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
  double numbers[16];
  for (size_t i = 0; i < 4; ++i) {
    if (rows[i].size() != 4) throw py::cast_error();
    for (size_t k = 0; k < 4; ++k) {
      if (!std::isfinite(rows[i][k])) throw py::cast_error();
      numbers[4 * i + k] = rows[i][k];
    }
  }
  try {
    return picture::lookAtOf(numbers);
  } catch (const std::invalid_argument& error) {
    throw py::value_error(std::string("camera: ") + error.what());
  }
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

// Converts a Pinhole (xvrml/_camera.py).
picture::View::Pinhole pinholeOf(const py::object& given, int width, int height) {
  const auto [numbers, pose] =
      given.attr("_numbers")().cast<std::pair<std::array<double, 5>, std::array<double, 16>>>();
  const auto [fx, fy, cx, cy, skew] = numbers;
  double matrix[16] = {};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 4; ++k) // the pose's y points down and its z forward
      matrix[4 * k + i] = (k == 1 || k == 2 ? -1 : 1) * pose[4 * i + k];
  matrix[15] = 1;
  return picture::pinholeOf({fx, fy, cx, cy, skew}, matrix, width, height);
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

// --- The table ---

using Given = RenderArguments;
using Settings = picture::RenderSettings;

bool isPinhole(const Given& given) { return py::hasattr(given.camera, "_numbers"); }

void setSize(const char* name, const Given& given, RenderRequest& request) {
  const auto [width, height] = sizeOf(given.size);
  request.settings.width = inRange(name, width, 1, 65536);
  request.settings.height = inRange(name, height, 1, 65536);
  if (!isPictureSize(width, height)) throw py::value_error("size: at most 2^28 pixels expected");
}

// Sets True or False, which need no check.
template <auto argument, auto member>
void setFlag(const char*, const Given& given, RenderRequest& request) {
  request.settings.*member = given.*argument;
}

template <double Given::*argument, double Settings::*member>
void setThickness(const char* name, const Given& given, RenderRequest& request) {
  const double size = given.*argument;
  if (!(size >= 0 && size < 1e18))
    throw py::value_error(fmt::format("{}: a diameter of at least 0 expected, not {}", name, size));
  request.settings.*member = size;
}

// Sets all quality settings except the number of samples.
void setQuality(const char*, const Given& given, RenderRequest& request) {
  for (const RTqualityInfo& info : picture::qualityTable())
    checkQuality(info.quality, info.name, given.quality[info.quality]);
  request.settings.quality = given.quality;
  request.settings.error = given.quality[RT_TARGET_ERROR];
  request.settings.timeLimit = given.quality[RT_TIME_LIMIT];
}

void setThreads(const char* name, const Given& given, RenderRequest& request) {
  request.settings.threads = inRange(name, given.threads, 0, 1024);
}

void setIsa(const char*, const Given& given, RenderRequest& request) {
  request.settings.isa = checkedIsa(given.isa);
}

void setColour(const char*, const Given& given, RenderRequest& request) {
  if (given.colour != "linear" && given.colour != "vrml97")
    throw py::value_error("colour: 'linear' or 'vrml97' expected, not '" + given.colour + "'");
  request.settings.linear = given.colour == "linear";
}

void setHeadlight(const char*, const Given& given, RenderRequest& request) {
  request.settings.headlight = headlightOf(given.headlight);
}

void setCrop(const char* name, const Given& given, RenderRequest& request) {
  if (given.crop.is_none()) return;
  Settings& settings = request.settings;
  std::array<int, 4> c{};
  try {
    c = given.crop.cast<std::array<int, 4>>();
  } catch (const py::cast_error&) {}
  const bool lies = c[0] >= 0 && c[1] >= 0 && c[2] >= 1 && c[3] >= 1 &&
                    c[2] <= settings.width - c[0] && c[3] <= settings.height - c[1];
  if (!lies)
    throw py::value_error(fmt::format("{}: (x, y, width, height) within the picture of {}x{} "
                                      "pixels expected, not {}",
                                      name, settings.width, settings.height,
                                      std::string(py::repr(given.crop))));
  settings.crop = {c[0], c[1], c[2], c[3]};
  if (const std::string why = picture::whyNoCrop(settings); !why.empty())
    throw py::value_error(fmt::format("{}: {}", name, why));
}

void setSamples(const char* name, const Given& given, RenderRequest& request) {
  Settings& settings = request.settings;
  const long long most = settings.timeLimit > 0 ? 65536
                         : settings.error > 0   ? 4096
                                                : settings.samples;
  const long long samples = given.spp.value_or(most);
  checkQuality(RT_SAMPLES_PER_PIXEL, name, double(samples));
  settings.samples = int(samples);
}

void setChannels(const char*, const Given& given, RenderRequest& request) {
  const uint32_t error = request.settings.error > 0 ? RT_ERROR | RT_TRUST : 0;
  request.channels =
      given.channels.is_none() ? RT_RGBA | RT_DEPTH | error : channelsOf(given.channels);
  request.settings.channels = request.channels;
}

// Pictures of the z-buffer have rgba alone, and no samples.
void setRaster(const char* name, const Given& given, RenderRequest& request) {
  Settings& settings = request.settings;
  if (!given.raster) return;
  const bool asksForMore = !given.channels.is_none() && request.channels != RT_RGBA;
  if (given.spp || settings.error > 0 || settings.timeLimit > 0 || asksForMore ||
      !given.cluster.is_none())
    throw py::value_error(fmt::format("{}: it draws without rays: not with spp, error, "
                                      "time_limit, channels other than rgba, or cluster",
                                      name));
  settings.raster = true;
  settings.channels = request.channels = RT_RGBA;
}

void checkViewpoint(const char*, const Given& given, RenderRequest&) {
  if (!given.viewpoint.is_none() && (!given.camera.is_none() || given.fit))
    throw py::value_error("viewpoint: not with camera or fit, which look from elsewhere");
}

void setFit(const char*, const Given& given, RenderRequest& request) {
  if (isPinhole(given) && (given.fit || given.fov))
    throw py::value_error("camera: a Pinhole says all of the view: not with fit or fov");
  request.view.fit = given.fit;
}

void setFov(const char*, const Given& given, RenderRequest& request) {
  if (given.fov && !(*given.fov > 0 && *given.fov < 180))
    throw py::value_error("fov: an angle between 0 and 180 degrees expected");
  request.view.fov = given.fov;
}

void setOrtho(const char*, const Given& given, RenderRequest& request) {
  if (given.ortho && (given.fit || given.fov || isPinhole(given)))
    throw py::value_error("ortho: not with fit, fov or a Pinhole, which say what the camera sees");
  if (given.ortho && !(*given.ortho > 0 && *given.ortho < 1e30))
    throw py::value_error("ortho: the height of a parallel view, above 0, expected");
  request.view.ortho = given.ortho;
}

void setCamera(const char*, const Given& given, RenderRequest& request) {
  if (isPinhole(given))
    request.view.pinhole = pinholeOf(given.camera, request.settings.width, request.settings.height);
  else if (!given.camera.is_none())
    request.view.lookAt = cameraOf(given.camera);
}

void setUp(const char*, const Given& given, RenderRequest& request) {
  if (given.up && !(request.view.up = picture::axisNamed(*given.up)))
    throw py::value_error("up: 'x', 'y', 'z', '-x', '-y' or '-z' expected, not '" + *given.up +
                          "'");
}

void setBackground(const char*, const Given& given, RenderRequest& request) {
  request.settings.background = backgroundOf(given.background);
}

void setStudio(const char*, const Given& given, RenderRequest& request) {
  py::object colour = given.studio;
  if (colour.is_none() && given.studioColour) colour = py::str(*given.studioColour);
  Settings& settings = request.settings;
  const bool refused = py::isinstance<py::bool_>(colour) && !colour.cast<bool>();
  request.isLookOpen =
      !refused && colour.is_none() && given.background.is_none() && given.channels.is_none();
  if (refused || colour.is_none()) return;
  picture::Background read;
  try {
    read = backgroundOf(colour);
  } catch (const py::value_error&) {}
  if (read.kind != picture::Background::Kind::colour)
    throw py::value_error("studio: a colour (a name such as white, #rgb, #rrggbb, or three numbers "
                          "from 0 to 1), False or None expected, not " +
                          shown(given.studio));
  // a colour of background is the backdrop of a studio
  if (settings.background.kind == picture::Background::Kind::colour)
    read.colour = settings.background.colour;
  else if (settings.background.kind != picture::Background::Kind::world)
    throw py::value_error("studio: it has a backdrop of its own: not with a background other than "
                          "a colour");
  settings.background = {};
  settings.studio = {true, read.colour};
}

void setSky(const char* name, const Given& given, RenderRequest& request) {
  if (!given.sky) return;
  Settings& settings = request.settings;
  if (settings.background.kind != picture::Background::Kind::world || settings.studio.on)
    throw py::value_error(fmt::format("{}: it is all around: not with background or studio", name));
  try {
    settings.sky = picture::readSky(*given.sky);
  } catch (const std::exception& wrong) {
    throw py::value_error(fmt::format("{}: {}", name, wrong.what()));
  }
  if (const std::string warning = picture::warningOf(*settings.sky);
      !warning.empty() &&
      PyErr_WarnEx(PyExc_RuntimeWarning, fmt::format("{}: {}", name, warning).c_str(), 1) != 0)
    throw py::error_already_set();
  request.isLookOpen = false;
}

void setFrom(const char* name, const Given& given, RenderRequest& request) {
  if (!given.from) return;
  request.view.side = picture::sideNamed(*given.from);
  if (!request.view.side)
    throw py::value_error(
        fmt::format("{}: one of {} expected, not '{}'", name, picture::sideNames(), *given.from));
  if (!given.camera.is_none() || !given.viewpoint.is_none() || given.fit)
    throw py::value_error(
        fmt::format("{}: not with camera, viewpoint or fit, which look from elsewhere", name));
}

void setExposure(const char*, const Given& given, RenderRequest& request) {
  const std::optional<double> stops = exposureOf(given.exposure);
  request.fitExposure = !stops;
  request.shown = {stops.value_or(0), curveOf(given.view)};
  if ((request.fitExposure || !request.shown.isPlain()) && !request.settings.linear)
    throw py::value_error("exposure, view: they need linear light, not colour='vrml97'");
}

// Checks one parameter, and sets the members of the request that it decides.
struct Rule {
  const char* name;
  void (*set)(const char* name, const Given& given, RenderRequest& request);
};

// The order is that of the checks: a row uses what the rows above have set.
constexpr Rule rules[] = {
    {"size", setSize},
    {"threads", setThreads},
    {"isa", setIsa},
    {"quality settings", setQuality},
    {"multiply_textures", setFlag<&Given::multiplyTextures, &Settings::multiplyTextures>},
    {"exact_shapes", setFlag<&Given::exactShapes, &Settings::exactShapes>},
    {"point_size", setThickness<&Given::pointSize, &Settings::pointSize>},
    {"line_width", setThickness<&Given::lineWidth, &Settings::lineWidth>},
    {"colour", setColour},
    {"headlight", setHeadlight},
    {"spp", setSamples},
    {"channels", setChannels},
    {"raster", setRaster},
    {"crop", setCrop},
    {"viewpoint", checkViewpoint},
    {"fit", setFit},
    {"fov", setFov},
    {"ortho", setOrtho},
    {"camera", setCamera},
    {"up", setUp},
    {"from_", setFrom},
    {"background", setBackground},
    {"studio", setStudio},
    {"sky", setSky},
    {"exposure", setExposure},
};

} // namespace

std::optional<double> exposureOf(const py::object& given) {
  if (py::isinstance<py::str>(given) && fromText(given) == "auto") return {};
  double stops = NAN;
  if (!py::isinstance<py::str>(given) && !py::isinstance<py::bool_>(given)) {
    stops = PyFloat_AsDouble(given.ptr());
    if (PyErr_Occurred()) {
      PyErr_Clear();
      stops = NAN;
    }
  }
  if (!(std::abs(stops) <= picture::mostExposure))
    throw py::value_error(fmt::format("exposure: 'auto' or a number of stops from -{0} to {0} "
                                      "expected, not {1}",
                                      picture::mostExposure, shown(given)));
  return stops;
}

picture::ViewCurve curveOf(const std::string& name) {
  const std::optional<picture::ViewCurve> curve = picture::curveNamed(name);
  if (!curve)
    throw py::value_error(fmt::format("view: {} expected, not '{}'", picture::curveNames, name));
  return *curve;
}

std::string checkedIsa(const std::string& isa) {
  try {
    picture::checkIsa(isa);
  } catch (const picture::RenderError& error) {
    throw py::value_error("isa: " + std::string(error.what()) + ", not '" + isa + "'");
  }
  return isa;
}

RenderRequest requestOf(const RenderArguments& given) {
  RenderRequest request;
  for (const Rule& rule : rules) rule.set(rule.name, given, request);
  request.settings.progressive = picture::isWorthProgressive(request.settings);
  return request;
}

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

uint32_t channelsOf(const py::object& list) {
  uint32_t bits = RT_RGBA;
  const bool one = py::isinstance<py::str>(list);
  if (!one && !PySequence_Check(list.ptr()) && !PyAnySet_Check(list.ptr()))
    throw py::type_error("channels: a name or several expected, not an object of the class " +
                         typeName(list));
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
