#include "tools/scene_export.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace openrt {
namespace {

using Json = nlohmann::ordered_json;

const char* kindName(RtsKind kind) {
  constexpr const char* names[] = {"", "surface", "light", "camera", "environment", "transport"};
  return kind >= RTS_SURFACE && kind <= RTS_TRANSPORT ? names[kind] : "";
}

uint32_t floatsOf(RtsType type) {
  switch (type) {
  case RTS_VEC2: return 2;
  case RTS_VEC3:
  case RTS_COLOR: return 3;
  case RTS_VEC4: return 4;
  case RTS_MATRIX: return 16;
  default: return 1;
  }
}

// A file that is written under a temporary name and renamed once complete. Throws
// std::runtime_error that names the file.
class Output {
 public:
  explicit Output(const std::string& path)
      : path_(path), temporary_(path + ".partial"), file_(std::fopen(temporary_.c_str(), "wbe")) {
    if (!file_) fail();
  }
  ~Output() {
    if (file_) std::fclose(file_);
    if (!named_) std::remove(temporary_.c_str());
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  void write(const void* bytes, size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, file_) != count) fail();
  }
  void close() {
    if (std::fclose(std::exchange(file_, nullptr)) != 0) fail();
  }
  void rename() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
    named_ = true;
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(path_ + " cannot be written: " + std::strerror(errno));
  }
  std::string path_, temporary_;
  std::FILE* file_;
  bool named_ = false;
};

class Export {
 public:
  Export(const Scene& scene, const ShaderRegistry& shaders, const std::string& path)
      : scene_(scene), registry_(shaders), path_(path), bytes_(path + ".bin") {}

  void run() {
    Json all = {{"format", 1},
                {"frame",
                 {{"width", scene_.frame.width},
                  {"height", scene_.frame.height},
                  {"samples", scene_.frame.samples},
                  {"depth", scene_.frame.depth}}}};
    all["meshes"] = meshes();
    all["lights"] = Json::array();
    for (const auto& [id, light] : scene_.lights)
      all["lights"].push_back(role(light.shader, light.matrix));
    all["camera"] = role(scene_.camera.shader, scene_.camera.matrix);
    all["environment"] = role(scene_.environment.shader, scene_.environment.matrix);
    all["shaders"] = Json::object();
    for (const auto& [id, values] : scene_.shaders)
      all["shaders"][std::to_string(id)] = shader(values);
    all["textures"] = Json::object();
    for (const auto& [id, texture] : scene_.textures)
      all["textures"][std::to_string(id)] = image(texture);
    const std::string text = all.dump(1, ' ', false, Json::error_handler_t::replace);
    Output scene(path_);
    scene.write(text.data(), text.size());
    scene.close();
    bytes_.close();
    bytes_.rename();
    scene.rename();
  }

 private:
  static Json role(uint32_t shader, const Matrix4d& matrix) {
    return {{"shader", shader}, {"matrix", matrix.m}};
  }

  // Returns the place of an array in the array file; each array is written once. valueSize: bytes
  // of a value.
  Json writeArray(const ArrayPtr& array, size_t valueSize = 4) {
    if (!array) return nullptr;
    const auto [found, fresh] = offsets_.try_emplace(array.get(), end_);
    if (fresh) {
      const size_t padding = (4 - array->size() % 4) % 4; // every array begins at a multiple of 4
      bytes_.write(array->data(), array->size());
      bytes_.write("\0\0\0", padding);
      end_ += array->size() + padding;
    }
    return {{"offset", found->second}, {"count", array->size() / valueSize}};
  }

  Json mesh(const Geometry& g, const Matrix4d& toWorld, uint32_t shader) {
    constexpr const char* kinds[] = {"triangles", "lines",   "points",
                                     "sphere",    "quadric", "asphere"};
    Json m = {{"kind", kinds[int(g.primitive)]},
              {"shader", shader     ? shader
                         : g.shader ? g.shader
                                    : scene_.defaultShader},
              {"matrix", (toWorld * g.matrix).m},
              {"cull", g.cull},
              {"clockwise", g.clockwise}};
    if (g.primitive == edit::Primitive::Sphere) m["radius"] = g.width;
    if (g.surface) m["surface"] = g.surface->numbers();
    m["points"] = writeArray(g.points);
    m["indices"] = writeArray(g.indices);
    m["normals"] = writeArray(g.normals);
    m["texCoords"] = writeArray(g.texCoords);
    m["colors"] = writeArray(g.colors);
    m["fogCoords"] = writeArray(g.fogCoords);
    return m;
  }

  // Lists the placed geometries. Uses an explicit stack, because instances may be nested deeply.
  Json meshes() {
    constexpr size_t limit = 1'000'000;
    struct Open {
      uint32_t object, shader;
      Matrix4d matrix;
    };
    Json list = Json::array();
    std::vector<Open> open{{0, 0, Matrix4d()}};
    while (!open.empty()) {
      const Open at = open.back();
      open.pop_back();
      if (const auto object = scene_.objects.find(at.object); object != scene_.objects.end())
        for (const Geometry& g : object->second.geometries)
          list.push_back(mesh(g, at.matrix, at.shader));
      if (list.size() > limit) throw std::runtime_error("more than a million placed geometries");
      const std::vector<uint32_t>& children = scene_.childrenOf(at.object);
      for (size_t i = children.size(); i-- > 0;) {
        const Instance& instance = scene_.instances.at(children[i]);
        // The outermost override applies.
        const uint32_t shader = at.shader ? at.shader : instance.shader;
        if (instance.visible)
          open.push_back({instance.object, shader, at.matrix * instance.matrix});
      }
    }
    return list;
  }

  Json shader(const ShaderValues& values) {
    const ShaderClassName& name = scene_.classes.at(values.shaderClass);
    const RtsClass& c = registry_.find(name.name, name.library);
    Json parameters = Json::object();
    for (uint32_t i = 0; i < c.paramCount; i++) {
      const auto set = values.parameters.find(i);
      parameters[c.params[i].name] = value(c.params[i], set ? &*set : nullptr);
    }
    return {{"class", name.name},
            {"library", name.library},
            {"kind", kindName(c.kind)},
            {"parameters", std::move(parameters)}};
  }

  static Json value(const RtsParam& p, const ParameterValue* set) {
    switch (p.type) {
    case RTS_STRING: return set ? set->text : "";
    case RTS_TEXTURE: return set ? set->texture : 0u;
    case RTS_FLOATS: return set ? Json(set->floats) : Json::array();
    case RTS_INT: return set ? set->integer : int(p.defaultValue[0]);
    default: break;
    }
    std::vector<float> floats(p.defaultValue, p.defaultValue + floatsOf(p.type));
    if (set && set->floats.size() == floats.size())
      floats.assign(set->floats.begin(), set->floats.end());
    return floats.size() == 1 ? Json(floats[0]) : Json(floats);
  }

  Json image(const TextureImage& texture) {
    const edit::TextureT& d = texture.description;
    return {{"width", d.width},
            {"height", d.height},
            {"depth", d.depth},
            {"components", d.components},
            {"float", d.isFloat},
            {"srgb", d.srgb},
            {"texels", writeArray(texture.texels, d.isFloat ? sizeof(float) : 1)}};
  }

  const Scene& scene_;
  const ShaderRegistry& registry_;
  const std::string path_;
  Output bytes_;
  std::map<const Array*, size_t> offsets_;
  size_t end_ = 0;
};

} // namespace

void exportScene(const Scene& scene, const ShaderRegistry& shaders, const std::string& path) {
  Export(scene, shaders, path).run();
}

} // namespace openrt
