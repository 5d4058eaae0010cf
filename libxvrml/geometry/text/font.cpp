// font.cpp: one font: layout by HarfBuzz, outlines by FreeType, triangles by the tessellator, with
// a cache of glyphs.
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include <hb-ft.h>
#include <hb-ot.h>

#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "geometry/polygons/tessellator.h"
#include "geometry/text/fonts.h"

namespace xvrml {
namespace {

FT_Library freeType() {
  static FT_Library library = [] {
    FT_Library made = nullptr;
    if (FT_Init_FreeType(&made)) throw std::runtime_error("FreeType does not start");
    return made;
  }();
  return library;
}

// Converts the contours of an outline to polygons. Curves are cut into enough pieces to stay within
// a thousandth of an em.
struct Flattener {
  double scale, slant;
  std::vector<std::vector<V3d>> contours;
  V2d pen{0, 0};

  V2d at(const FT_Vector* v) const {
    return {(double(v->x) + slant * double(v->y)) * scale, double(v->y) * scale};
  }
  void add(const V2d& p) {
    contours.back().push_back({p.x, p.y, 0});
    pen = p;
  }
  static int pieces(double deviation) {
    return std::clamp(int(std::ceil(std::sqrt(deviation / 0.001))), 1, 24);
  }

  static int moveTo(const FT_Vector* to, void* self) {
    auto* f = static_cast<Flattener*>(self);
    f->contours.emplace_back();
    f->add(f->at(to));
    return 0;
  }
  static int lineTo(const FT_Vector* to, void* self) {
    auto* f = static_cast<Flattener*>(self);
    if (f->contours.empty()) f->contours.emplace_back();
    f->add(f->at(to));
    return 0;
  }
  // The distance of a parabola from its chord is a quarter of its second difference.
  static int conicTo(const FT_Vector* control, const FT_Vector* to, void* self) {
    auto* f = static_cast<Flattener*>(self);
    if (f->contours.empty()) f->contours.emplace_back();
    V2d a = f->pen, b = f->at(control), c = f->at(to);
    int n = pieces((a - b * 2 + c).length() / 4);
    for (int i = 1; i <= n; i++) {
      double t = double(i) / n, u = 1 - t;
      f->add(a * (u * u) + b * (2 * u * t) + c * (t * t));
    }
    return 0;
  }
  static int cubicTo(const FT_Vector* control1, const FT_Vector* control2, const FT_Vector* to,
                     void* self) {
    auto* f = static_cast<Flattener*>(self);
    if (f->contours.empty()) f->contours.emplace_back();
    V2d a = f->pen, b = f->at(control1), c = f->at(control2), d = f->at(to);
    int n = pieces(std::max((a - b * 2 + c).length(), (b - c * 2 + d).length()) * 0.75);
    for (int i = 1; i <= n; i++) {
      double t = double(i) / n, u = 1 - t;
      f->add(a * (u * u * u) + b * (3 * u * u * t) + c * (3 * u * t * t) + d * (t * t * t));
    }
    return 0;
  }
};

GlyphMesh tessellate(Flattener& flat) {
  GlyphMesh mesh;
  Tessellator tessellator;
  tessellator.begin({0, 0, 1}, Tessellator::Winding::nonZero);
  for (auto& contour : flat.contours) {
    while (contour.size() > 1 && contour.back() == contour.front()) contour.pop_back();
    if (contour.size() < 3) continue;
    tessellator.contour(contour);
    for (const V3d& p : contour) mesh.points.push_back({float(p.x), float(p.y)});
  }
  if (!tessellator.end()) return {};
  for (const auto& crossing : tessellator.crossings())
    mesh.points.push_back({float(crossing.point.x), float(crossing.point.y)});
  const auto& t = tessellator.triangles();
  auto point = [&](uint32_t i) { return Vec3f{mesh.points[i].x, mesh.points[i].y, 0}; };
  for (size_t i = 0; i + 2 < t.size(); i += 3)
    if (hasArea(point(t[i]), point(t[i + 1]), point(t[i + 2])))
      mesh.indices.insert(mesh.indices.end(), {t[i], t[i + 1], t[i + 2]});
  return mesh;
}

} // namespace

struct Font::Impl {
  FT_Face face = nullptr;
  hb_font_t* font = nullptr;
  double scale = 1; // em per font unit
  bool slant = false, embolden = false;
  std::unordered_map<uint32_t, GlyphMesh> glyphs;

