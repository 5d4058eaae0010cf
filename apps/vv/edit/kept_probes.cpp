#include "edit/kept_probes.h"

#include <algorithm>

#include <fmt/format.h>

#include "edit/node_fields.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace vv {

using namespace xvrml;

namespace {

struct Reading {
  Vec3f position, direction;
  const char* quantity;
};

Vec3f vectorOf(const double v[3]) { return {float(v[0]), float(v[1]), float(v[2])}; }

// Returns what the sensor of a probe reads.
Reading readingOf(const Probe& probe, const EditView& view) {
  if (probe.area) throw EditError("a rectangle belongs to the pictures of its view");
  if (!canBeKept(probe)) throw EditError("the file has this sensor already");
  if (probe.sensor)
    return {vectorOf(probe.sensor->first), vectorOf(probe.sensor->direction),
            picture::infoOf(probe.sensor->quantity).word};
  double x = 0, y = 0;
  if (!projectPoint(view.camera, view.aspect, probe.point.data(), x, y))
    throw EditError(fmt::format("probe {} is behind the viewer", probe.number));
  const CameraRay ray = rayThrough(view.camera, view.aspect, x, y);
  return {vectorOf(ray.origin), vectorOf(ray.direction), "LUMINANCE"};
}

bool reads(const NodeRef& node, const Reading& reading) {
  const auto* const sensor = nodeCast<nodes::ORTSensor>(node);
  return sensor && sensor->position == reading.position && sensor->direction == reading.direction &&
         sensor->quantity == reading.quantity && sensor->columns == 1 && sensor->rows == 1;
}

bool hasProbe(const Probes& probes, const picture::PlacedSensor& sensor) {
  return std::any_of(probes.all().begin(), probes.all().end(), [&](const Probe& probe) {
    return probe.sensor && std::equal(sensor.first, sensor.first + 3, probe.sensor->first) &&
           std::equal(sensor.direction, sensor.direction + 3, probe.sensor->direction) &&
           sensor.quantity == probe.sensor->quantity && sensor.columns == probe.sensor->columns &&
           sensor.rows == probe.sensor->rows;
  });
}

} // namespace

void keepInWorld(WorldEditor& editor, const Probe& probe, const EditView& view) {
  const Reading reading = readingOf(probe, view);
  const MFNode& roots = editor.browser().world().scope.roots;
  if (std::any_of(roots.begin(), roots.end(),
                  [&](const NodeRef& node) { return reads(node, reading); }))
    throw EditError(fmt::format("the world has a sensor for probe {} already", probe.number));
  NodeRef made;
  editor.step(fmt::format("Keep probe {}", probe.number), [&] {
    made = insertNew(editor, editor.endOf(nullptr, ""), "ORTSensor");
    Editor& file = editor.editor();
    file.set(*made, "position", reading.position);
    file.set(*made, "direction", reading.direction);
    file.set(*made, "quantity", std::string(reading.quantity));
    file.set(*made, "description",
             probe.name.empty() ? fmt::format("probe {}", probe.number) : probe.name);
  });
  editor.select({made});
}

void showSensors(WorldEditor& editor, Probes& probes, size_t most) {
  MFNode sensors;
  walk(rootsOf(editor.browser().world().scope), [&](Node& node, std::vector<Node*>& open) {
    appendChildren(node, open);
    if (nodeCast<nodes::ORTSensor>(&node)) sensors.push_back(NodeRef(&node));
  });
  std::reverse(sensors.begin(), sensors.end()); // walks begin at the last root
  const size_t before = probes.all().size();
  bool hasLarge = false;
  for (const NodeRef& node : sensors) {
    NodePlacement placement;
    if (!editor.browser().locate(*node, placement)) continue; // it is not in the scene
    SensorInfo info{node->defName, node, {}};
    const std::array<double, 16>& place = placement.path.back().toWorld;
    std::copy(place.begin(), place.end(), info.matrix);
    const picture::PlacedSensor sensor = picture::placeSensor(info);
    if (int64_t(sensor.columns) * sensor.rows > mostPoints ||
        sensor.quantity == picture::Quantity::glare) {
      hasLarge = true;
      continue;
    }
    if (hasProbe(probes, sensor)) continue;
    if (probes.all().size() >= most)
      throw EditError(fmt::format("there are {} probes already", most));
    probes.addSensor(sensor);
    probes.rename(probes.all().back().number, sensor.name);
  }
  if (probes.all().size() == before)
    throw EditError(hasLarge ? fmt::format("the file has no more sensors of at most {} points: vv "
                                           "--measure reads larger ones, and glare ratings",
                                           mostPoints)
                             : "the file has no more sensors");
}

} // namespace vv
