// openrt_whole_scene.cpp: a scene written as one commit equals the scene. After random edits
// through the API:
// * the tables are equal;
// * the commit obeys all rules;
// * later edits work on both;
// * a backend that received only this commit renders the same bytes as one that received every
//   edit.
#include <cstring>
#include <random>

#include "scene/whole_scene.h"
#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

bool same(const Matrix4d& a, const Matrix4d& b) { return a.m == b.m; }
bool same(const ArrayPtr& a, const ArrayPtr& b) {
  return !a || !b ? a == b
                  : a->size() == b->size() && std::memcmp(a->data(), b->data(), a->size()) == 0;
}
bool same(const Role& a, const Role& b) { return a.shader == b.shader && same(a.matrix, b.matrix); }
bool same(const Light& a, const Light& b) {
  return a.shader == b.shader && a.scope == b.scope && same(a.matrix, b.matrix);
}
bool same(const ShaderClassName& a, const ShaderClassName& b) {
  return a.name == b.name && a.library == b.library;
}
template <class Table, class T> std::string bytes(const T& table) {
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(Table::Pack(builder, &table));
  return {reinterpret_cast<const char*>(builder.GetBufferPointer()), builder.GetSize()};
}
bool same(const ParameterValues& a, const ParameterValues& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const ParameterValue& x, const ParameterValue& y) {
        return bytes<edit::Parameter>(editOf(0, x)) == bytes<edit::Parameter>(editOf(0, y));
      });
}
bool same(const TextureImage& a, const TextureImage& b) {
  return bytes<edit::Texture>(a.description) == bytes<edit::Texture>(b.description) &&
         same(a.texels, b.texels);
}
bool same(const Instance& a, const Instance& b) {
  return a.parent == b.parent && a.object == b.object && a.shader == b.shader &&
         a.visible == b.visible && a.userData == b.userData && a.name == b.name &&
         a.dynamic == b.dynamic && a.fog == b.fog && same(a.matrix, b.matrix);
}
bool same(const ShaderValues& a, const ShaderValues& b) {
  return a.shaderClass == b.shaderClass && same(a.parameters, b.parameters);
}
template <class T> bool same(const std::map<uint32_t, T>& a, const std::map<uint32_t, T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.first == y.first && same(x.second, y.second);
  });
}
template <class T> bool same(const IdTable<T>& a, const IdTable<T>& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [id, value] : a)
    if (!b.contains(id) || !same(value, b.at(id))) return false;
  return true;
}

// Compares two scenes. Geometry may refer to shaders that were deleted; such references are equal.
class Comparer {
 public:
  Comparer(const Scene& a, const Scene& b) : a_(a), b_(b) {}
  void expectEqual() const {
    EXPECT_TRUE(same(a_.textures, b_.textures));
    EXPECT_TRUE(same(a_.classes, b_.classes));
    EXPECT_TRUE(same(a_.shaders, b_.shaders));
    EXPECT_TRUE(same(a_.instances, b_.instances));
    EXPECT_TRUE(same(a_.lights, b_.lights));
    EXPECT_TRUE(same(a_.camera, b_.camera) && same(a_.environment, b_.environment));
    EXPECT_TRUE(a_.defaultShader == b_.defaultShader && a_.transport == b_.transport &&
                bytes<edit::FrameSettings>(a_.frame) == bytes<edit::FrameSettings>(b_.frame));
    ASSERT_EQ(a_.objects.size(), b_.objects.size());
    for (const auto& [id, object] : a_.objects) {
      ASSERT_TRUE(b_.objects.contains(id));
      EXPECT_TRUE(equal(object, b_.objects.at(id))) << "object " << id;
      EXPECT_EQ(a_.childrenOf(id), b_.childrenOf(id));
    }
    EXPECT_EQ(a_.childrenOf(0), b_.childrenOf(0));
  }