  ~Impl() {
    if (font) hb_font_destroy(font);
    if (face) FT_Done_Face(face);
  }
};

Font::Font(const std::string& file, int faceIndex, bool slant, bool embolden)
    : impl_(std::make_unique<Impl>()) {
  if (FT_New_Face(freeType(), file.c_str(), faceIndex, &impl_->face))
    throw std::runtime_error("cannot read font " + file);
  if (!FT_IS_SCALABLE(impl_->face) || impl_->face->units_per_EM == 0)
    throw std::runtime_error("no outlines in font " + file);
  impl_->scale = 1.0 / impl_->face->units_per_EM;
  impl_->slant = slant;
  impl_->embolden = embolden;
  hb_face_t* face = hb_ft_face_create_referenced(impl_->face);
  impl_->font = hb_font_create(face); // takes its metrics from the font's tables, in font units
  hb_ot_font_set_funcs(impl_->font);
  hb_font_set_scale(impl_->font, impl_->face->units_per_EM, impl_->face->units_per_EM);
  hb_face_destroy(face);
}

Font::~Font() = default;

double Font::ascender() const { return impl_->face->ascender * impl_->scale; }
double Font::descender() const { return impl_->face->descender * impl_->scale; }

ShapedLine Font::shape(const std::string& utf8, TextDirection direction,
                       const std::string& language) {
  static constexpr hb_direction_t directions[] = {HB_DIRECTION_LTR, HB_DIRECTION_RTL,
                                                  HB_DIRECTION_TTB, HB_DIRECTION_BTT};
  std::string text = utf8;
  for (char& c : text)
    if ((unsigned char)c < 0x20 || c == 0x7f) c = ' '; // line ends and tabs have no glyph
  std::unique_ptr<hb_buffer_t, void (*)(hb_buffer_t*)> buffer(hb_buffer_create(),
                                                              hb_buffer_destroy);
  hb_buffer_add_utf8(buffer.get(), text.data(), int(text.size()), 0, int(text.size()));
  hb_buffer_guess_segment_properties(buffer.get());
  hb_buffer_set_direction(buffer.get(), directions[size_t(direction)]);
  if (!language.empty())
    hb_buffer_set_language(buffer.get(),
                           hb_language_from_string(language.c_str(), int(language.size())));
  hb_shape(impl_->font, buffer.get(), nullptr, 0);
  unsigned count = 0;
  const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer.get(), &count);
  const hb_glyph_position_t* positions = hb_buffer_get_glyph_positions(buffer.get(), &count);
  ShapedLine line;
  line.glyphs.reserve(count);
  for (unsigned i = 0; i < count; i++) {
    line.glyphs.push_back({infos[i].codepoint, line.advanceX + positions[i].x_offset * impl_->scale,
                           line.advanceY + positions[i].y_offset * impl_->scale});
    line.advanceX += positions[i].x_advance * impl_->scale;
    line.advanceY += positions[i].y_advance * impl_->scale;
  }
  return line;
}

const GlyphMesh& Font::glyph(uint32_t id) {
  auto found = impl_->glyphs.find(id);
  if (found != impl_->glyphs.end()) return found->second;
  if (impl_->glyphs.size() > 20000) impl_->glyphs.clear();
  GlyphMesh mesh;
  if (!FT_Load_Glyph(impl_->face, id, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP) &&
      impl_->face->glyph->format == FT_GLYPH_FORMAT_OUTLINE) {
    FT_Outline& outline = impl_->face->glyph->outline;
    if (impl_->embolden) FT_Outline_Embolden(&outline, impl_->face->units_per_EM / 24);
    Flattener flat{impl_->scale, impl_->slant ? 0.2 : 0, {}, {0, 0}};
    FT_Outline_Funcs functions{
        Flattener::moveTo, Flattener::lineTo, Flattener::conicTo, Flattener::cubicTo, 0, 0};
    if (!FT_Outline_Decompose(&outline, &functions, &flat)) mesh = tessellate(flat);
  }
  return impl_->glyphs.emplace(id, std::move(mesh)).first->second;
}

} // namespace xvrml
