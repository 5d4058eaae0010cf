// roles.cpp: Implements the API functions that give a shader a role: light, camera, environment,
// transport or default surface. Runs on the application's thread.
#include <cmath>

#include "api/geometry/transform.h"
#include "api/guard.h"

using namespace openrt;

namespace {

template <class Change> void changeLight(Context& c, RTid id, const Change& change) {
  LightState& state = c.scene.light(id);
  c.scene.lights.markDirty(id, state);
  change(state);
}

// Throws RT_INVALID_VALUE if the matrix is singular, because a camera needs three independent axes.
void requireFrame(const Matrix4d& matrix) {
  require(matrix.determinant() != 0, RT_INVALID_VALUE, "the current matrix is singular");
}

void useStockCamera(Context& c, const char* className, RTid& cached, const char* parameterName,
                    double value) {
  c.requireOutsideDefinition();
  requireFrame(c.matrices.top());
  const RTid shader = c.stockCamera(className, cached);
  const RtsClass& table = c.scene.classOf(c.scene.shader(shader));
  uint32_t index = 0;
  while (index < table.paramCount && std::string_view(table.params[index].name) != parameterName)
    index++;
  if (index == table.paramCount || table.params[index].type != RTS_FLOAT)
    fail(RT_PLUGIN_ERROR,
         std::string("the stock class ") + className + " has no float parameter " + parameterName);
  const float number = static_cast<float>(value);
  c.scene.setParameter(shader, {.index = index, .floats = {&number, 1}});
  c.scene.setRole(c.scene.camera, shader, c.matrices.top());
}

} // namespace

RTid rtUseLight(RTid shader) {
  return guarded("rtUseLight", RTid(0), [&](Context& c) {
    c.scene.shader(shader);
    c.scene.requireKind(shader, RTS_LIGHT);
    c.requireOutsideDefinition();
    return c.scene.newLight(shader, c.matrices.top());
  });
}

void rtLightMatrix(RTid light, const double m[16]) {
  guarded("rtLightMatrix", [&](Context& c) {
    const Matrix4d matrix = checkedMatrix(m);
    changeLight(c, light, [&](LightState& s) { s.matrix = matrix; });
  });
}

void rtLightScope(RTid light, RTid instance) {
  guarded("rtLightScope", [&](Context& c) {
    if (instance != 0) c.scene.instance(instance);
    changeLight(c, light, [&](LightState& s) { s.scope = instance; });
  });
}

void rtRemoveLight(RTid light) {
  guarded("rtRemoveLight", [&](Context& c) { c.scene.deleteLight(light); });
}

void rtUseCamera(RTid shader) {
  guarded("rtUseCamera", [&](Context& c) {
    c.scene.requireKind(shader, RTS_CAMERA);
    c.requireOutsideDefinition();
    requireFrame(c.matrices.top());
    c.scene.setRole(c.scene.camera, shader, c.matrices.top());
  });
}

void rtUseEnvironment(RTid shader) {
  guarded("rtUseEnvironment", [&](Context& c) {
    c.scene.requireKind(shader, RTS_ENVIRONMENT);
    c.requireOutsideDefinition();
    c.scene.setRole(c.scene.environment, shader, c.matrices.top());
  });
}

void rtUseTransport(RTid shader) {
  guarded("rtUseTransport", [&](Context& c) {
    c.scene.requireKind(shader, RTS_TRANSPORT);
    c.scene.setRole(c.scene.transport, shader, Matrix4d());
  });
}

void rtDefaultShader(RTid shader) {
  guarded("rtDefaultShader", [&](Context& c) {
    c.scene.requireKind(shader, RTS_SURFACE);
    c.scene.setRole(c.scene.defaultShader, shader, Matrix4d());
  });
}

void rtPerspective(double fovyDegrees) {
  guarded("rtPerspective", [&](Context& c) {
    require(fovyDegrees > 0 && fovyDegrees < 180, RT_INVALID_VALUE,
            "the field of view must lie between 0 and 180 degrees");
    useStockCamera(c, "PerspectiveCamera", c.perspectiveCamera, "fovy", fovyDegrees);
  });
}

void rtOrtho(double height) {
  guarded("rtOrtho", [&](Context& c) {
    require(std::isfinite(static_cast<float>(height)) && height > 0, RT_INVALID_VALUE,
            "the height must be positive and finite");
    useStockCamera(c, "OrthographicCamera", c.orthographicCamera, "height", height);
  });
}
