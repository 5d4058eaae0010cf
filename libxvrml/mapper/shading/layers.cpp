// layers.cpp: reads the modes, sources and functions of a MultiTexture. The numbers of the shader's
// parameter `layers` are the places of the names in the tables below.
#include "mapper/shading/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/node_matrix.h"
#include "xvrml/appearance.h"

namespace xvrml::mapper {
namespace {

constexpr std::string_view modes[] = {"MODULATE",
                                      "REPLACE",
                                      "MODULATE2X",
                                      "MODULATE4X",
                                      "ADD",
                                      "ADDSIGNED",
                                      "ADDSIGNED2X",
                                      "SUBTRACT",
                                      "ADDSMOOTH",
                                      "BLENDDIFFUSEALPHA",
                                      "BLENDTEXTUREALPHA",
                                      "BLENDFACTORALPHA",
                                      "BLENDCURRENTALPHA",
                                      "MODULATEALPHA_ADDCOLOR",
                                      "MODULATEINVALPHA_ADDCOLOR",
                                      "MODULATEINVCOLOR_ADDALPHA",
                                      "OFF",
                                      "SELECTARG1",
                                      "SELECTARG2",
                                      "DOTPRODUCT3"};
constexpr std::string_view sources[] = {"", "DIFFUSE", "SPECULAR", "FACTOR"};
constexpr std::string_view functions[] = {"", "COMPLEMENT", "ALPHAREPLICATE"};
constexpr size_t mostLayers = 8;
const char* const pictures[mostLayers] = {"texture",  "texture1", "texture2", "texture3",
                                          "texture4", "texture5", "texture6", "texture7"};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

class Reader {
 public:
  Reader(const nodes::MultiTexture& node, World& world) : node_(node), world_(world) {}

  // Appends the four numbers of layer i.
  void layer(size_t i, std::vector<float>& numbers) {
    const std::string_view mode = at(node_.mode, i);
    size_t split = mode.find_first_of(",/");
    if (split == mode.npos) split = mode.size();
    const std::string_view color = trimmed(mode.substr(0, split)),
                           alpha = trimmed(mode.substr(std::min(split + 1, mode.size())));
    const float first = color.empty() ? 0 : number(color, modes, "mode");
    numbers.insert(numbers.end(), {first, alpha.empty() ? first : number(alpha, modes, "mode"),
                                   number(at(node_.source, i), sources, "source"),
                                   number(at(node_.function, i), functions, "function")});
  }
  void warn(const std::string& text) {
    world_.diagnostics.warn(node_.Node::source, "MultiTexture: " + text);
  }

 private:
  static std::string_view at(const MFString& list, size_t i) {
    return i < list.size() ? trimmed(list[i]) : std::string_view();
  }
  template <size_t count>
  float number(std::string_view name, const std::string_view (&table)[count], const char* field) {
    for (size_t i = 0; i < count; ++i)
      if (table[i] == name) return float(i);
    warn(std::string(field) + " has \"" + std::string(name.substr(0, 40)) +
         "\", which X3D does not have; expected " + std::string(table[count == 20 ? 0 : 1]) +
         " or another name of ISO/IEC 19775-1 18.4.3; " +
         (table[0].empty() ? "none is used" : "MODULATE is used"));
    return 0;
  }

  const nodes::MultiTexture& node_;
  World& world_;
};

// Appends the sixteen numbers of layerTransforms for the picture i >= 1.
void appendTransform(Node* textureTransform, size_t i, std::vector<float>& numbers) {
  const Matrix m = textureMatrixOf(layerTransform(textureTransform, i));
  const auto isFloat = [](double x) { return std::isfinite(float(x)); };
  const Matrix used = std::all_of(data(m), data(m) + 16, isFloat) ? m : Matrix();
  for (int k = 0; k < 16; ++k) numbers.push_back(float(data(used)[k]));
}

} // namespace

void setLayers(ShaderSetup& shader, Node* texture, Node* textureTransform, std::string_view mapping,
               bool multiplies, const LayerPictures& from, World& world, bool linear) {
  Node* node = renderedNode(texture);
  shader.matrix("textureTransform", textureMatrixOf(firstTransform(textureTransform, mapping)));
  std::array<RTid, mostLayers> ids{};
  std::vector<float> layers, transforms;
  if (const auto* multi = nodeCast<nodes::MultiTexture>(node)) {
    Reader reader(*multi, world);
    if (multi->texture.size() > mostLayers)
      reader.warn("it has " + std::to_string(multi->texture.size()) +
                  " textures, expected at most 8: the first 8 are used");
    for (size_t i = 0; i < std::min(multi->texture.size(), mostLayers); ++i) {
      Node* picture = renderedNode(multi->texture[i].get());
      if (nodeCast<nodes::MultiTexture>(picture))
        reader.warn("texture has another MultiTexture, which is left out");
      else
        ids[i] = from.of(picture);
      reader.layer(i, layers);
      if (i > 0) appendTransform(textureTransform, i, transforms);
    }
    const Color color = convert(multi->color, linear);
    const float factor[4] = {std::clamp(color.r, 0.0f, 1.0f), std::clamp(color.g, 0.0f, 1.0f),
                             std::clamp(color.b, 0.0f, 1.0f), std::clamp(multi->alpha, 0.0f, 1.0f)};
    shader.floats("factor", factor);
  } else {
    ids[0] = from.of(node);
    if (multiplies) layers = {0, 0, 0, 0};
  }
  for (size_t i = 0; i < mostLayers; ++i)
    if (ids[i] != 0 || !shader.fresh()) shader.texture(pictures[i], ids[i]);
  shader.list("layers", layers);
  shader.list("layerTransforms", transforms);
}

} // namespace xvrml::mapper
