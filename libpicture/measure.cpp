#include "libpicture/measure.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "libpicture/glare.h"
#include "libpicture/stage.h"
#include "libpicture/vec.h"
#include "xvrml/nodes.h"

namespace picture {

namespace {

Vec of(const xvrml::Vec3f& v) { return {double(v.x), double(v.y), double(v.z)}; }
void store(Vec v, double out[3]) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}
Vec load(const double v[3]) { return {v[0], v[1], v[2]}; }

// Applies the linear part of a matrix.
Vec turned(const double m[16], Vec v) {
  return load(m) * v.x + load(m + 4) * v.y + load(m + 8) * v.z;
}

constexpr int mostPoints = 1 << 20; // the most points of one sensor
constexpr int mostEyes = 1 << 12;   // and of one observer, which asks for rays to each luminaire
// metres between neighbouring points; the camera that reads nearer ones would have no axes
constexpr double leastStep = 1e-13;

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw SensorError(fmt::format("ORTSensor {}: {}", name, what));
}

std::string nameOf(const xvrml::SensorInfo& info, const xvrml::nodes::ORTSensor& node) {
  if (!info.name.empty()) return info.name;
  return node.description.empty() ? "ORTSensor" : node.description;
}

// Returns a unit vector across the unit vector n: the part of `wanted` that is, or any.
Vec acrossOf(Vec wanted, Vec n) {
  const Vec part = wanted + n * -dot(wanted, n);
  if (const double l = length(part); l > 1e-6 * length(wanted)) return part * (1 / l);
  const Vec other = std::abs(n.x) < .9 ? Vec{1, 0, 0} : Vec{0, 0, 1};
  const Vec rest = other + n * -dot(other, n);
  return rest * (1 / length(rest));
}

} // namespace

void PlacedSensor::pointAt(int c, int r, double out[3]) const {
  store(load(first) + load(column) * c + load(row) * r, out);
}

// In local space, the ray of pixel (i, j) starts at (i + 1/2 - columns / 2, rows / 2 - j - 1/2, 0)
// and goes along -z (plugins/shaders/vrml97/cameras.cpp).
void PlacedSensor::camera(double lift, double out[16]) const {
  const Vec u = load(column), v = load(row) * -1, n = load(direction);
  const Vec middle =
      load(first) + load(column) * ((columns - 1) * .5) + load(row) * ((rows - 1) * .5) + n * lift;
  const Vec columnsOf[4] = {u, v, n * -1, middle};
  for (int i = 0; i < 4; i++) {
    store(columnsOf[i], out + 4 * i);
    out[4 * i + 3] = i == 3;
  }
}

