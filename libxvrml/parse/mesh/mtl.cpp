// mtl.cpp: reads MTL files (Wavefront, "MTL material format", 1995) with the physical extension of
// Clara.io, and writes materials: Material, or PhysicalMaterial if the extension is used.
#include "parse/mesh/mtl.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "parse/mesh/text_cursor.h"
#include "parse/source.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

constexpr size_t mostMaterials = 1'000'000;

class MtlReader {
 public:
  // locator: of the MTL file.
  MtlReader(std::string_view text, std::string path, Locator& locator, ObjMaterials& materials)
      : text_(text), path_(std::move(path)), locator_(locator), materials_(materials) {}

  void read() {
    for (; !text_.atEnd(); text_.nextLine()) {
      if (text_.atLineEnd()) continue;
      at_ = text_.at();
      const std::string word = lowerKeyword(text_.word()); // programs write them in any case
      if (word[0] == '#') continue;
      if (word == "newmtl")
        begin(text_.rest());
      else if (material_)
        statement(word);
    }
    opaque_.report(locator_, Severity::warning,
                   "statements Tr 1 without a d: taken as opaque, as the programs that write them "
                   "mean it");
    bad_.report(locator_, Severity::warning,
                "statements without the numbers that they need are "
                "left out");
    maps_.report(locator_, Severity::warning,
                 "maps that this program does not know (only map_Kd, map_Ke and norm are) are left "
                 "out");
  }

 private:
  void begin(std::string_view name) {
    if (materials_.size() >= mostMaterials)
      throw MeshFault{at_, fmt::format("more than {} materials", mostMaterials)};
    // The first definition counts, as where a library is named twice.
    const auto [it, fresh] = materials_.try_emplace(std::string(name.substr(0, 1000)));
    material_ = fresh ? &it->second : nullptr;
    if (material_) material_->library = path_;
  }

  void statement(std::string_view word) {
    ObjMaterial& m = *material_;
    if (word == "kd")
      m.hasDiffuse = color(m.diffuse) || m.hasDiffuse;
    else if (word == "ks")
      color(m.specular);
    else if (word == "ke")
      color(m.emissive);
    else if (word == "ns")
      number(m.exponent);
    else if (word == "d")
      dissolve(m);
    else if (word == "tr")
      transparency(m);
    else if (word == "illum")
      illumination(m);
    else if (word == "pr")
      m.physical = number(m.roughness) || m.physical;
    else if (word == "pm")
      m.physical = number(m.metallic) || m.physical;
    else if (word == "map_kd")
      map(m.diffuseMap);
    else if (word == "map_ke")
      map(m.emissiveMap);
    else if (word == "norm")
      map(m.normalMap);
    else if (word.starts_with("map_") || word == "bump" || word == "disp" || word == "decal")
      maps_.add(at_);
  }

  bool number(float& out) {
    float value = 0;
    if (!text_.number(value)) {
      bad_.add(at_);
      return false;
    }
    out = value;
    return true;
  }

  // "r g b", or "r" for a grey. Spectral curves and CIE XYZ are left out.
  bool color(Color& out) {
    Color value;
    if (!number(value.r)) return false;
    value.g = value.b = value.r;
    if (!text_.atLineEnd() && !(number(value.g) && number(value.b))) return false;
    const auto inRange = [](float part) { return std::clamp(part, 0.0f, 1.0f); };
    out = {inRange(value.r), inRange(value.g), inRange(value.b)};
    return true;
  }

  void dissolve(ObjMaterial& m) { // "d 0.5", "d -halo 0.5"
    const char* before = text_.at();
    if (text_.word() != "-halo") text_.seek(before);
    m.hasDissolve = number(m.opacity) || m.hasDissolve;
  }

  // Tr is not in the format. It is 1 - d to most programs, and d to others, which write "Tr 1" for
  // what is opaque. So d decides where both are given, and Tr never hides a material.
  void transparency(ObjMaterial& m) {
    float value = 0;
    if (!number(value) || m.hasDissolve) return;
    if (value >= 1) opaque_.add(at_);
    m.opacity = value >= 1 ? 1 : 1 - value;
  }

