// obj.cpp: Wavefront OBJ with its MTL file: triangles, lines and points of a world in its
// coordinates, with materials and pictures.
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "libpicture/export/beside.h"
#include "libpicture/export/export.h"
#include "libpicture/export/pictures.h"
#include "libpicture/export/placed_vertices.h"
#include "libpicture/export/surface.h"
#include "libpicture/export/walk_options.h"

namespace picture {

namespace {

using Kind = xvrml::GeometryArrays::Kind;

// Names are words of letters, digits and a few signs.
std::string wordOf(std::string_view name) {
  std::string word;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.';
    word += plain ? c : '_';
  }
  return word;
}

// Chooses words that differ.
class Words {
 public:
  std::string choose(std::string_view name, const char* instead) {
    const std::string first = name.empty() ? std::string(instead) : wordOf(name);
    std::string word = first;
    while (!taken_.insert(word).second) word = fmt::format("{}_{}", first, ++number_);
    return word;
  }

 private:
  std::set<std::string> taken_;
  uint64_t number_ = 1;
};

// The materials of a file, and its text.
class Materials {
 public:
  explicit Materials(Surfaces& surfaces) : surfaces_(surfaces) {}
  struct Use {
    std::string name;
    Surface surface;
  };
  const Use& use(const xvrml::AppearanceParts& parts, VertexColors colors, bool lines) {
    const auto [found, fresh] = known_.try_emplace({parts.appearance, colors, lines});
    Use& use = found->second;
    if (!fresh) return use;
    use.surface = surfaces_.make(parts, colors, lines);
    use.name = words_.choose(use.surface.name, "material");
    order_.push_back(&use);
    return use;
  }
  // fileOf(place): the name of a picture's file.
  template <class FileOf> std::string text(const FileOf& fileOf) const {
    std::string out = "# vv: colours are sRGB\n";
    for (const Use* use : order_) {
      const Surface& s = use->surface;
      const auto rgb = [&](const char* key, const xvrml::Color& linear) {
        const xvrml::Color c = codeOf(linear);
        fmt::format_to(std::back_inserter(out), "{} {} {} {}\n", key, c.r, c.g, c.b);
      };
      fmt::format_to(std::back_inserter(out), "newmtl {}\n", use->name);
      rgb("Kd", s.lit ? s.color : xvrml::Color{});
      rgb("Ke", s.lit ? s.emission : s.color);
      rgb("Ks", s.specular);
      fmt::format_to(std::back_inserter(out), "Ns {}\nd {}\n", s.exponent, s.opacity);
      if (s.metallic > 0)
        fmt::format_to(std::back_inserter(out), "Pm {}\nPr {}\n", s.metallic, s.roughness);
      if (s.picture) // a surface that is not lit emits its picture
        fmt::format_to(std::back_inserter(out), "{} {}\n", s.lit ? "map_Kd" : "map_Ke",
                       fileOf(s.picture->file));
    }
    return out;
  }

 private:
  using Key = std::tuple<const xvrml::Node*, VertexColors, bool>;
  Surfaces& surfaces_;
  std::map<Key, Use> known_;
  std::vector<const Use*> order_;
  Words words_;
};

class Writer : public xvrml::Renderer {
 public:
  Writer(Materials& materials, Remarks& remarks) : materials_(materials), remarks_(remarks) {}
  xvrml::Visit renderShape(xvrml::nodes::Shape&, const xvrml::RenderState&) override {
    return xvrml::Visit::draw;
  }
  void draw(const xvrml::DrawnShape& shape) override {
    const Kind kind = shape.mesh().kind;
    if (cornersOf(kind) == 0) return;
    const PlacedVertices vertices(shape, remarks_);
    if (vertices.local().empty()) return;
    const auto colors = vertices.local().hasColors() ? VertexColors::opaque : VertexColors::none;
    const Materials::Use& use = materials_.use(shape.appearance(), colors, kind != Kind::triangles);
    if (!use.surface.visible) return;
    if (use.surface.emissivePicture || use.surface.normalPicture ||
        use.surface.metallicRoughnessPicture)
      remarks_.change("pictures other than those of the colour are left out");
    text_.clear();
    write("o {}\nusemtl {}\n", words_.choose(shape.name(), "shape"), use.name);
    addVertices(vertices, use.surface);
    const bool smooth = kind == Kind::triangles && vertices.local().hasNormals();
    if (use.surface.picture) addTexCoords(vertices, *use.surface.picture);
    if (smooth) addNormals(vertices);
    if (kind == Kind::triangles)
      addTriangles(vertices, use.surface.picture.has_value(), smooth);
    else
      addOthers(vertices, cornersOf(kind));
    points_ += vertices.size();
    if (use.surface.picture) texCoords_ += vertices.size();
    if (smooth) normals_ += vertices.size();
    pieces.push_back(std::move(text_));
  }
  std::vector<std::string> pieces;