PlacedSensor placeSensor(const xvrml::SensorInfo& info) {
  const auto& node = static_cast<const xvrml::nodes::ORTSensor&>(*info.node);
  PlacedSensor out;
  out.name = nameOf(info, node);
  const auto refuseThis = [&](const std::string& what) { refuse(out.name, what); };
  const auto* const wanted =
      std::find_if(std::begin(quantityTable), std::end(quantityTable),
                   [&](const QuantityInfo& info) { return node.quantity == info.word; });
  if (wanted == std::end(quantityTable))
    refuseThis(fmt::format("quantity is ILLUMINANCE, LUMINANCE or UGR, not \"{}\"", node.quantity));
  out.quantity = Quantity(wanted - quantityTable);
  out.columns = node.columns;
  out.rows = node.rows;
  const int most = out.quantity == Quantity::glare ? mostEyes : mostPoints;
  if (out.columns < 1 || out.rows < 1 || int64_t(out.columns) * out.rows > most)
    refuseThis(fmt::format("columns and rows are 1 or more, and at most {} points in all; not {} "
                           "and {}",
                           most, node.columns, node.rows));
  const Vec given = of(node.direction);
  if (!(length(given) > 0) || !std::isfinite(length(given))) refuseThis("direction has no length");
  const double width = double(node.size.x), height = double(node.size.y);
  if (!(width >= 0) || !(height >= 0) || !std::isfinite(width + height))
    refuseThis("size is not below 0");
  if ((out.columns > 1 && width == 0) || (out.rows > 1 && height == 0))
    refuseThis(fmt::format("a grid of {} x {} points needs a size along both, not {} x {}",
                           out.columns, out.rows, width, height));
  const Vec n = given * (1 / length(given)), a = acrossOf(of(node.across), n), b = cross(a, n);
  const double* m = info.matrix;
  const Vec u = turned(m, a), v = turned(m, b), area = cross(v, u);
  const Vec position = turned(m, of(node.position)) + load(m + 12);
  const double mirrored = dot(area, turned(m, n)) < 0 ? -1 : 1;
  const bool looks = out.quantity != Quantity::illuminance;
  const Vec direction = looks ? turned(m, n) : area * mirrored;
  const double size = length(direction), extent = length(u) * length(v);
  if (!(size > 0) || !std::isfinite(size) || !(length(area) > 1e-9 * extent) ||
      !std::isfinite(length(position)))
    refuseThis("it stands in a coordinate system that is flat or not finite");
  store(direction * (1 / size), out.direction);
  out.cells = width > 0 && height > 0;
  // A point without a size has a cell, too, which gives the camera its axes.
  const double cellWidth = width > 0 ? width / out.columns : 1,
               cellHeight = height > 0 ? height / out.rows : 1;
  if (!(std::min(length(u) * cellWidth, length(v) * cellHeight) >= leastStep))
    refuseThis(fmt::format("its points are nearer together than {} m", leastStep));
  store(u * cellWidth, out.column);
  store(v * cellHeight, out.row);
  store(position + u * (cellWidth * (1 - out.columns) * .5) +
            v * (cellHeight * (1 - out.rows) * .5),
        out.first);
  return out;
}

PlacedSensor sensorAt(const double point[3], const double normal[3], const double seen[3]) {
  PlacedSensor out;
  const Vec n = load(normal) * (dot(load(normal), load(seen)) > 0 ? -1 : 1);
  const Vec a = acrossOf({1, 0, 0}, n);
  store(load(point), out.first);
  store(a, out.column);
  store(cross(a, n), out.row);
  store(n, out.direction);
  return out;
}

// Turns the illuminances at the eyes of observers into glare ratings.
void Stage::rate(const std::vector<Luminaire>& luminaires, Measurement& m) const {
  std::vector<RTrayd> rays(luminaires.size());
  std::vector<uint8_t> hidden(luminaires.size());
  for (size_t i = 0; i < m.value.size(); i++) {
    double point[3], up[3];
    m.sensor.pointAt(int(i) % m.sensor.columns, int(i) / m.sensor.columns, point);
    xvrml::upVector(up_, up);
    const Observer observer{load(point), load(m.sensor.direction), load(up)};
    for (size_t k = 0; k < luminaires.size(); k++) {
      const Vec way = luminaires[k].place + observer.eye * -1;
      rays[k] = {{point[0], point[1], point[2]}, 0, {way.x, way.y, way.z}, 1 - 1e-5};
    }
    rtOccludedRaysd(rays.size(), rays.data(), hidden.data());
    GlareSources sources;
    for (size_t k = 0; k < luminaires.size(); k++)
      if (!hidden[k]) sources.add(observer, luminaires[k].from(observer.eye));
    const GlareRating rating = glareRating(sources, double(m.value[i]), double(m.halfWidth[i]));
    m.value[i] = float(rating.value);
    m.halfWidth[i] = float(rating.halfWidth);
    m.trusted[i] = m.trusted[i] && std::isfinite(rating.halfWidth);
  }
  throwOnError("finding the luminaires that an observer sees");
}

std::vector<Luminaire> Stage::luminaires() const {
  return Luminaire::read(mapper_->lamps(), *world_);
}

// Returns the luminaires for glare ratings. Throws SensorError if one cannot be rated.
std::vector<Luminaire> Stage::glaringLuminaires(const PlacedSensor& sensor) const {
  std::vector<Luminaire> all = luminaires();
  for (const Luminaire& one : all) {
    const std::string& why = one.problem;
    if (!why.empty() || !one.hasOpening())
      refuse(sensor.name, fmt::format("UGR: the luminaire {}{} cannot be rated: {}", one.name,
                                      one.file.empty() ? "" : " (" + one.file + ")",
                                      why.empty() ? "its file has no luminous opening" : why));
  }
  return all;
}

