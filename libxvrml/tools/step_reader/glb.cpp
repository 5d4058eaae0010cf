// glb.cpp: writes models as binary glTF.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "model.h"

namespace xvrml::decoding {
namespace {

using Json = nlohmann::json;

constexpr uint32_t magic = 0x46546c67, jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942;
constexpr int floats = 5126, unsignedInts = 5125; // glTF 2.0, 3.6.2.2
constexpr uint64_t mostBytes = 0xffffffff;        // lengths in the file have 32 bits

class Writer {
 public:
  explicit Writer(Model& model) : model_(model) {}

  GlbParts write(const std::string& generator) {
    Json document = {{"asset", {{"version", "2.0"}, {"generator", generator}}}};
    for (const Model::Material& material : model_.materials)
      document["materials"].push_back(materialOf(material));
    for (Mesh& mesh : model_.meshes) document["meshes"].push_back(meshOf(mesh));
    for (const ModelNode& node : model_.nodes) document["nodes"].push_back(nodeOf(node));
    document["scenes"] = {{{"nodes", model_.roots}}};
    document["scene"] = 0;
    document["extensionsUsed"] = {"KHR_materials_specular"};
    document["accessors"] = std::move(accessors_);
    document["bufferViews"] = std::move(views_);
    document["buffers"] = {{{"byteLength", numbers_.size()}}};
    std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const uint64_t all = 12 + 8 + text.size() + 8 + numbers_.size();
    if (all > mostBytes) throw std::runtime_error("it has more than 4 GB of triangles");
    GlbParts parts;
    for (const uint64_t word :
         {uint64_t(magic), uint64_t(2), all, uint64_t(text.size()), uint64_t(jsonChunk)})
      addWord(parts.head, word);
    parts.head += text;
    addWord(parts.head, numbers_.size());
    addWord(parts.head, binaryChunk);
    parts.numbers = std::move(numbers_);
    return parts;
  }

 private:
  static void addWord(std::string& to, uint64_t word) {
    const auto word32 = uint32_t(word);
    to.append(reinterpret_cast<const char*>(&word32), sizeof word32);
  }

  // A file says a colour and no more: a surface without highlights.
  static Json materialOf(const Model::Material& m) {
    Json out = {{"pbrMetallicRoughness",
                 {{"baseColorFactor", m}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}},
                {"doubleSided", true}};
    if (m[3] < 1) out["alphaMode"] = "BLEND";
    return out;
  }

  static Json nodeOf(const ModelNode& node) {
    Json out = Json::object();
    if (!node.name.empty()) out["name"] = node.name;
    if (node.translation != std::array<double, 3>{}) out["translation"] = node.translation;
    if (node.rotation != std::array<double, 4>{0, 0, 0, 1}) out["rotation"] = node.rotation;
    if (node.scale != 1) out["scale"] = {node.scale, node.scale, node.scale};
    if (node.mesh) out["mesh"] = *node.mesh;
    if (!node.children.empty()) out["children"] = node.children;
    return out;
  }

  Json meshOf(Mesh& mesh) {
    Json primitives = Json::array();
    for (Primitive& from : mesh.primitives) {
      Primitive primitive = std::move(from); // its memory is free once it is written
      Json positions = vectors(primitive.points);
      std::array<float, 3> least, most;
      least.fill(std::numeric_limits<float>::max());
      most.fill(std::numeric_limits<float>::lowest());
      for (size_t i = 0; i < primitive.points.size(); ++i) {
        least[i % 3] = std::min(least[i % 3], primitive.points[i]);
        most[i % 3] = std::max(most[i % 3], primitive.points[i]);
      }
      positions["min"] = least;
      positions["max"] = most;
      const size_t position = add(std::move(positions));
      const size_t normal = add(vectors(primitive.normals));
      const size_t indices =
          add(accessor(view(primitive.corners), unsignedInts, "SCALAR", primitive.corners.size()));
      primitives.push_back({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                            {"indices", indices},
                            {"material", primitive.material}});
    }
    return {{"name", mesh.name}, {"primitives", std::move(primitives)}};
  }

  Json vectors(const std::vector<float>& values) {
    return accessor(view(values), floats, "VEC3", values.size() / 3);
  }
  static Json accessor(size_t view, int type, const char* shape, size_t count) {
    return {{"bufferView", view}, {"componentType", type}, {"type", shape}, {"count", count}};
  }
  size_t add(Json&& accessor) {
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }
  template <class T> size_t view(const std::vector<T>& values) {
    static_assert(sizeof(T) == 4);
    views_.push_back({{"buffer", 0},
                      {"byteOffset", numbers_.size()},
                      {"byteLength", values.size() * sizeof(T)}});
    numbers_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    if (numbers_.size() > mostBytes) throw std::runtime_error("it has more than 4 GB of triangles");
    return views_.size() - 1;
  }

  Model& model_;
  Json accessors_ = Json::array(), views_ = Json::array();
  std::string numbers_;
};

} // namespace

GlbParts writeGlb(Model&& model, const std::string& generator) {
  return Writer(model).write(generator);
}

} // namespace xvrml::decoding