  void illumination(ObjMaterial& m) {
    float model = 2;
    if (number(model)) m.illumination = int(std::clamp(model, 0.0f, 100.0f));
  }

  // "map_Kd -s 2 2 1 -o 0.5 0 -clamp on file name.png": options come first. Each takes up to so
  // many arguments; numbers may be fewer.
  void map(ObjTexture& texture) {
    texture = {};
    while (!text_.atLineEnd()) {
      const char* before = text_.at();
      const std::string_view word = text_.word();
      if (word.size() < 2 || word[0] != '-') {
        text_.seek(before);
        break;
      }
      if (word == "-clamp")
        texture.clamp = text_.word() == "on";
      else if (word == "-s")
        vector(texture.scale);
      else if (word == "-o")
        vector(texture.offset);
      else if (word == "-t" || word == "-mm" || word == "-bm" || word == "-boost" ||
               word == "-texres")
        skipNumbers();
      else if (word == "-blendu" || word == "-blendv" || word == "-cc" || word == "-imfchan" ||
               word == "-type")
        text_.word();
      else {
        text_.seek(before); // a file name that begins with a minus
        break;
      }
    }
    texture.file = std::string(text_.rest());
    if (texture.file.empty()) bad_.add(at_);
  }

  void vector(Vec2f& out) {
    float third = 0;
    if (text_.number(out.x) && text_.number(out.y)) text_.number(third);
  }
  void skipNumbers() {
    float number = 0;
    for (int i = 0; i < 3 && text_.number(number); ++i) {}
  }

  TextCursor text_;
  const std::string path_;
  Locator& locator_;
  ObjMaterials& materials_;
  ObjMaterial* material_ = nullptr;
  const char* at_ = nullptr;
  FaultCount bad_, maps_, opaque_;
};

// Names of files may hold '#', which begins a fragment in a URL.
std::string urlOfName(std::string_view name) {
  std::string url;
  for (const char c : name) c == '#' ? url += "%23" : url += c;
  return url;
}

// Returns the URLs under which a picture is looked for: the file's own, and the bare name, because
// many programs write the folders of their own machine.
MFString urlsOf(const ObjTexture& texture, const MeshFile& file, const std::string& library) {
  MFString urls{urlOfName(texture.file)};
  std::string bare = urls[0].substr(urls[0].find_last_of("/\\") + 1);
  if (!bare.empty() && bare != urls[0]) urls.push_back(std::move(bare));
  rebaseUrls(urls, library, file.path);
  return urls;
}

void writeTexture(NodeStream& nodes, std::string_view field, const ObjTexture& texture,
                  const MeshFile& file, const std::string& library) {
  if (texture.file.empty()) return;
  nodes.openIn(field, "ImageTexture");
  nodes.set("url", urlsOf(texture, file, library));
  if (texture.clamp) {
    nodes.set("repeatS", false);
    nodes.set("repeatT", false);
  }
  nodes.closeIn();
}

// Programs scale texture coordinates first and then add the offset; a TextureTransform adds its
// translation first (ISO/IEC 14772-1 6.48).
void writeTextureTransform(NodeStream& nodes, const ObjTexture& texture) {
  const bool plain = texture.scale == Vec2f{1, 1} && texture.offset == Vec2f{0, 0};
  if (texture.file.empty() || plain) return;
  nodes.openIn("textureTransform", "TextureTransform");
  const auto before = [](float offset, float scale) { return scale == 0 ? 0 : offset / scale; };
  nodes.set("scale", texture.scale);
  nodes.set("translation", Vec2f{before(texture.offset.x, texture.scale.x),
                                 before(texture.offset.y, texture.scale.y)});
  nodes.closeIn();
}

float transparencyOf(const ObjMaterial& m) { return std::clamp(1 - m.opacity, 0.0f, 1.0f); }

bool isBlack(const Color& color) { return color == Color{}; }