// Sensors see neither the headlight nor the light that vv adds to models without light: only lamps
// of the world count. Billboards and levels of detail are those of the view.
void Stage::prepareSensors(const View& view) {
  mapper_->setHeadlight(xvrml::MapOptions::Headlight::off);
  mapper_->setModelLight(false);
  mapper_->setBackground(settings.background.kind == Background::Kind::world);
  mapper_->map(cameraOf(view));
  useEnvironment();
  up_ = upOf(*mapper_, view);
  if (memoryExhausted_) throw std::bad_alloc();
}

std::vector<PlacedSensor> Stage::placeSensors() const {
  std::vector<PlacedSensor> out;
  for (const xvrml::SensorInfo& info : mapper_->sensors()) out.push_back(placeSensor(info));
  return out;
}

std::vector<Measurement> Stage::measure(const std::vector<PlacedSensor>& sensors,
                                        RenderSettings frame, const std::atomic<bool>& cancelled) {
  std::vector<Measurement> out;
  if (!sensors.empty()) frame.timeLimit /= double(sensors.size());
  for (const PlacedSensor& sensor : sensors) {
    if (cancelled) break;
    out.push_back(measure(sensor, frame, cancelled));
    out.back().interrupted = cancelled;
  }
  return out;
}

Measurement Stage::measure(const PlacedSensor& sensor, const RenderSettings& given,
                           const std::atomic<bool>& cancelled) {
  // Points that lie in a surface are lifted off it by more than the rounding of its vertices.
  constexpr double liftOfRadius = 2e-6;
  Measurement out;
  out.sensor = sensor;
  double matrix[16];
  const bool isLit = sensor.quantity == Quantity::illuminance,
             isRated = sensor.quantity == Quantity::glare;
  std::vector<Luminaire> lamps;
  if (isRated) lamps = glaringLuminaires(sensor);
  const double lift = isLit ? liftOfRadius * mapper_->boundingSphere().radius : 0;
  sensor.camera(lift, matrix);
  rtLoadMatrixd(matrix);
  rtOrtho(sensor.rows);
  RenderSettings frame = given;
  frame.width = sensor.columns;
  frame.height = sensor.rows;
  frame.crop = {};
  frame.channels = RT_RGBA | RT_ERROR | RT_TRUST | RT_SAMPLES;
  frame.progressive = frame.preview = false;
  frame.quality.set(RT_MEASURE, sensor.quantity == Quantity::luminance ? RT_MEASURE_LUMINANCE
                                                                       : RT_MEASURE_ILLUMINANCE);
  // Light paths give means over cells. Points without cells follow paths alone, and so do eyes.
  if ((!sensor.cells || isRated) && frame.quality.whole(RT_TRANSPORT) == RT_TRANSPORT_LIGHT)
    frame.quality.set(RT_TRANSPORT, RT_TRANSPORT_PATH);
  setUpFrame(frame);
  rtSwapBuffers();
  if (cancelled) cancel(); // a cancellation that came before the frame existed
  rtFinishFrame();
  throwOnError("measuring");
  const size_t n = size_t(sensor.columns) * size_t(sensor.rows);
  std::vector<float> rgba(4 * n), error(3 * n), trust(n), samples(n);
  rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
  rtReadPixels(RT_ERROR, error.data(), error.size());
  rtReadPixels(RT_TRUST, trust.data(), trust.size());
  rtReadPixels(RT_SAMPLES, samples.data(), samples.size());
  throwOnError("reading the sensors");
  for (size_t i = 0; i < n; i++) {
    out.value.push_back(rgba[4 * i]);
    out.halfWidth.push_back(error[3 * i]);
    out.trusted.push_back(trust[i] > 0);
    out.samples.push_back(uint32_t(samples[i]));
  }
  if (isRated) rate(lamps, out);
  if (isLit && settings.sky && settings.sky->isOvercast()) out.outdoors = settings.sky->outdoors();
  out.stats.size = sizeof out.stats;
  rtGetStats(&out.stats);
  return out;
}

} // namespace picture
