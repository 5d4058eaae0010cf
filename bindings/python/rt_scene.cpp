// rt_scene.cpp: Implements the scene of an xvrml.rt context: meshes from arrays, instances, shaders
// and their parameters, lights, camera, textures. [GIL held; released for long operations]
// Longer than 500 lines because it binds one class.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "degenerate.h"
#include "local_origin.h"
#include "numbers.h"
#include "objects.h"
#include "parameters.h"
#include "rt_objects.h"

namespace {

template <class T> using Dense = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T> Dense<T> rows(const py::object& given, const char* name, py::ssize_t width,
                                 py::ssize_t count = -1) {
  const std::string expected =
      fmt::format("numbers of shape ({}, {})", count < 0 ? "n" : std::to_string(count), width);
  const py::array numbers = numberArray(given, name, expected, std::is_integral_v<T>);
  if (numbers.ndim() != 2 || numbers.shape(1) != width || (count >= 0 && numbers.shape(0) != count))
    throw py::value_error(name + (": " + expected) + " expected, not of shape " +
                          fromText(py::str(numbers.attr("shape"))));
  return Dense<T>(numbers);
}

// Casts the value to one of this module's classes.
template <class T> const T& thing(const py::handle& value, const char* name, const char* expected) {
  if (!py::isinstance<T>(value))
    throw py::type_error(fmt::format("{}: {} expected, not {}", name, expected, shown(value)));
  return value.cast<const T&>();
}

const RtShader* shaderOf(const RtContextPtr& context, const py::object& shader) {
  if (shader.is_none()) return nullptr;
  const auto& found = thing<RtShader>(shader, "shader", "a Shader or None");
  if (found.context != context) throw py::value_error("shader: of another context");
  return &found;
}

struct ObjectDefinition { // begins and ends the definition of an object
  RTid id;
  explicit ObjectDefinition(RTid replaced = 0) : id(rtBeginObject(replaced)) {}
  ~ObjectDefinition() {
    rtVertexPointer(3, RT_FLOAT, 0, nullptr);
    rtNormalPointer(RT_FLOAT, 0, nullptr);
    rtTexCoordPointer(2, RT_FLOAT, 0, nullptr);
    rtColorPointer(3, RT_FLOAT, 0, nullptr);
    rtBindShader(0);
    rtEndObject();
  }
};

// The arguments of Context.mesh(), in the order of Python's signature. The values are the defaults.
struct MeshArguments {
  py::object vertices;
  py::object faces = py::none();
  py::object normals = py::none();
  py::object texcoords = py::none();
  py::object colors = py::none();
  py::object shader = py::none();
  uint32_t name = 0;
  bool cull = false;
  py::object replaces = py::none();
};

RtObject mesh(const RtContextPtr& self, const MeshArguments& given) {
  const bool wide = py::isinstance<py::array_t<double>>(given.vertices);
  Dense<double> doubles;
  Dense<float> single;
  if (wide)
    doubles = rows<double>(given.vertices, "vertices", 3);
  else
    single = rows<float>(given.vertices, "vertices", 3);
  const py::ssize_t count = wide ? doubles.shape(0) : single.shape(0);
  Dense<uint32_t> corners;
  if (!given.faces.is_none()) {
    const auto wanted = rows<int64_t>(given.faces, "faces", 3);
    corners = Dense<uint32_t>(wanted.size());
    for (py::ssize_t i = 0; i < wanted.size(); ++i) {
      const int64_t v = wanted.data()[i];
      if (v < 0 || v >= count)
        throw py::value_error(fmt::format("faces: {} is no vertex: there are {}", v, count));
      corners.mutable_data()[i] = uint32_t(v);
    }
  }
  Dense<float> n, t, c;
  if (!given.normals.is_none()) n = rows<float>(given.normals, "normals", 3, count);
  if (!given.texcoords.is_none()) t = rows<float>(given.texcoords, "texcoords", 2, count);
  if (!given.colors.is_none()) c = rows<float>(given.colors, "colors", 3, count);
  const RtShader* surface = shaderOf(self, given.shader);
  RTid replaced = 0;
  if (!given.replaces.is_none()) {
    const auto& former = thing<RtObject>(given.replaces, "replaces", "an Object or None");
    if (former.context != self) throw py::value_error("replaces: an object of another context");
    replaced = former.id;
  }
  const CurrentContext use(self);
  RtObject made;
  {
    const ReleaseGil release;
    const ObjectDefinition opened(replaced);
    made = {{self, opened.id}};
    if (surface) rtBindShader(surface->id);
    rtLoadName(given.name);
    (given.cull ? rtEnable : rtDisable)(RT_CULL_FACE);
    rtVertexPointer(3, wide ? RT_DOUBLE : RT_FLOAT, 0,
                    wide ? static_cast<const void*>(doubles.data()) : single.data());
    if (n.size()) rtNormalPointer(RT_FLOAT, 0, n.data());
    if (t.size()) rtTexCoordPointer(2, RT_FLOAT, 0, t.data());
    if (c.size()) rtColorPointer(3, RT_FLOAT, 0, c.data());
    if (!given.faces.is_none())
      rtDrawElements(RT_TRIANGLES, size_t(corners.size()), corners.data(), size_t(count));
    else
      rtDrawArrays(RT_TRIANGLES, 0, size_t(count));
    rtDisable(RT_CULL_FACE);
    rtLoadName(0);
  }
  use.check();
  return made;
}

// Returns points that are given in double as libopenrt stores them: as floats, about an origin of
// those that are used unless all fit floats.
Dense<float> storedPoints(const Dense<double>& points, const Dense<uint32_t>& corners) {
  const double* from = points.data();
  double low[3] = {}, high[3] = {}, origin[3] = {};
  bool exact = true;
  for (py::ssize_t i = 0; i < corners.size(); ++i) {
    const size_t vertex = corners.data()[i];
    if (py::ssize_t(vertex) >= points.shape(0)) continue;
    for (size_t k = 0; k < 3; ++k) {
      const double x = from[3 * vertex + k];
      exact = exact && openrt::fitsFloat(x);
      low[k] = i == 0 ? x : std::min(low[k], x);
      high[k] = i == 0 ? x : std::max(high[k], x);
    }
  }
  for (size_t k = 0; k < 3 && !exact; ++k) origin[k] = openrt::localOrigin(low[k], high[k]);
  Dense<float> stored({points.shape(0), py::ssize_t(3)});
  for (size_t i = 0; i < size_t(points.size()); ++i)
    stored.mutable_data()[i] = float(from[i] - origin[i % 3]);
  return stored;
}

// Returns the numbers of the triangles that a mesh of these arrays keeps, or None if it keeps all.
py::object keptTriangles(const py::object& vertices, const py::object& faces) {
  const bool wide = py::isinstance<py::array_t<double>>(vertices);
  const auto points =
      wide ? storedPoints(rows<double>(vertices, "vertices", 3), rows<uint32_t>(faces, "faces", 3))
           : rows<float>(vertices, "vertices", 3);
  const auto corners = rows<uint32_t>(faces, "faces", 3);
  std::vector<uint32_t> kept;
  const auto total = size_t(corners.shape(0));
  for (size_t i = 0; i < total; ++i) {
    const uint32_t* at = corners.data() + 3 * i;
    for (int k = 0; k < 3; ++k)
      if (py::ssize_t(at[k]) >= points.shape(0))
        throw py::value_error("faces: a vertex that is not there");
    const float* p = points.data();
    if (!openrt::degenerateTriangle(p + 3 * size_t(at[0]), p + 3 * size_t(at[1]),
                                    p + 3 * size_t(at[2])))
      kept.push_back(uint32_t(i));
  }
  if (kept.size() == total) return py::none();
  return copiedArray(kept);
}

// Makes an object of one surface that draw() adds. ccw: false exchanges its front and back.
template <class F> RtObject surfaceObject(const RtContextPtr& self, bool ccw,
                                          const py::object& shader, uint32_t name, const F& draw) {
  const RtShader* surface = shaderOf(self, shader);
  const CurrentContext use(self);
  RtObject made;
  {
    const ObjectDefinition opened;
    made = {{self, opened.id}};
    if (surface) rtBindShader(surface->id);
    rtLoadName(name);
    if (!ccw) rtEnable(RT_CW_FRONT);
    draw();
    rtDisable(RT_CW_FRONT);
    rtLoadName(0);
  }
  use.check();
  return made;
}

RtObject sphere(const RtContextPtr& self, float radius, const py::object& shader, uint32_t name) {
  return surfaceObject(self, true, shader, name, [&] { rtSphere(radius); });
}

RtObject quadric(const RtContextPtr& self, const std::array<double, 10>& coefficients,
                 const std::array<double, 3>& low, const std::array<double, 3>& high, bool ccw,
                 const py::object& shader, uint32_t name) {
  return surfaceObject(self, ccw, shader, name,
                       [&] { rtQuadric(coefficients.data(), low.data(), high.data()); });
}

RtObject cylinder(const RtContextPtr& self, double radius, double low, double high, bool ccw,
                  const py::object& shader, uint32_t name) {
  return surfaceObject(self, ccw, shader, name, [&] { rtCylinder(radius, low, high); });
}

RtObject cone(const RtContextPtr& self, double lowRadius, double highRadius, double low,
              double high, bool ccw, const py::object& shader, uint32_t name) {
  return surfaceObject(self, ccw, shader, name, [&] { rtCone(lowRadius, highRadius, low, high); });
}

RtObject asphere(const RtContextPtr& self, double curvature, double semiAperture, double conic,
                 const std::vector<double>& terms, double innerRadius, bool ccw,
                 const py::object& shader, uint32_t name) {
  return surfaceObject(self, ccw, shader, name, [&] {
    rtAsphere(curvature, conic, terms.size(), terms.data(), innerRadius, semiAperture);
  });
}

RtObject group(const RtContextPtr& self, const py::iterable& parts) {
  std::vector<std::pair<RTid, std::array<double, 16>>> all;
  for (const py::handle part : parts) {
    if (!py::isinstance<py::sequence>(part) || py::len(part) != 2)
      throw py::type_error("parts: pairs of an Object and its matrix expected, not " + shown(part));
    const auto& object =
        thing<RtObject>(part[py::int_(0)], "parts", "pairs of an Object and its matrix");
    if (object.context != self) throw py::value_error("parts: an object of another context");
    all.emplace_back(object.id, rtMatrix(part[py::int_(1)]));
  }
  const CurrentContext use(self);
  RtObject made;
  {
    const ObjectDefinition opened;
    made = {{self, opened.id}};
    for (const auto& [object, matrix] : all) {
      rtLoadMatrixd(matrix.data());
      rtInstantiateObject(object);
    }
  }
  use.check();
  return made;
}

RtInstance instance(const RtContextPtr& self, const RtObject& object, const py::object& matrix,
                    const py::object& shader, uint32_t name, uint64_t userData, bool dynamic) {
  if (object.context != self) throw py::value_error("instance: an object of another context");
  const RtShader* surface = shaderOf(self, shader);
  const auto m = rtMatrix(matrix);
  const CurrentContext use(self);
  rtPushMatrix();
  rtLoadMatrixd(m.data());
  rtLoadName(name);
  RtInstance made{{self, rtInstantiateObject(object.id)}};
  rtLoadName(0);
  rtPopMatrix();
  if (made.id) {
    if (surface) rtInstanceShader(made.id, surface->id);
    if (userData) rtInstanceUserData(made.id, userData);
    if (dynamic) rtInstanceHint(made.id, RT_DYNAMIC);
  }
  use.check();
  return made;
}

// Moves instances. matrices: (n, 4, 4), for column vectors.
void moveInstances(const RtContextPtr& self, const py::sequence& instances,
                   const py::object& matrices) {
  const Dense<double> all(numberArray(matrices, "matrices", "numbers of shape (n, 4, 4)"));
  const auto count = py::ssize_t(py::len(instances));
  if (all.ndim() != 3 || all.shape(0) != count || all.shape(1) != 4 || all.shape(2) != 4)
    throw py::value_error(fmt::format("matrices: numbers of shape ({}, 4, 4) expected, not of "
                                      "shape {}",
                                      count, fromText(py::str(all.attr("shape")))));
  std::vector<RTid> ids;
  for (const py::handle each : instances) {
    const auto& instance = thing<RtInstance>(each, "instances", "Instances");
    if (instance.context != self) throw py::value_error("instances: one of another context");
    ids.push_back(instance.id);
  }
  const CurrentContext use(self);
  for (size_t i = 0; i < ids.size(); ++i) {
    const double* rows = all.data() + 16 * i;
    double columns[16];
    for (size_t k = 0; k < 16; ++k) columns[k] = rows[4 * (k % 4) + k / 4];
    rtInstanceMatrix(ids[i], columns);
  }
  use.check();
}

struct BoundShader { // binds the shader that rtParameter* refers to
  explicit BoundShader(const RtShader& shader) { rtBindShader(shader.id); }
  ~BoundShader() { rtBindShader(0); }
};

std::vector<RTparameterInfo> parametersOf(const RtShader& shader) {
  int count = 0;
  rtGetShaderClass(shader.shaderClass, nullptr, &count);
  std::vector<RTparameterInfo> all(size_t(std::max(count, 0)));
  for (int i = 0; i < count; ++i) rtGetParameterInfo(shader.shaderClass, i, &all[size_t(i)]);
  return all;
}

const char* parameterText(RTenum type) {
  switch (type) {
  case RT_PARAM_INT: return "a whole number";
  case RT_PARAM_FLOAT: return "a number";
  case RT_PARAM_VEC2: return "2 numbers";
  case RT_PARAM_VEC3: return "3 numbers";
  case RT_PARAM_COLOR: return "3 numbers (red, green, blue)";
  case RT_PARAM_VEC4: return "4 numbers";
  case RT_PARAM_STRING: return "a str";
  case RT_PARAM_TEXTURE: return "a Texture";
  default: return "numbers";
  }
}

void setParameter(const RtShader& self, const std::string& name, const py::object& value) {
  const CurrentContext use(self.context);
  const BoundShader bound(self);
  const int handle = rtParameterHandle(name.c_str());
  if (handle < 0) {
    rtGetError();
    std::vector<std::string> known;
    for (const RTparameterInfo& p : parametersOf(self)) known.emplace_back(p.name);
    throw py::key_error(
        fmt::format("{} has no parameter {}{}", self.name, name, didYouMean(name, known)));
  }
  RTparameterInfo info{};
  rtGetParameterInfo(self.shaderClass, handle, &info);
  const std::string label = self.name + "." + name;
  const auto wrongType = [&] {
    throw py::type_error(
        fmt::format("{}: {} expected, not {}", label, parameterText(info.type), shown(value)));
  };
  const auto numbers = [&](py::ssize_t count) {
    Dense<float> array(numberArray(value, label, parameterText(info.type)));
    if (count >= 0 && array.size() != count)
      throw py::value_error(fmt::format("{}: {} expected, not {} of them", label,
                                        parameterText(info.type), array.size()));
    return array;
  };
  try {
    switch (info.type) {
    case RT_PARAM_INT: {
      py::detail::make_caster<int> number;
      // without conversion: it would truncate the fractions of NumPy
      if (!number.load(value, false)) throw py::cast_error();
      rtParameter1i(handle, py::detail::cast_op<int>(number));
      break;
    }
    case RT_PARAM_FLOAT: rtParameter1f(handle, value.cast<float>()); break;
    case RT_PARAM_VEC2: {
      const auto v = numbers(2);
      rtParameter2f(handle, v.data()[0], v.data()[1]);
      break;
    }
    case RT_PARAM_VEC3:
    case RT_PARAM_COLOR: {
      const auto v = numbers(3);
      rtParameter3f(handle, v.data()[0], v.data()[1], v.data()[2]);
      break;
    }
    case RT_PARAM_VEC4: {
      const auto v = numbers(4);
      rtParameter4f(handle, v.data()[0], v.data()[1], v.data()[2], v.data()[3]);
      break;
    }
    case RT_PARAM_MATRIX: {
      const auto m = rtMatrix(value, label);
      float f[16];
      for (size_t i = 0; i < 16; ++i) f[i] = float(m[i]);
      rtParameter16f(handle, f);
      break;
    }
    case RT_PARAM_FLOATS: {
      const auto v = numbers(-1);
      rtParameterfv(handle, size_t(v.size()), v.data());
      break;
    }
    case RT_PARAM_STRING:
      if (!py::isinstance<py::str>(value)) wrongType();
      rtParameterString(handle, fromText(value).c_str());
      break;
    case RT_PARAM_TEXTURE: {
      const auto& texture = thing<RtTexture>(value, label.c_str(), parameterText(info.type));
      if (texture.context != self.context)
        throw py::value_error(label + ": a texture of another context");
      rtParameterTexture(handle, texture.id);
      break;
    }
    default: throw py::type_error(label + " cannot be set");
    }
  } catch (const py::cast_error&) { wrongType(); }
  use.check();
}

RtShader shader(const RtContextPtr& self, const std::string& name, const py::object& library,
                const py::kwargs& parameters) {
  RtShader made;
  {
    const std::string folder = library.is_none() ? "" : fromText(library);
    const CurrentContext use(self);
    const RTid shaderClass =
        rtNewShaderClass(name.c_str(), library.is_none() ? nullptr : folder.c_str());
    use.check();
    made = {{self, rtNewShader(shaderClass)}, shaderClass, name};
    use.check();
  }
  for (const auto& [key, value] : parameters)
    setParameter(made, fromText(key), py::reinterpret_borrow<py::object>(value));
  return made;
}

py::dict parameters(const RtShader& self) {
  constexpr const char* types[] = {"",      "int",    "float",  "vec2",   "vec3",   "vec4",
                                   "color", "matrix", "floats", "string", "texture"};
  const CurrentContext use(self.context, false);
  py::dict all;
  for (const RTparameterInfo& p : parametersOf(self))
    all[p.name] = py::make_tuple(types[p.type < 11 ? p.type : 0], p.text ? p.text : "");
  return all;
}

RtTexture texture(const RtContextPtr& self, const py::object& pixels, bool srgb,
                  const std::string& wrap, const std::string& filter,
                  const std::array<float, 4>& border) {
  const py::array any =
      numberArray(pixels, "pixels", "an array of shape (height, width, components)");
  if (any.ndim() != 2 && any.ndim() != 3)
    throw py::value_error("texture: pixels of shape (height, width, components) expected");
  const py::ssize_t components = any.ndim() == 3 ? any.shape(2) : 1;
  const bool bytes = py::isinstance<py::array_t<uint8_t>>(any);
  if (components < 1 || components > 4 || any.shape(0) < 1 || any.shape(1) < 1 ||
      any.shape(0) > 65536 || any.shape(1) > 65536)
    throw py::value_error("texture: pixels of shape (height, width, 1 to 4) expected");
  const std::map<std::string, int> wraps = {{"repeat", RT_REPEAT},
                                            {"mirror", RT_MIRRORED_REPEAT},
                                            {"clamp", RT_CLAMP_TO_EDGE},
                                            {"border", RT_CLAMP_TO_BORDER}};
  const auto mode = wraps.find(wrap);
  if (mode == wraps.end() || (filter != "linear" && filter != "nearest"))
    throw py::value_error("texture: wrap 'repeat', 'mirror', 'clamp' or 'border', filter 'linear' "
                          "or 'nearest' expected");
  // Python stores rows from the top, OpenRT from the bottom.
  const py::object turned = any[py::make_tuple(py::slice(py::none(), py::none(), py::int_(-1)))];
  Dense<uint8_t> small;
  Dense<float> large;
  if (bytes)
    small = Dense<uint8_t>(turned);
  else
    large = Dense<float>(turned);
  const CurrentContext use(self);
  RtTexture made{{self, 0}};
  rtGenTextures(1, &made.id);
  rtBindTexture(made.id);
  rtTexImage2D(int(components), int(any.shape(1)), int(any.shape(0)),
               bytes ? RT_UNSIGNED_BYTE : RT_FLOAT,
               bytes ? static_cast<const void*>(small.data()) : large.data());
  rtTexParameteri(RT_TEXTURE_SRGB, srgb);
  for (const RTenum side : {RT_TEXTURE_WRAP_S, RT_TEXTURE_WRAP_T})
    rtTexParameteri(side, mode->second);
  rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, border.data());
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, filter == "linear" ? RT_LINEAR : RT_NEAREST);
  rtBindTexture(0);
  use.check();
  return made;
}