 private:
  uint32_t known(uint32_t shader) const { return a_.shaders.contains(shader) ? shader : 0; }
  bool equal(const Object& a, const Object& b) const {
    return a.dynamic == b.dynamic &&
           std::equal(a.geometries.begin(), a.geometries.end(), b.geometries.begin(),
                      b.geometries.end(), [this](auto& x, auto& y) { return equal(x, y); });
  }
  bool equal(const Geometry& a, const Geometry& b) const {
    return a.primitive == b.primitive && known(a.shader) == known(b.shader) && a.name == b.name &&
           same(a.matrix, b.matrix) && a.cull == b.cull && a.clockwise == b.clockwise &&
           a.width == b.width && a.texGen == b.texGen && a.stipple == b.stipple &&
           same(a.points, b.points) && same(a.indices, b.indices) && same(a.normals, b.normals) &&
           same(a.texCoords, b.texCoords) && same(a.colors, b.colors) &&
           same(a.fogCoords, b.fogCoords) && same(a.rest, b.rest) && !a.surface == !b.surface &&
           (!a.surface || *a.surface == *b.surface) &&
           (known(a.shader) == 0 ||
            std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(),
                       b.parameters.end(), [](auto& x, auto& y) {
                         return x.index == y.index && x.perVertex == y.perVertex &&
                                same(x.values, y.values);
                       }));
  }
  const Scene &a_, &b_;
};

class WholeScene : public ApiTest, public testing::WithParamInterface<int> {
 protected:
  void SetUp() override { // with the stock shaders
    captured = std::make_shared<Captured>(shaderFolders(OPENRT_TEST_PLUGINS));
    ContextConfig config;
    config.shaderPath = OPENRT_TEST_PLUGINS;
    handle =
        adoptContext(std::make_shared<Context>(config, std::make_unique<CaptureBackend>(captured)));
  }

  std::mt19937 random{unsigned(GetParam())};
  float number(float low, float high) {
    return low + (high - low) * float(random() >> 8) / float(1 << 24);
  }
  RTid any(const std::vector<RTid>& ids) { return ids.empty() ? 0 : ids[random() % ids.size()]; }
  RTid take(std::vector<RTid>& ids) {
    if (ids.empty()) return 0;
    std::swap(ids[random() % ids.size()], ids.back());
    const RTid id = ids.back();
    ids.pop_back();
    return id;
  }

