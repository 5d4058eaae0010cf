// looks.cpp: lists of materials, textures, and the order of their transformation.
#include "parse/vrml1/looks.h"

#include <algorithm>
#include <cmath>

namespace xvrml::vrml1 {
namespace {

const TreeNode& materialOf(State& state) {
  const TreeNode* node = state.node(Slot::material);
  return node ? *node : defaultNode(Kind::material);
}

// Returns a value of a list; a shorter list begins again.
template <class T> T at(const std::vector<T>& list, size_t index, T ifEmpty) {
  return list.empty() ? ifEmpty : list[index % list.size()];
}

float sum(const SFColor& c) { return c.r + c.g + c.b; }

bool isBlack(const MFColor& colors) {
  return std::all_of(colors.begin(), colors.end(), [](const SFColor& c) { return sum(c) == 0; });
}

// Returns whether the colours are those of precomputed lighting: a Material that has emissive
// colours only ("Material" of the specification). Files write black for no colours, too.
bool isPrecomputed(const TreeNode& material) {
  const MFColor& diffuse = material.get<MFColor>("diffuseColor");
  if (material.get<MFColor>("emissiveColor").empty()) return false;
  return diffuse.empty() || (isBlack(diffuse) && isBlack(material.get<MFColor>("specularColor")));
}

SFColor diffuse(const TreeNode& material, size_t index) {
  return at(material.get<MFColor>("diffuseColor"), index,
            isPrecomputed(material) ? SFColor{} : SFColor{0.8f, 0.8f, 0.8f});
}

SFColor emissive(const TreeNode& material, size_t index) {
  return at(material.get<MFColor>("emissiveColor"), index, SFColor{});
}

// VRML97 has no ambient colour: ambientIntensity is its share of the diffuse colour.
float ambientIntensity(const TreeNode& material, size_t index) {
  const float whole = sum(diffuse(material, index));
  if (!(whole > 0)) return 0;
  return std::clamp(sum(at(material.get<MFColor>("ambientColor"), index, SFColor{})) / whole, 0.0f,
                    1.0f);
}

// Lines and points have the colour that shines by itself or, if that is black, the diffuse one.
SFColor lineColour(const TreeNode& material, size_t index) {
  const SFColor own = emissive(material, index);
  return sum(own) > 0 ? own : diffuse(material, index);
}

SFColor surfaceColour(const TreeNode& material, size_t index) {
  return isPrecomputed(material) ? emissive(material, index) : diffuse(material, index);
}

} // namespace

Looks::List& Looks::list(State& state) {
  const TreeNode& material = materialOf(state);
  const auto [found, fresh] = lists_.try_emplace(&material);
  List& list = found->second;
  if (!fresh) return list;
  for (const Value& value : material.values) {
    std::visit(
        [&](const auto& values) {
          if constexpr (
              requires { values.size(); } && !requires { values.c_str(); })
            list.count = std::max(list.count, values.size());
        },
        value);
  }
  // Holds what a Color node cannot say. A list of ambient colours mostly holds a constant share of
  // each colour, rounded as files do it; one ambient colour for all is no difference, either.
  using Rest = std::tuple<long, float, float, float, float, float, float, float, float>;
  std::map<Rest, uint32_t> seen;
  const bool precomputed = isPrecomputed(material);
  const bool severalAmbient = material.get<MFColor>("ambientColor").size() > 1;
  for (size_t i = 0; i < list.count; ++i) {
    const SFColor specular = at(material.get<MFColor>("specularColor"), i, SFColor{});
    const SFColor own = precomputed ? SFColor{} : emissive(material, i);
    const Rest rest{severalAmbient ? std::lround(ambientIntensity(material, i) * 16) : 0,
                    specular.r,
                    specular.g,
                    specular.b,
                    own.r,
                    own.g,
                    own.b,
                    at(material.get<MFFloat>("shininess"), i, 0.2f),
                    at(material.get<MFFloat>("transparency"), i, 0.0f)};
    list.first.push_back(seen.try_emplace(rest, uint32_t(i)).first->second);
  }
  list.uniform = seen.size() == 1;
  return list;
}

SFColor Looks::colour(State& state, size_t index, Use use) {
  const TreeNode& material = materialOf(state);
  return use == Use::lines ? lineColour(material, index) : surfaceColour(material, index);
}

NodeRef Looks::colours(const TreeNode& from, State& state, Use use) {
  List& all = list(state);
  NodeRef& made = use == Use::lines ? all.lineColours : all.colours;
  if (made) return made;
  auto* node = graph_.make<nodes::Color>(from);
  for (size_t i = 0; i < all.count; ++i) node->color.push_back(colour(state, i, use));
  return made = graph_.finish(node);
}

NodeRef Looks::material(const TreeNode& from, const TreeNode& material, size_t index, Use use) {
  // VRML97 draws a surface without a Material unlit, in the colours of its Color node.
  if (use == Use::colours) {
    if (isPrecomputed(material)) return unlit(from, material, index);
    use = Use::surface; // the Color node takes the place of diffuseColor
  }
  NodeRef& made = materials_[{&material, index, use}];
  if (made) return made;
  auto* node = graph_.make<nodes::Material>(material.at ? material : from);
  node->ambientIntensity = ambientIntensity(material, index);
  node->diffuseColor = diffuse(material, index);
  node->emissiveColor = use == Use::lines ? lineColour(material, index) : emissive(material, index);
  node->specularColor = at(material.get<MFColor>("specularColor"), index, SFColor{});
  node->shininess = at(material.get<MFFloat>("shininess"), index, 0.2f);
  node->transparency = at(material.get<MFFloat>("transparency"), index, 0.0f);
  made = graph_.finish(node);
  graph_.name(made, material);
  return made;
}

// Returns nothing for an opaque surface, else the node of X3D that only VRML97 lacks.
NodeRef Looks::unlit(const TreeNode& from, const TreeNode& material, size_t index) {
  const float transparency = at(material.get<MFFloat>("transparency"), index, 0.0f);
  if (transparency == 0) return {};
  NodeRef& made = materials_[{&material, index, Use::colours}];
  if (made) return made;
  auto* node = graph_.make<nodes::UnlitMaterial>(material.at ? material : from);
  node->transparency = transparency;
  return made = graph_.finish(node);
}

NodeRef Looks::texture(const TreeNode& texture) {
  const auto [found, fresh] = textures_.try_emplace(&texture);
  if (!fresh) return found->second;
  const bool repeatS = texture.get<SFString>("wrapS") != "CLAMP";
  const bool repeatT = texture.get<SFString>("wrapT") != "CLAMP";
  const SFString& file = texture.get<SFString>("filename");
  if (!file.empty()) {
    auto* image = graph_.make<nodes::ImageTexture>(texture);
    image->url = {file};
    image->repeatS = repeatS;
    image->repeatT = repeatT;
    found->second = graph_.finish(image);
  } else if (!texture.get<Image>("image").pixels.empty()) {
    auto* pixels = graph_.make<nodes::PixelTexture>(texture);
    pixels->image = texture.take<Image>("image");
    pixels->repeatS = repeatS;
    pixels->repeatT = repeatT;
    found->second = graph_.finish(pixels);
  }
  if (found->second) graph_.name(found->second, texture);
  return found->second;
}

bool Looks::isTextured(State& state) {
  const TreeNode* node = state.node(Slot::texture);
  return node && texture(*node);
}

// In VRML 1.0 a transformation scales, then turns, then moves ("Texture2Transform"):
// T C R S -C for column vectors.
void Looks::addTransform(State& state, const TreeNode& node) {
  const TextureChain* before = state.textureTransform();
  const auto [found, fresh] = chains_.try_emplace({before, &node}, TextureChain{&node});
  TextureChain& chain = found->second;
  state.set(Slot::textureTransform, &chain);
  if (!fresh) return;
  const Vec2f move = node.get<Vec2f>("translation"), scale = node.get<Vec2f>("scaleFactor"),
              center = node.get<Vec2f>("center");
  const double angle = double(node.get<float>("rotation"));
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const double cx = double(center.x), cy = double(center.y);
  TextureChain own{&node};
  own.a = cosine * double(scale.x);
  own.b = -sine * double(scale.y);
  own.c = sine * double(scale.x);
  own.d = cosine * double(scale.y);
  own.e = cx + double(move.x) - own.a * cx - own.b * cy;
  own.f = cy + double(move.y) - own.c * cx - own.d * cy;
  const TextureChain outer = before ? *before : TextureChain{&node};
  chain.a = outer.a * own.a + outer.b * own.c;
  chain.b = outer.a * own.b + outer.b * own.d;
  chain.c = outer.c * own.a + outer.d * own.c;
  chain.d = outer.c * own.b + outer.d * own.d;
  chain.e = outer.a * own.e + outer.b * own.f + outer.e;
  chain.f = outer.c * own.e + outer.d * own.f + outer.f;
}

namespace {

// Returns whether a TextureTransform of VRML97 can say the transformation: it moves, then turns,
// then scales (6.49), so that the rows of the matrix are orthogonal and none is zero.
bool isSpeakable(const TextureChain& chain) {
  const double first = std::hypot(chain.a, chain.b), second = std::hypot(chain.c, chain.d);
  return first > 0 && second > 0 &&
         std::abs(chain.a * chain.c + chain.b * chain.d) <= 1e-6 * first * second;
}

} // namespace

const TextureChain* Looks::unspeakable(State& state) {
  const TextureChain* chain = state.textureTransform();
  return chain && !isSpeakable(*chain) ? chain : nullptr;
}

// For S R t = (e, f) and S R = ((a, b), (c, d)): the second row is sy (sin, cos) of the angle.
NodeRef Looks::textureTransform(const TreeNode& from, const TextureChain& chain) {
  NodeRef& made = transforms_[&chain];
  if (made) return made;
  auto* node = graph_.make<nodes::TextureTransform>(chain.node->at ? *chain.node : from);
  const double sy = std::hypot(chain.c, chain.d);
  const double angle = std::atan2(chain.c, chain.d);
  const double sx = chain.a * std::cos(angle) - chain.b * std::sin(angle);
  const double determinant = chain.a * chain.d - chain.b * chain.c;
  node->scale = {float(sx), float(sy)};
  node->rotation = float(angle);
  if (determinant != 0)
    node->translation = {float((chain.d * chain.e - chain.b * chain.f) / determinant),
                         float((chain.a * chain.f - chain.c * chain.e) / determinant)};
  return made = graph_.finish(node);
}

NodeRef Looks::appearance(const TreeNode& from, State& state, size_t index, Use use) {
  const TreeNode& material = materialOf(state);
  const TreeNode* picture =
      isTextured(state) && use != Use::lines ? state.node(Slot::texture) : nullptr;
  const TextureChain* chain = picture ? state.textureTransform() : nullptr;
  if (chain && !isSpeakable(*chain)) chain = nullptr;
  NodeRef& made = appearances_[{&material, index, picture, chain, use}];
  if (made) return made;
  auto* node = graph_.make<nodes::Appearance>(from);
  node->material = this->material(from, material, index, use);
  if (picture) node->texture = texture(*picture);
  if (chain) node->textureTransform = textureTransform(from, *chain);
  return made = graph_.finish(node);
}

} // namespace xvrml::vrml1