 private:
  template <class... T> void write(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }

  // A vertex that is too far away for a float stays without a face.
  static float finite(float v) { return std::isfinite(v) ? v : 0; }

  void addVertices(const PlacedVertices& vertices, const Surface& surface) {
    for (size_t i = 0; i < vertices.size(); ++i) {
      const xvrml::Vec3f p = vertices.point(i);
      write("v {} {} {}", finite(p.x), finite(p.y), finite(p.z));
      if (surface.showsVertexColors) {
        const xvrml::Color c = vertices.local().color(i);
        write(" {} {} {}", c.r, c.g, c.b);
      }
      text_ += '\n';
    }
  }

  void addTexCoords(const PlacedVertices& vertices, const SurfacePicture& picture) {
    const auto& [a, b, c, d, e, f] = picture.transform;
    for (size_t i = 0; i < vertices.size(); ++i) {
      const xvrml::Vec2f st = vertices.local().texCoord(i);
      write("vt {} {}\n", finite(a * st.x + c * st.y + e), finite(b * st.x + d * st.y + f));
    }
  }

  void addNormals(const PlacedVertices& vertices) {
    for (size_t i = 0; i < vertices.size(); ++i) {
      const xvrml::Vec3f n = vertices.normal(i);
      write("vn {} {} {}\n", n.x, n.y, n.z);
    }
  }

  // Indices count from 1 over the whole file.
  void addTriangles(const PlacedVertices& vertices, bool textured, bool smooth) {
    for (size_t t = 0; t < vertices.triangles(); ++t) {
      if (!vertices.isFinite(t)) continue;
      text_ += 'f';
      for (const uint32_t corner : vertices.triangle(t)) {
        write(" {}", points_ + corner + 1);
        if (textured)
          write("/{}", texCoords_ + corner + 1);
        else if (smooth)
          text_ += '/';
        if (smooth) write("/{}", normals_ + corner + 1);
      }
      text_ += '\n';
    }
  }

  void addOthers(const PlacedVertices& vertices, size_t corners) {
    const auto indices = vertices.local().indices();
    for (size_t i = 0; i + corners <= indices.size(); i += corners) {
      text_ += corners == 2 ? 'l' : 'p';
      for (size_t k = 0; k < corners; ++k) write(" {}", points_ + indices[i + k] + 1);
      text_ += '\n';
    }
  }

  Materials& materials_;
  Remarks& remarks_;
  Words words_;
  std::string text_;
  uint64_t points_ = 0, texCoords_ = 0, normals_ = 0; // written so far
};

} // namespace

Exported exportObj(const xvrml::World& world, const ExportSettings& settings) {
  Remarks remarks;
  Pictures pictures(world, remarks);
  Surfaces surfaces(pictures, settings.shaderPath, remarks);
  Materials materials(surfaces);
  Writer writer(materials, remarks);
  xvrml::render(world, writer, walkOptions());
  Exported exported;
  exported.files.push_back({settings.path, {"# vv: metres, y is up\n"}});
  if (hasFilesBeside(settings.path)) {
    NamesBeside names(settings.path, pictures.inputs());
    std::vector<std::string> files;
    for (const PictureFile& picture : pictures.files()) {
      files.push_back(
          names.choose(fmt::format("_{}", files.size()), picture.isPng ? ".png" : ".jpg"));
      exported.files.push_back({names.pathOf(files.back()), {picture.bytes}});
    }
    const std::string library = names.choose("", ".mtl");
    exported.files.push_back(
        {names.pathOf(library), {materials.text([&](size_t i) { return files[i]; })}});
    exported.files[0].pieces.push_back(fmt::format("mtllib {}\n", library));
  } else {
    remarks.change("materials are left out, because no file can be beside the text");
  }
  for (std::string& piece : writer.pieces) exported.files[0].pieces.push_back(std::move(piece));
  exported.remarks = remarks.sentences("OBJ");
  return exported;
}

} // namespace picture