  void place() {
    rtLoadIdentity();
    rtTranslatef(number(-3, 3), number(-2, 2), number(-3, 0));
    rtRotatef(number(0, 360), 1, number(-1, 1), .3f);
  }
  void geometry() {
    const RTid shader = any(surfaces);
    rtBindShader(shader);
    rtLoadName(random() % 9);
    rtTexGen(random() % (RT_TEX_GEN_SPHERE_REFLECTION + 1));
    rtLineStipple(int(random() % 3 + 1), uint16_t(random()));
    if (random() % 3 == 0) return rtSphere(number(.2f, 1));
    rtBegin(random() % 4 ? RT_TRIANGLES : RT_LINES);
    for (int i = 0; i < 6; i++) {
      rtColor3f(number(0, 1), number(0, 1), number(0, 1));
      rtTexCoord2f(number(0, 1), number(0, 1));
      rtFogCoordf(number(0, 1));
      if (shader == varying) rtParameter3f(varyingColor, number(0, 1), number(0, 1), number(0, 1));
      rtVertex3f(number(-1, 1), number(-1, 1), number(-1, 1));
    }
    rtEnd();
  }
  // Objects contain only objects with smaller numbers.
  void define(RTid id) {
    const RTid made = rtBeginObject(id);
    for (size_t i = random() % 3; i > 0; i--) {
      place();
      geometry();
    }
    std::vector<RTid> inner;
    for (RTid o : objects)
      if (o < made) inner.push_back(o);
    for (size_t i = random() % 3; i > 0 && !inner.empty(); i--) {
      place();
      rtInstantiateObject(any(inner));
    }
    rtEndObject();
    if (!id) objects.push_back(made);
  }
  void image(RTid id) {
    rtBindTexture(id);
    if (random() % 2) {
      std::vector<uint8_t> texels(4 * 3 * 3);
      for (uint8_t& t : texels) t = uint8_t(random());
      if (random() % 2)
        rtTexImage2D(3, 4, 3, RT_UNSIGNED_BYTE, texels.data());
      else
        rtTexImage3D(3, 4, 1, 3, RT_UNSIGNED_BYTE, texels.data());
    }
    rtTexParameteri(RT_TEXTURE_MAG_FILTER,
                    random() % 2 ? RT_NEAREST : RT_LINEAR); // also affects existing texels
    rtTexParameteri(RT_TEXTURE_WRAP_S, random() % 2 ? RT_MIRRORED_REPEAT : RT_CLAMP_TO_BORDER);
    rtTexParameteri(RT_TEXTURE_WRAP_R, random() % 2 ? RT_REPEAT : RT_CLAMP_TO_EDGE);
    const float border[4] = {number(0, 1), number(0, 1), number(0, 1), number(0, 1)};
    if (random() % 2) rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, border);
  }
  void parameters(RTid shader) {
    if (!shader || shader == varying) return;
    rtBindShader(shader);
    rtParameter3f(rtParameterHandle("diffuseColor"), number(0, 1), number(0, 1), number(0, 1));
    if (random() % 2) rtParameter1f(rtParameterHandle("transparency"), number(0, .8f));
    if (random() % 3 == 0) rtParameterTexture(rtParameterHandle("texture"), any(textures));
  }

  void change() {
    const RTid instance = any(instances);
    switch (random() % 16) {
    case 0:
      surfaces.push_back(rtNewShader(rtNewShaderClass("VRML97", nullptr)));
      parameters(surfaces.back());
      break;
    case 1: parameters(any(surfaces)); break;
    case 2:
    case 3: define(0); break;
    case 4: define(any(objects)); break;
    case 5:
    case 6:
      if (!objects.empty()) {
        place();
        instances.push_back(rtInstantiateObject(any(objects)));
      }
      break;
    case 7:
      if (instance) {
        place();
        rtGetMatrixd(matrix);
        rtInstanceMatrix(instance, matrix);
      }
      break;
    case 8:
      if (instance) {
        rtInstanceVisible(instance, random() % 3 != 0);
        rtInstanceUserData(instance, random());
        rtInstanceFog(instance, random() % 2 ? fog : 0);
      }
      break;
    case 9:
      if (instance) rtInstanceShader(instance, any(surfaces) == varying ? 0 : any(surfaces));
      break;
    case 10:
      if (const RTid gone = take(instances)) rtDeleteInstance(gone);
      break;
    case 11:
      if (surfaces.size() > 3 && surfaces.back() != varying) {
        rtDeleteShader(surfaces.back());
        surfaces.pop_back();
      }
      break;
    case 12:
      place();
      lights.push_back(rtUseLight(lamp));
      if (instance) rtLightScope(lights.back(), instance);
      break;
    case 13:
      if (const RTid gone = take(lights)) rtRemoveLight(gone);
      break;
    case 14: {
      RTid id = random() % 2 ? any(textures) : 0;
      if (!id) {
        rtGenTextures(1, &id);
        textures.push_back(id);
      }
      image(id);
      break;
    }
    case 15:
      rtFrameBuffer(20 + int(random() % 9), 16, RT_RGBA | RT_DEPTH | RT_NAME);
      rtLoadIdentity();
      rtTranslatef(0, 0, 6);
      rtPerspective(40 + double(random() % 20));
      break;
    }
    rtBindShader(0);
  }
  void begin() {
    rtFrameBuffer(24, 16, RT_RGBA | RT_DEPTH | RT_NAME);
    rtQuality(RT_SAMPLES_PER_PIXEL, 2);
    lamp = rtNewShader(rtNewShaderClass("VRML97PointLight", nullptr));
    fog = rtNewShader(rtNewShaderClass("VRML97Environment", nullptr));
    rtBindShader(fog);
    rtParameter1i(rtParameterHandle("fogType"), 1);
    rtParameter1f(rtParameterHandle("fogRange"), 12);
    varying = rtNewShader(rtNewShaderClass("Varying", "varying"));
    surfaces = {varying};
    rtBindShader(varying);
    varyingColor = rtParameterHandle("color");
    rtBindShader(0);
    rtLoadIdentity();
    rtTranslatef(0, 0, 6);
    rtPerspective(45);
    rtLoadIdentity();
    rtTranslatef(3, 4, 5);
    lights.push_back(rtUseLight(lamp));
  }
  std::vector<float> picture(Backend& backend, const Scene& scene) {
    backend.start();
    backend.wait();
    std::vector<float> pixels(size_t(scene.frame.width) * scene.frame.height * 6);
    const size_t n = pixels.size() / 6;
    EXPECT_TRUE(backend.read(RT_RGBA, {pixels.data(), 4 * n}) &&
                backend.read(RT_DEPTH, {pixels.data() + 4 * n, n}));
    EXPECT_TRUE(backend.read(RT_NAME, {pixels.data() + 5 * n, n}));
    return pixels;
  }

  RTid lamp = 0, fog = 0, varying = 0;
  int varyingColor = -1;
  double matrix[16];
  std::vector<RTid> surfaces, objects, instances, lights, textures;
};