// The colour that the picture is multiplied with. Some programs write black beside a picture.
Color diffuseOf(const ObjMaterial& m) {
  const bool alone = !m.diffuseMap.file.empty() && (!m.hasDiffuse || isBlack(m.diffuse));
  return alone ? Color{1, 1, 1} : m.diffuse;
}

void writePhysical(NodeStream& nodes, const MeshFile& file, const ObjMaterial& m) {
  nodes.openIn("material", "PhysicalMaterial");
  nodes.set("baseColor", diffuseOf(m));
  nodes.set("metallic", std::clamp(m.metallic, 0.0f, 1.0f));
  nodes.set("roughness", std::clamp(m.roughness, 0.0f, 1.0f));
  nodes.set("emissiveColor", m.emissive);
  nodes.set("transparency", transparencyOf(m));
  writeTexture(nodes, "baseTexture", m.diffuseMap, file, m.library);
  writeTexture(nodes, "emissiveTexture", m.emissiveMap, file, m.library);
  writeTexture(nodes, "normalTexture", m.normalMap, file, m.library);
  nodes.closeIn();
}

// Phong's exponent is 128 times shininess (ISO/IEC 14772-1 4.14).
void writePhong(NodeStream& nodes, const MeshFile& file, const ObjMaterial& m) {
  nodes.openIn("material", "Material");
  nodes.set("diffuseColor", diffuseOf(m));
  const bool shines = m.illumination >= 2 && m.exponent > 0 && !isBlack(m.specular);
  if (shines) {
    nodes.set("specularColor", m.specular);
    nodes.set("shininess", std::clamp(m.exponent / 128, 0.0f, 1.0f));
  }
  if (!isBlack(m.emissive)) nodes.set("emissiveColor", m.emissive);
  if (transparencyOf(m) > 0) nodes.set("transparency", transparencyOf(m));
  nodes.closeIn();
  writeTexture(nodes, "texture", m.diffuseMap, file, m.library);
}

void writeUnlit(NodeStream& nodes, const ObjMaterial* m) {
  nodes.openIn("appearance", "Appearance");
  nodes.openIn("material", "Material");
  nodes.set("emissiveColor", m ? m->diffuse : Color{1, 1, 1});
  nodes.closeIn();
  nodes.closeIn();
}

} // namespace

void readMtl(const MeshFile& file, std::string_view name, const char* at, ObjMaterials& materials) {
  const ResolvedUrl resolved = resolveUrl(urlOfName(name), file.path, file.options);
  if (!resolved.error.empty()) throw MeshFault{at, resolved.error};
  try {
    const Source source = Source::open(resolved.path, file.options.limits, file.budget);
    const auto path = std::make_shared<const std::string>(resolved.path);
    Locator locator(source.text(), path, file.locator.diagnostics());
    MtlReader(withoutDosEnd(source.text()), resolved.path, locator, materials).read();
  } catch (const LoadError& error) { throw MeshFault{at, error.diagnostic.text()}; }
}

void writeObjAppearance(NodeStream& nodes, const MeshFile& file, ObjMaterials& materials,
                        const std::string& name, bool lit) {
  auto found = materials.find(name);
  if (found == materials.end()) { // names may hold '#', but a comment may follow, too
    std::string_view bare = std::string_view(name).substr(0, name.find('#'));
    while (!bare.empty() && TextCursor::isSpace(bare.back())) bare.remove_suffix(1);
    found = materials.find(std::string(bare));
  }
  ObjMaterial* m = found == materials.end() ? nullptr : &found->second;
  if (!lit) return writeUnlit(nodes, m);
  if (m && !m->def.empty()) return nodes.useIn("appearance", m->def);
  if (m) m->def = nodes.define(name, "Material");
  nodes.openIn("appearance", "Appearance", m ? std::string_view(m->def) : std::string_view());
  if (!m) {
    nodes.openIn("material", "Material");
    nodes.closeIn();
  } else {
    m->physical&& nodes.knows("PhysicalMaterial") ? writePhysical(nodes, file, *m)
                                                  : writePhong(nodes, file, *m);
    writeTextureTransform(nodes, m->diffuseMap);
  }
  nodes.closeIn();
}

} // namespace xvrml