struct ScopedMatrix { // sets the current matrix while a role is assigned
  explicit ScopedMatrix(const std::array<double, 16>& matrix) {
    rtPushMatrix();
    rtLoadMatrixd(matrix.data());
  }
  ~ScopedMatrix() { rtPopMatrix(); }
};

RtLight light(const RtContextPtr& self, const RtShader& shader, const py::object& matrix,
              const py::object& scope) {
  if (shader.context != self) throw py::value_error("light: a shader of another context");
  const auto m = rtMatrix(matrix);
  const RTid instance =
      scope.is_none() ? 0 : thing<RtInstance>(scope, "scope", "an Instance or None").id;
  const CurrentContext use(self);
  const ScopedMatrix placed(m);
  RtLight made{{self, rtUseLight(shader.id)}};
  if (instance) rtLightScope(made.id, instance);
  use.check();
  return made;
}

void camera(const RtContextPtr& self, const std::array<double, 3>& eye,
            const std::array<double, 3>& at, const std::array<double, 3>& up, double fov,
            std::optional<double> height) {
  const CurrentContext use(self);
  const ScopedMatrix placed(rtMatrix(py::none()));
  rtLookAt(eye[0], eye[1], eye[2], at[0], at[1], at[2], up[0], up[1], up[2]);
  if (height)
    rtOrtho(*height);
  else
    rtPerspective(fov);
  use.check();
}

