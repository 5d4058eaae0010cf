// version1.cpp: converts documents of glTF 1.0 (Khronos, 2016), whose objects refer to each other
// by name. Whatever does not fit is left out here, or reported by the reader of version 2.
#include "parse/mesh/gltf/version1.h"
#include "srgb.h"

#include <unordered_map>

namespace xvrml::gltf {
namespace {

using Names = std::unordered_map<std::string, size_t>;

class Converter {
 public:
  explicit Converter(Json& document) : document_(document) {}

  bool convert() {
    const bool moves = has("animations") || has("skins");
    document_.erase("animations");
    document_.erase("skins");
    for (const char* kind : {"accessors", "bufferViews", "buffers", "cameras", "images",
                             "materials", "meshes", "nodes", "samplers", "scenes", "textures"})
      listOf(kind);
    replace(document_, "scene", "scenes");
    each("bufferViews", [&](Json& view) { replace(view, "buffer", "buffers"); });
    each("textures", [&](Json& texture) {
      replace(texture, "source", "images");
      replace(texture, "sampler", "samplers");
    });
    each("scenes", [&](Json& scene) { replaceAll(scene, "nodes", "nodes"); });
    each("accessors", [&](Json& accessor) { convertAccessor(accessor); });
    each("meshes", [&](Json& mesh) { convertMesh(mesh); });
    each("nodes", [&](Json& node) { convertNode(node); });
    for (Json& node : below_) document_["nodes"].push_back(std::move(node));
    each("materials", [&](Json& material) { convertMaterial(material); });
    document_["asset"]["version"] = "2.0";
    return moves;
  }

 private:
  bool has(const char* key) const {
    const auto found = document_.find(key);
    return found != document_.end() && found->is_object() && !found->empty();
  }

  // Makes a list of the objects of a kind, and remembers their places.
  void listOf(const char* kind) {
    Json list = Json::array();
    if (const auto found = document_.find(kind); found != document_.end() && found->is_object()) {
      for (auto& member : found->items()) {
        names_[kind].emplace(member.key(), list.size());
        if (member.value().is_object() && !member.value().contains("name"))
          member.value()["name"] = member.key();
        list.push_back(std::move(member.value()));
      }
    }
    document_[kind] = std::move(list);
  }

  template <class Change> void each(const char* kind, Change change) {
    Json& list = document_[kind];
    for (size_t i = 0; i < list.size(); ++i)
      if (list[i].is_object()) change(list[i]);
  }

  const size_t* placeOf(const Json& name, const char* kind) const {
    if (!name.is_string()) return nullptr;
    const auto names = names_.find(kind);
    if (names == names_.end()) return nullptr;
    const auto found = names->second.find(name.get_ref<const std::string&>());
    return found == names->second.end() ? nullptr : &found->second;
  }

  // Changes a name to its index; removes it if it names nothing.
  void replace(Json& holder, const char* key, const char* kind) {
    const auto found = holder.find(key);
    if (found == holder.end()) return;
    if (const size_t* place = placeOf(*found, kind))
      *found = *place;
    else
      holder.erase(found);
  }

  void replaceAll(Json& holder, const char* key, const char* kind) {
    const auto found = holder.find(key);
    if (found == holder.end() || !found->is_array()) return;
    Json places = Json::array();
    for (const Json& name : *found)
      if (const size_t* place = placeOf(name, kind)) places.push_back(*place);
    *found = std::move(places);
  }

  // The stride moves from the accessor to a view of its own.
  void convertAccessor(Json& accessor) {
    replace(accessor, "bufferView", "bufferViews");
    const auto stride = accessor.find("byteStride");
    if (stride == accessor.end() || !stride->is_number_unsigned() || *stride == 0 ||
        !accessor.contains("bufferView"))
      return;
    const Json& old = document_["bufferViews"][accessor["bufferView"].get<size_t>()];
    if (!old.is_object()) return;
    Json view = {{"byteStride", *stride}};
    for (const char* key : {"buffer", "byteOffset", "byteLength"})
      if (old.contains(key) && old[key].is_number()) view[key] = old[key];
    accessor["bufferView"] = document_["bufferViews"].size();
    document_["bufferViews"].push_back(std::move(view));
  }

  void convertMesh(Json& mesh) {
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) return;
    for (Json& primitive : *primitives) {
      if (!primitive.is_object()) continue;
      replace(primitive, "indices", "accessors");
      replace(primitive, "material", "materials");
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end() || !attributes->is_object()) continue;
      Json converted = Json::object();
      for (const auto& member : attributes->items())
        if (const size_t* place = placeOf(member.value(), "accessors"))
          converted[member.key() == "COLOR" ? "COLOR_0" : member.key()] = *place;
      *attributes = std::move(converted);
    }
  }

  // A node of version 1 shows several meshes; all but the first get nodes below it.
  void convertNode(Json& node) {
    replaceAll(node, "children", "nodes");
    replace(node, "camera", "cameras");
    for (const char* key : {"skin", "skeletons", "mesh"}) node.erase(key);
    replaceAll(node, "meshes", "meshes");
    const auto meshes = node.find("meshes");
    if (meshes == node.end() || !meshes->is_array() || meshes->empty()) return;
    node["mesh"] = (*meshes)[0];
    if (!node.contains("children") || !node["children"].is_array())
      node["children"] = Json::array();
    const size_t nodes = document_["nodes"].size();
    for (size_t i = 1; i < node["meshes"].size(); ++i) {
      node["children"].push_back(nodes + below_.size());
      below_.push_back(Json{{"mesh", node["meshes"][i]}});
    }
  }

  // Colours of version 1 are shown as they are, those of version 2 are linear.
  static Json decoded(Json color) {
    for (size_t i = 0; i < 3 && i < color.size(); ++i)
      if (color[i].is_number()) color[i] = decodeSrgb(color[i].get<double>());
    return color;
  }

  // The values of the usual techniques: a colour or the name of a texture each.
  void convertMaterial(Json& material) {
    Json values = Json::object();
    if (const auto own = material.find("values"); own != material.end() && own->is_object())
      values = *own;
    const Json::json_pointer common("/extensions/KHR_materials_common/values");
    if (material.contains(common) && material[common].is_object()) values = material[common];
    material.erase("extensions");
    Json pbr = {{"metallicFactor", 0}, {"roughnessFactor", 1}};
    if (const auto diffuse = values.find("diffuse"); diffuse != values.end()) {
      if (const size_t* texture = placeOf(*diffuse, "textures"))
        pbr["baseColorTexture"] = {{"index", *texture}};
      else if (diffuse->is_array())
        pbr["baseColorFactor"] = decoded(*diffuse);
    }
    if (const auto emission = values.find("emission");
        emission != values.end() && emission->is_array() && emission->size() >= 3)
      material["emissiveFactor"] = decoded({(*emission)[0], (*emission)[1], (*emission)[2]});
    material["pbrMetallicRoughness"] = std::move(pbr);
    material["doubleSided"] = true;
  }

  Json& document_;
  std::unordered_map<std::string, Names> names_;
  std::vector<Json> below_; // nodes that version 1 does not need
};

} // namespace

bool convertVersion1(Json& document) { return Converter(document).convert(); }

} // namespace xvrml::gltf
