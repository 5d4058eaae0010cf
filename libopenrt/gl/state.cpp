// state.cpp: Records vertices, display lists and frames.
#include "gl/state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gl/overlay.h"

namespace rtgl {
namespace {

constexpr int maxListDepth = 64; // OpenGL 1.1, table 6.24
constexpr size_t maxNestedCommands = 10'000'000;
constexpr size_t maxAttributes = 16;

// Applies glColorMaterial: the current colour replaces properties of the material.
void track(const Lighting& lighting, const Color& color, std::array<Face, 2>& faces) {
  for (size_t side = 0; side < 2; side++) {
    if (lighting.colorFace == (side == 0 ? GL_BACK : GL_FRONT)) continue;
    Face& face = faces[side];
    switch (lighting.colorMode) {
    case GL_EMISSION: face.emission = color; break;
    case GL_SPECULAR: face.specular = color; break;
    case GL_AMBIENT: face.ambient = color; break;
    case GL_DIFFUSE: face.diffuse = color; break;
    default: face.ambient = face.diffuse = color; break;
    }
  }
}

void copyColor(const Color& from, float (&to)[3]) { std::copy_n(from.begin(), 3, to); }

LightSet lightsOf(const Lighting& lighting) {
  LightSet set;
  std::array<float, 3> diffuse = {0, 0, 0};
  for (size_t c = 0; c < 3; c++) set.ambient[c] = lighting.ambient[c];
  for (size_t i = 0; i < lightCount; i++) {
    if (!lighting.lights[i].on) continue;
    set.lights[i] = lighting.lights[i];
    for (size_t c = 0; c < 3; c++) {
      set.ambient[c] += lighting.lights[i].ambient[c];
      set.specularShare[c] += lighting.lights[i].specular[c];
      diffuse[c] += lighting.lights[i].diffuse[c];
    }
  }
  for (size_t c = 0; c < 3; c++)
    set.specularShare[c] = diffuse[c] > 0 ? set.specularShare[c] / diffuse[c] : 0;
  return set;
}

// Begins a primitive as a list has it.
void resume(State& s, const Chunk& begun) {
  s.begin(begun.mode);
  for (size_t i = 0; i < begun.vertices.size(); i++) {
    const Vertex& v = begun.vertices[i];
    if (i >= begun.inheritsColor) s.setColor(v.color);
    if (i >= begun.inheritsNormal) s.setNormal(v.normal[0], v.normal[1], v.normal[2]);
    if (i >= begun.inheritsTexCoord) s.setTexCoord(v.texCoord[0], v.texCoord[1]);
    s.vertex(v.position[0], v.position[1], v.position[2]);
  }
  const Current& last = begun.after;
  if (begun.setsColor) s.setColor(last.color);
  if (begun.setsNormal) s.setNormal(last.normal[0], last.normal[1], last.normal[2]);
  if (begun.setsTexCoord) s.setTexCoord(last.texCoord[0], last.texCoord[1]);
}

} // namespace

void State::begin(GLenum mode) {
  if (open()) fail(GL_INVALID_OPERATION, "glEnd is missing");
  if (mode > GL_POLYGON) fail(GL_INVALID_ENUM, "no such primitive");
  chunk_ = std::make_shared<Chunk>();
  chunk_->mode = mode;
  inherits_ = records();
  isUnrolled_ = false;
  recording_ = inherits_ ? Current() : now.current;
}

void State::unroll() {
  if (!records() || !open() || isUnrolled_) return;
  const auto begun = std::make_shared<Chunk>(*chunk_);
  begun->after = recording_;
  add([begun](State& s) { resume(s, *begun); });
  isUnrolled_ = true;
}

void State::vertex(float x, float y, float z) {
  if (recordsAlone()) add([=](State& s) { s.vertex(x, y, z); });
  if (!open()) return; // undefined in OpenGL
  Chunk& chunk = *chunk_;
  if (chunk.vertices.size() > maxVertices) return; // end() says so
  chunk.vertices.push_back({{x, y, z}, recording_.normal, recording_.texCoord, recording_.color});
  if (!inherits_) return;
  if (!chunk.setsColor) chunk.inheritsColor = chunk.vertices.size();
  if (!chunk.setsNormal) chunk.inheritsNormal = chunk.vertices.size();
  if (!chunk.setsTexCoord) chunk.inheritsTexCoord = chunk.vertices.size();
}

void State::setColor(const Color& color) {
  if (recordsAlone()) add([color](State& s) { s.setColor(color); });
  if (open()) {
    recording_.color = color;
    chunk_->setsColor = true;
  } else if (executes()) {
    now.current.color = color;
    trackColor();
  }
}

void State::trackColor() {
  Lighting& lighting = now.lighting;
  if (lighting.colorMaterial) track(lighting, now.current.color, lighting.faces);
}

void State::setNormal(float x, float y, float z) {
  if (recordsAlone()) add([=](State& s) { s.setNormal(x, y, z); });
  if (open()) {
    recording_.normal = {x, y, z};
    chunk_->setsNormal = true;
  } else if (executes()) {
    now.current.normal = {x, y, z};
  }
}

void State::setTexCoord(float s, float t) {
  if (recordsAlone()) add([=](State& state) { state.setTexCoord(s, t); });
  if (open()) {
    recording_.texCoord = {s, t};
    chunk_->setsTexCoord = true;
  } else if (executes()) {
    now.current.texCoord = {s, t};
  }
}

void State::end() {
  if (!open()) fail(GL_INVALID_OPERATION, "glBegin is missing");
  const bool single = recordsAlone();
  const std::shared_ptr<Chunk> chunk = std::exchange(chunk_, nullptr);
  if (single) add([](State& s) { s.end(); });
  if (chunk->vertices.size() > maxVertices) failForVertices();
  chunk->after = recording_;
  chunk->finish();
  if (records() && !single)
    add([chunk](State& s) {
      if (s.open()) fail(GL_INVALID_OPERATION, "a primitive stands between glBegin and glEnd");
      s.draw(chunk);
    });
  if (executes()) draw(chunk);
}

Material State::material(bool colored, const Color& color) const {
  const Lighting& lighting = now.lighting;
  const bool lit = lighting.on;
  std::array<Face, 2> faces = lighting.faces;
  if (!lit)
    for (Face& face : faces) {
      face.ambient = face.diffuse = face.specular = {0, 0, 0, color[3]};
      face.emission = color;
      face.shininess = 0;
    }
  else if (lighting.colorMaterial && !colored)
    track(lighting, color, faces);
  Material m{};
  const bool alphaCounts = now.pixels.blend || now.pixels.alphaTest;
  for (size_t side = 0; side < 2; side++) {
    const Face& face = faces[lighting.twoSide ? side : 0];
    const bool dark = side == 1 && lit && !lighting.twoSide; // light comes to the front only
    Material::Side& out = m.sides[side];
    copyColor(dark ? Color{0, 0, 0, 0} : face.diffuse, out.diffuse);
    copyColor(dark ? Color{0, 0, 0, 0} : face.specular, out.specular);
    copyColor(face.ambient, out.ambient);
    copyColor(face.emission, out.emission);
    out.shininess = face.shininess;
    out.alpha = alphaCounts ? std::clamp(face.diffuse[3], 0.0f, 1.0f) : 1.0f;
  }
  m.lit = lit;
  m.colored = colored;
  m.tracksAmbient =
      colored && lit &&
      (lighting.colorMode == GL_AMBIENT_AND_DIFFUSE || lighting.colorMode == GL_AMBIENT);
  m.twoSide = lit;
  m.blend = now.pixels.blend && now.pixels.source == GL_SRC_ALPHA;
  m.vertexAlpha = colored && alphaCounts;
  m.alphaTest = now.pixels.alphaTest && now.pixels.alphaFunction != GL_ALWAYS;
  m.alphaReference = m.alphaTest ? now.pixels.alphaReference : 0;
  m.texture = now.texturing.on ? textures.imageOf(now.texturing.bound) : 0;
  if (m.texture) {
    m.replace = now.texturing.mode == GL_REPLACE || now.texturing.mode == GL_DECAL;
    const Matrix& t = textureMatrix();
    const size_t from[6] = {0, 1, 4, 5, 12, 13};
    for (size_t i = 0; i < 6; i++) m.textureTransform[i] = static_cast<float>(t[from[i]]);
  }
  return m;
}

// Opens the frame with the first draw: projection, viewport and fog hold for all of it.
void State::beginFrame() {
  isShown_ = false;
  if (frame_.projection) return;
  frame_.projection = projection();
  frame_.fog = now.fog;
  frame_.left = now.viewport[0];
  frame_.bottom = now.viewport[1];
  frame_.width = now.viewport[2];
  frame_.height = now.viewport[3];
}

// Returns the modelview matrix. Without a depth test, what is drawn later lies a little nearer to
// the eye, so that it covers what was drawn in the same place before.
Matrix State::placed() const {
  if (now.depth.test) return modelview();
  const auto order = static_cast<double>(frame_.draws.size());
  const Matrix& p = projection();
  if (p[15] == 0) {
    const double nearer = std::max(1 - 2e-5 * order, 0.5);
    return scaling(nearer, nearer, nearer) * modelview();
  }
  return translation(0, 0, p[10] == 0 ? 0 : order * 2e-5 / std::abs(p[10])) * modelview();
}

void State::draw(const ChunkPtr& recorded) {
  const Current before = now.current;
  const ChunkPtr chunk = recorded->inherits() ? recorded->resolved(before) : recorded;
  if (recorded->setsColor) now.current.color = recorded->after.color;
  if (recorded->setsNormal) now.current.normal = recorded->after.normal;
  if (recorded->setsTexCoord) now.current.texCoord = recorded->after.texCoord;
  trackColor();
  if (chunk->vertices.empty()) return;
  if (selection.mode() != GL_RENDER)
    return selection.draw(chunk, projection() * modelview(), now.polygon);
  if (!affine(modelview()))
    return refuse("a modelview matrix with a projection", "put the projection on GL_PROJECTION");
  beginFrame();
  Part part = partOf(chunk);
  const bool inherited = !chunk->colorsVary && chunk->inheritsColor == chunk->vertices.size();
  const Material m = material(part.colored, inherited ? before.color : chunk->color);
  if (*frame_.projection != projection()) return drawOver(part, m);
  useLights();
  const Matrix matrix = placed();
  if (now.depth.test && !frame_.draws.empty() && frame_.draws.back().matrix == matrix &&
      frame_.draws.back().material == m)
    frame_.draws.back().parts.push_back(std::move(part));
  else
    frame_.draws.push_back({{std::move(part)}, matrix, m});
}

// Returns the part that a chunk is under the current state.
Part State::partOf(const ChunkPtr& chunk) {
  const Lighting& lighting = now.lighting;
  Part part;
  part.chunk = chunk;
  part.textured = now.texturing.on && textures.imageOf(now.texturing.bound) != 0;
  if (part.textured) textures.use(now.texturing.bound);
  const bool replaced =
      part.textured && (now.texturing.mode == GL_REPLACE || now.texturing.mode == GL_DECAL);
  part.colored = chunk->colorsVary && !replaced && (!lighting.on || lighting.colorMaterial);
  if (part.colored && lighting.on &&
      (lighting.colorMode == GL_EMISSION || lighting.colorMode == GL_SPECULAR))
    refuse("glColorMaterial(GL_EMISSION or GL_SPECULAR) with colours of vertices",
           "the colours of vertices are diffuse; colours of whole primitives work");
  part.lit = lighting.on;
  part.flat = lighting.shadeModel == GL_FLAT && (part.lit || part.colored);
  part.cull = now.polygon.cull;
  part.cullFace = now.polygon.cullFace;
  // OpenGL looks at the corners after the matrix, which may mirror them, OpenRT before it.
  part.frontFace = !mirrors(modelview())                    ? now.polygon.frontFace
                   : now.polygon.frontFace == GLenum(GL_CW) ? GLenum(GL_CCW)
                                                            : GLenum(GL_CW);
  part.polygonMode = now.polygon.mode;
  part.lineWidth = now.lineWidth;
  part.pointSize = now.pointSize;
  return part;
}

// Gives the frame the lights of its first draw that is lit.
void State::useLights() {
  if (!now.lighting.on) return;
  const LightSet lights = lightsOf(now.lighting);
  if (!frame_.lights)
    frame_.lights = lights;
  else if (*frame_.lights != lights)
    refuse("a change of the lights within a frame",
           "the lights of the first primitive that is lit light the whole frame");
}

// Draws over the picture what has another projection than the first draw of the frame.
void State::drawOver(const Part& part, const Material& material) {
  if (!affine(projection()))
    return refuse("a second perspective in a frame",
                  "a frame has one camera, that of its first primitive; what glOrtho projects lies "
                  "over its picture");
  if (part.lit)
    refuse("light under a second projection",
           "what lies over the picture shows the diffuse colours of its materials");
  if (!frame_.overlay) frame_.overlay = std::make_shared<Overlay>(frame_.width, frame_.height);
  Overlay::Style style;
  std::copy_n(now.viewport.begin(), 4, style.viewport.begin());
  style.viewport[0] -= frame_.left;
  style.viewport[1] -= frame_.bottom;
  const double halfWidth = style.viewport[2] / 2.0, halfHeight = style.viewport[3] / 2.0;
  style.toWindow = translation(style.viewport[0] + halfWidth, style.viewport[1] + halfHeight, 0) *
                   scaling(halfWidth, halfHeight, 1) * projection() * modelview();
  style.polygon = now.polygon;
  style.material = material;
  style.texture = part.textured ? &textures.at(now.texturing.bound) : nullptr;
  frame_.overlay->draw(part, style);
}

void State::newList(GLuint name, GLenum mode) {
  if (name == 0) fail(GL_INVALID_VALUE, "0 names no list");
  if (mode != GL_COMPILE && mode != GL_COMPILE_AND_EXECUTE) fail(GL_INVALID_ENUM, "no such mode");
  if (compiles() || open()) fail(GL_INVALID_OPERATION, "glEndList or glEnd is missing");
  list_ = std::make_shared<List>();
  listName_ = name;
  listMode_ = mode;
}

void State::endList() {
  if (!compiles() || open()) fail(GL_INVALID_OPERATION, "no list is open, or glEnd is missing");
  lists[listName_] = std::exchange(list_, nullptr);
  listName_ = 0;
}

void State::callList(GLuint name) {
  const auto found = lists.find(name);
  if (found == lists.end() || listDepth_ >= maxListDepth) return; // nothing happens in OpenGL, too
  const std::shared_ptr<const List> list = found->second;         // it may be deleted by itself
  struct Level {
    int& depth;
    explicit Level(int& d) : depth(d) { depth++; }
    ~Level() { depth--; } // also if memory has run out
  } level(listDepth_);
  const bool isNested = listDepth_ > 1;
  if (!isNested) nestedCommands_ = 0;
  for (const Command& command : list->commands) {
    if (isNested && ++nestedCommands_ > maxNestedCommands) return;
    try {
      command(*this);
    } catch (const Failure& failure) { record(failure.code, "glCallList: " + failure.text); }
  }
  if (!isNested && nestedCommands_ > maxNestedCommands)
    record(GL_OUT_OF_MEMORY, "glCallList: lists within lists have more than " +
                                 std::to_string(maxNestedCommands) + " commands");
}

std::vector<Matrix>& State::stack() {
  return now.matrixMode == GL_PROJECTION ? projection_
         : now.matrixMode == GL_TEXTURE  ? texture_
                                         : modelview_;
}

size_t State::depthOf(GLenum mode) const {
  return mode == GL_PROJECTION ? projection_.size()
         : mode == GL_TEXTURE  ? texture_.size()
                               : modelview_.size();
}

void State::pushAttributes(GLbitfield mask) {
  if (attributes_.size() >= maxAttributes) fail(GL_STACK_OVERFLOW, "too many glPushAttrib");
  attributes_.push_back({mask, now, textures.at(now.texturing.bound)});
}

void State::popAttributes() {
  if (attributes_.empty()) fail(GL_STACK_UNDERFLOW, "glPushAttrib is missing");
  const Saved saved = attributes_.back();
  attributes_.pop_back();
  restore(saved.attributes, saved.mask, now);
  if (!(saved.mask & GL_TEXTURE_BIT)) return;
  static_cast<TextureProperties&>(textures.at(now.texturing.bound)) = saved.texture;
}

void State::clear(GLbitfield mask) {
  constexpr GLbitfield all =
      GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT | GL_ACCUM_BUFFER_BIT;
  if (mask & ~all) fail(GL_INVALID_VALUE, "no such buffer");
  if (mask & GL_STENCIL_BUFFER_BIT)
    refuse("glClear(GL_STENCIL_BUFFER_BIT)", "there are no stencils; see glStencilFunc");
  if (mask & GL_ACCUM_BUFFER_BIT)
    refuse("glClear(GL_ACCUM_BUFFER_BIT)", "there is no accumulation buffer; see glAccum");
  if (!(mask & GL_COLOR_BUFFER_BIT) || selection.mode() != GL_RENDER) return;
  frame_ = Frame();
  frame_.clear = now.pixels.clear;
  cleared_ = true;
  isShown_ = false;
}

bool State::showFrame() {
  if (isShown_) return true;
  if (frame_.width == 0) {
    frame_.width = now.viewport[2];
    frame_.height = now.viewport[3];
  }
  return isShown_ = scene.show(frame_);
}

bool State::endFrame() {
  const bool rendered = showFrame();
  const Frame frame = std::exchange(frame_, Frame());
  frame_.clear = frame.clear;
  cleared_ = isShown_ = false;
  return rendered;
}

} // namespace rtgl