TEST_P(WholeScene, IsTheSceneHoweverItCameToBe) {
  BackendOptions options;
  options.threads = 1;
  options.shaders = &captured->shaders;
  const auto seeing = makeLocalBackend(options);
  Scene seen, late;
  std::unique_ptr<Backend> joining;
  std::unique_ptr<CommitValidator> validator;
  begin();
  for (int step = 0; step < 30; step++) {
    SCOPED_TRACE(step);
    for (int k = 0; k < 4; k++) change();
    commit();
    const auto edits = captured->commits.back();
    seen.apply(*edits);
    seeing->apply(edits);
    if (late.frame.width) {
      validator->check(*edits);
      late.apply(*edits);
      joining->apply(edits);
    }
    if (step % 7 == 5) { // another backend joins
      const auto whole = wholeScene(seen);
      validator = std::make_unique<CommitValidator>(&captured->shaders);
      ASSERT_NO_THROW(validator->check(*whole));
      late = Scene();
      late.apply(*whole);
      joining = makeLocalBackend(options);
      joining->apply(whole);
    }
    if (!late.frame.width) continue;
    Comparer(seen, late).expectEqual();
    if (step % 3) continue;
    const std::vector<float> a = picture(*seeing, seen), b = picture(*joining, late);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
  }
  EXPECT_FALSE(seen.objects.empty() || seen.instances.size() == 0);
}

TEST_P(WholeScene, OfNothingIsNothing) {
  const Scene empty;
  const auto whole = wholeScene(empty);
  CommitValidator(&captured->shaders).check(*whole);
  Scene again;
  again.apply(*whole);
  Comparer(empty, again).expectEqual();
  EXPECT_FALSE(whole->edits.render);
}

class DeformingScene : public WholeScene {
 protected:
  // Defines a square that is folded flat onto itself at one side: there a ray hits two triangles at
  // the same place, and the tree decides which one it finds.
  void define(RTid object, float phase) {
    constexpr uint32_t side = 165; // more triangles than refittedTriangles
    std::vector<float> points, colors;
    std::vector<uint32_t> indices;
    for (uint32_t y = 0; y < side; y++)
      for (uint32_t x = 0; x < side; x++) {
        const float u = 4 * float(x) / (side - 1) - 2, v = 4 * float(y) / (side - 1) - 2;
        const float folded = std::min(v, 3 - v);
        points.insert(points.end(), {u, folded, .2f * std::sin(3 * u + phase)});
        colors.insert(colors.end(), {v > 1.5f ? 1.0f : 0.0f, .5f, float(x % 2)});
        const uint32_t a = y * side + x, b = a + 1, c = a + side, d = c + 1;
        if (x + 1 < side && y + 1 < side) indices.insert(indices.end(), {a, b, c, b, d, c});
      }
    rtBeginObject(object);
    rtVertexPointer(3, RT_FLOAT, 0, points.data());
    rtColorPointer(3, RT_FLOAT, 0, colors.data());
    rtDrawElements(RT_TRIANGLES, indices.size(), indices.data(), points.size() / 3);
    rtEndObject();
  }
};

TEST_P(DeformingScene, HasTheSameTreesForWhoeverJoinsLate) {
  BackendOptions options;
  options.threads = 1;
  options.shaders = &captured->shaders;
  const auto seeing = makeLocalBackend(options);
  Scene seen;
  begin();
  RTid object = 0;
  rtGenObjects(1, &object);
  rtObjectHint(object, RT_DYNAMIC);
  define(object, 0);
  rtLoadIdentity();
  rtInstantiateObject(object);
  for (int step = 1; step < 5; step++) {
    commit();
    seen.apply(*captured->commits.back());
    seeing->apply(captured->commits.back());
    const std::vector<float> a = picture(*seeing, seen);
    const auto whole = wholeScene(seen);
    ASSERT_NO_THROW(CommitValidator(&captured->shaders).check(*whole));
    Scene late;
    late.apply(*whole);
    EXPECT_EQ(bool(late.objects.at(object).geometries[0].rest), step > 1) << step;
    BackendOptions others = options;
    others.threads = 2;
    const auto joining = makeLocalBackend(others);
    joining->apply(whole);
    const std::vector<float> b = picture(*joining, late);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << step;
    define(object, .1f * float(step));
  }
}

INSTANTIATE_TEST_SUITE_P(Once, DeformingScene, testing::Values(1));
INSTANTIATE_TEST_SUITE_P(Seeds, WholeScene, testing::Range(1, 9));

} // namespace