void role(const RtContextPtr& self, const py::object& shader, const py::object& matrix,
          void (*take)(RTid)) {
  const RtShader* given = shaderOf(self, shader);
  const auto m = rtMatrix(matrix);
  const CurrentContext use(self);
  const ScopedMatrix placed(m);
  take(given ? given->id : 0);
  use.check();
}

template <class F> auto call(F f) {
  return [f](const RtHandle& self) {
    const CurrentContext use(self.context);
    f(self.id);
    use.check();
  };
}

} // namespace

void defineRtScene(py::module_& module) {
  using namespace pybind11::literals;
  const py::object none = py::none();
  const auto unread = [](const RtHandle&) -> py::object {
    throw py::attribute_error("this attribute can only be assigned");
  };
  py::class_<RtHandle>(module, "_Thing")
      .def_readonly("id", &RtHandle::id, "The number in the C API.");
  py::class_<RtObject, RtHandle>(module, "Object", "Geometry. Instances place it in the scene.")
      .def("delete", call(rtDeleteObject), "Deletes the object and its instances.");
  py::class_<RtInstance, RtHandle>(module, "Instance", "An object placed in the scene.")
      .def("delete", call(rtDeleteInstance))
      .def_property(
          "matrix", unread,
          [](const RtInstance& self, const py::object& matrix) {
            const auto m = rtMatrix(matrix);
            const CurrentContext use(self.context);
            rtInstanceMatrix(self.id, m.data());
            use.check();
          },
          "The placement, a 4x4 matrix for column vectors. Can only be assigned.")
      .def_property("visible", unread,
                    [](const RtInstance& self, bool visible) {
                      const CurrentContext use(self.context);
                      rtInstanceVisible(self.id, visible);
                      use.check();
                    })
      .def_property(
          "shader", unread,
          [](const RtInstance& self, const py::object& shader) {
            const RtShader* given = shaderOf(self.context, shader);
            const CurrentContext use(self.context);
            rtInstanceShader(self.id, given ? given->id : 0);
            use.check();
          },
          "The shader for all parts of the instance; None: each part's own shader. Can only be "
          "assigned.")
      .def_property(
          "fog", unread,
          [](const RtInstance& self, const py::object& fog) {
            const RtShader* given = shaderOf(self.context, fog);
            const CurrentContext use(self.context);
            rtInstanceFog(self.id, given ? given->id : 0);
            use.check();
          },
          "The fog in front of all parts of the instance: a shader for environments; None: the fog "
          "around the instance. Can only be assigned.")
      .def_property(
          "user_data", unread,
          [](const RtInstance& self, uint64_t data) {
            const CurrentContext use(self.context);
            rtInstanceUserData(self.id, data);
            use.check();
          },
          "A number that queries return as geometry_ids. Can only be assigned.");
  py::class_<RtTexture, RtHandle>(module, "Texture").def("delete", call(rtDeleteTexture));
  py::class_<RtLight, RtHandle>(module, "Light")
      .def("delete", call(rtRemoveLight))
      .def_property("matrix", unread, [](const RtLight& self, const py::object& matrix) {
        const auto m = rtMatrix(matrix);
        const CurrentContext use(self.context);
        rtLightMatrix(self.id, m.data());
        use.check();
      });
  py::class_<RtShader, RtHandle>(module, "Shader",
                                 "A shader; shader['reflectance'] = 0.5 sets a parameter.")
      .def("__setitem__", setParameter, "name"_a, "value"_a)
      .def_property_readonly("parameters", parameters,
                             "A dict from each parameter's name to its (type, description).")
      .def_readonly("name", &RtShader::name, "The name of the shader's class.")
      .def("delete", call(rtDeleteShader));
  py::object type = module.attr("Context");
  auto context = py::reinterpret_borrow<py::class_<RtContext, RtContextPtr>>(type);
  using M = MeshArguments;
  defineMethod(
      context, "mesh", mesh,
      parameterList(requiredParameter("vertices", &M::vertices), parameter("faces", &M::faces)),
      parameterList(parameter("normals", &M::normals), parameter("texcoords", &M::texcoords),
                    parameter("colors", &M::colors), parameter("shader", &M::shader),
                    parameter("name", &M::name), parameter("cull", &M::cull),
                    parameter("replaces", &M::replaces)),
      "Creates an object of triangles. vertices: (n, 3) in float32 or float64. faces: (m, 3); "
      "without faces, every three vertices are a triangle. normals, texcoords, colors: one per "
      "vertex. cull: rays do not hit back faces. replaces: an Object of which this becomes the "
      "definition, in all its instances.");
  context
      .def("sphere", sphere, "radius"_a, py::kw_only(), "shader"_a = none,
           py::arg("name").noconvert() = 0,
           "Creates an object that is an exact sphere around the origin.")
      .def("quadric", quadric, "coefficients"_a, "low"_a, "high"_a, py::kw_only(), "ccw"_a = true,
           "shader"_a = none, py::arg("name").noconvert() = 0,
           "Creates the part of a quadric in the box from low to high: where c[0] x^2 + c[1] y^2 + "
           "c[2] z^2 + c[3] xy + c[4] yz + c[5] zx + c[6] x + c[7] y + c[8] z + c[9] is 0. Its "
           "front is where that is positive; ccw=False exchanges front and back.")
      .def("cylinder", cylinder, "radius"_a, "low"_a, "high"_a, py::kw_only(), "ccw"_a = true,
           "shader"_a = none, py::arg("name").noconvert() = 0,
           "Creates the side of a cylinder about the y axis, from y = low to y = high, without "
           "facets.")
      .def("cone", cone, "low_radius"_a, "high_radius"_a, "low"_a, "high"_a, py::kw_only(),
           "ccw"_a = true, "shader"_a = none, py::arg("name").noconvert() = 0,
           "Creates the side of a truncated cone about the y axis, without facets.")
      .def("asphere", asphere, "curvature"_a, "semi_aperture"_a, py::kw_only(), "conic"_a = 0.0,
           "terms"_a = std::vector<double>{}, "inner_radius"_a = 0.0, "ccw"_a = true,
           "shader"_a = none, py::arg("name").noconvert() = 0,
           "Creates a surface of revolution about the z axis, without facets (rtAsphere). "
           "curvature: 1 / radius at the vertex. terms: factors of r^4, r^6 and so on, at most 8. "
           "The front faces +z.")
      .def("group", group, "parts"_a,
           "Creates an object from other objects. parts: pairs of an object and its matrix.")
      .def("instance", instance, "object"_a, "matrix"_a = none, py::kw_only(), "shader"_a = none,
           py::arg("name").noconvert() = 0, py::arg("user_data").noconvert() = 0,
           "dynamic"_a = false,
           "Places an object in the scene. dynamic: the instance will move often.")
      .def("move_instances", moveInstances, "instances"_a, "matrices"_a,
           "Moves many instances at once. matrices: (n, 4, 4), for column vectors.")
      .def("shader", shader, "name"_a, "library"_a = none,
           "Creates a shader. name: a class of the stock shaders, or of the plug-in library. "
           "Keyword arguments are its parameters.")
      .def("texture", texture, "pixels"_a, py::kw_only(), "srgb"_a = false, "wrap"_a = "repeat",
           "filter"_a = "linear", "border"_a = std::array<float, 4>{},
           "Creates a texture from bytes or floats, first row at the top. wrap: 'repeat', 'mirror' "
           "(every other copy is mirrored), 'clamp' (the edge goes on) or 'border' (beyond the "
           "edges is the linear rgba of border).")
      .def("light", light, "shader"_a, "matrix"_a = none, py::kw_only(), "scope"_a = none,
           "Adds a light to the scene. scope: the only instance that it illuminates.")
      .def("camera", camera, "eye"_a, "at"_a, "up"_a = std::array<double, 3>{0, 1, 0},
           "fov"_a = 45.0, py::kw_only(), "height"_a = none,
           "Sets a camera that looks from eye to at. fov: vertical angle of view in degrees. "
           "height: makes the camera orthographic, with a view of this height.")
      .def(
          "camera_shader",
          [](const RtContextPtr& self, const py::object& s, const py::object& m) {
            role(self, s, m, rtUseCamera);
          },
          "shader"_a, "matrix"_a = none, "Sets a camera shader. None removes the camera.")
      .def(
          "environment",
          [](const RtContextPtr& self, const py::object& s, const py::object& m) {
            role(self, s, m, rtUseEnvironment);
          },
          "shader"_a, "matrix"_a = none,
          "Sets the shader for rays that hit nothing; None removes it.")
      .def(
          "default_shader",
          [](const RtContextPtr& self, const py::object& s) {
            role(self, s, py::none(), rtDefaultShader);
          },
          "shader"_a, "Sets the shader for geometry that has none.");
  module.def("_kept_triangles", keptTriangles);
}
