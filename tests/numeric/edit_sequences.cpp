// edit_sequences.cpp: a picture is a function of the committed scene and its hints and does not
// depend on the edits that led there. Random sequences of edits are rendered after each step. The
// last picture is compared byte for byte with the last state made at once. It is also compared with
// the same scene without hints, where only rounding differs.
#include <cstring>
#include <random>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr int width = 40, height = 30;
using Picture = std::vector<float>;

// The scene as the test knows it.
struct Place {
  double m[16];
  int object = 0, shader = -1;
  bool visible = true, dynamic = false, scopedLight = false;
  RTid id = 0, light = 0;
};
struct Thing {   // an object
  int shape = 0; // index of a leaf's definition; -1: a group
  bool dynamic = false;
  std::vector<Place> children;
  RTid id = 0;
};
struct World {
  std::vector<Thing> things;
  std::vector<Place> places;
  float color = .5f;
  double eye[3] = {0, 2, 10};
  std::vector<RTid> shaders;
};

class EditSequences : public testing::TestWithParam<int> {
 protected:
  std::mt19937 random{unsigned(GetParam())};
  double uniform(double low, double high) {
    return low + (high - low) * double(random() >> 8) / double(1 << 24);
  }
  int below(size_t n) { return int(random() % n); }

  void randomMatrix(double* m, double spread) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(uniform(-spread, spread), uniform(-spread / 2, spread / 2),
                 uniform(-spread, spread));
    rtRotated(uniform(0, 360), uniform(-1, 1), 1, uniform(-1, 1));
    rtScaled(uniform(.3, 1.2), uniform(.3, 1.2), below(5) ? uniform(.3, 1.2) : -1);
    rtGetMatrixd(m);
    rtPopMatrix();
  }
  Place randomPlace(int object, double spread) {
    Place p;
    p.object = object;
    p.dynamic = below(3) == 0;
    p.shader = below(5) == 0 ? below(3) : -1;
    p.visible = below(6) != 0;
    randomMatrix(p.m, spread);
    return p;
  }

  // Defines a leaf: triangles, a sphere, lines, many triangles (which become instances if shared),
  // or a mixture.
  static void draw(const World& w, int shape) {
    std::mt19937 r{unsigned(shape)};
    const auto number = [&r] { return float(r() >> 8) / float(1 << 23) - 1; };
    rtBindShader(w.shaders[size_t(shape) % 3]);
    if (shape % 5 == 1 || shape % 5 == 4) rtSphere(.6f + .1f * float(shape % 3));
    if (shape % 5 == 2) {
      rtLineWidth(3);
      rtBegin(RT_LINES);
      for (int i = 0; i < 8; i++) rtVertex3f(number(), number(), number());
      rtEnd();
    }
    if (shape % 5 == 0 || shape % 5 == 4) {
      if (shape % 2) rtEnable(RT_CULL_FACE);
      rtBegin(RT_TRIANGLES);
      for (int i = 0; i < 30; i++) rtVertex3f(number(), number(), number());
      rtEnd();
      rtDisable(RT_CULL_FACE);
    }
    if (shape % 5 == 3) {
      constexpr int n = 130;
      std::vector<float> points;
      std::vector<uint32_t> indices;
      for (int y = 0; y <= n; y++)
        for (int x = 0; x <= n; x++) {
          const float u = 2 * float(x) / n - 1, v = 2 * float(y) / n - 1;
          points.insert(points.end(),
                        {u, .3f * std::sin(3 * u + float(shape)) * std::cos(4 * v), v});
          const auto i = uint32_t(y * (n + 1) + x);
          if (x < n && y < n)
            indices.insert(indices.end(), {i, i + n + 1, i + 1, i + 1, i + n + 1, i + n + 2});
        }
      rtVertexPointer(3, RT_FLOAT, 0, points.data());
      rtDrawElements(RT_TRIANGLES, indices.size(), indices.data(), points.size() / 3);
    }
    rtBindShader(0);
  }

  static void emit(World& w, Place& p, bool hints) {
    p.id = rtInstantiateObject(w.things[size_t(p.object)].id);
    rtInstanceMatrix(p.id, p.m);
    rtInstanceVisible(p.id, p.visible);
    if (p.shader >= 0) rtInstanceShader(p.id, w.shaders[size_t(p.shader)]);
    rtInstanceHint(p.id, p.dynamic && hints ? RT_DYNAMIC : RT_STATIC);
  }
  static void emitLight(Place& p) {
    if (!p.scopedLight) return;
    p.light = rtUseLight(
        Shader("VRML97DirectionalLight").set("direction", {1, -.5, -.3}).set("intensity", {.5}));
    rtLightScope(p.light, p.id);
  }
  static void define(World& w, Thing& t, bool hints) {
    t.id = rtBeginObject(t.id);
    if (t.shape >= 0) draw(w, t.shape);
    for (Place& p : t.children) emit(w, p, hints);
    rtEndObject();
    for (Place& p : t.children) emitLight(p);
  }
  static void setColor(const World& w) {
    rtBindShader(w.shaders[0]);
    rtParameter3f(rtParameterHandle("diffuseColor"), w.color, .4f, .9f - w.color);
    rtBindShader(0);
  }
  static void look(const World& w) {
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(w.eye[0], w.eye[1], w.eye[2], 0, 0, 0, 0, 1, 0);
    rtPerspective(45);
    rtPopMatrix();
  }
  // Draws everything in a new context, which becomes current.
  static RTcontext emit(World& w, bool hints, int threads) {
    const RTcontext context = rtNewContext(("threads=" + std::to_string(threads)).c_str());
    rtFrameBuffer(width, height, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    w.shaders = {Shader("VRML97"), Shader("VRML97").set("diffuseColor", {.2, .8, .3}),
                 Shader("VRML97").set("diffuseColor", {.9, .8, .3}).set("transparency", {.4})};
    setColor(w);
    rtUseLight(Shader("VRML97PointLight").set("location", {3, 8, 6}));
    rtUseLight(Shader("VRML97DirectionalLight")
                   .set("direction", {-.3, -1, -.4})
                   .set("ambientIntensity", {.3}));
    for (Thing& t : w.things) {
      t.id = 0;
      if (t.dynamic && hints) { // a hint takes effect at the next definition
        rtGenObjects(1, &t.id);
        rtObjectHint(t.id, RT_DYNAMIC);
      }
      define(w, t, hints);
    }
    for (Place& p : w.places) {
      emit(w, p, hints);
      emitLight(p);
    }
    const RTid floor = rtBeginObject(0);
    rtBegin(RT_QUADS);
    rtVertex3f(-9, -3, 9);
    rtVertex3f(9, -3, 9);
    rtVertex3f(9, -3, -9);
    rtVertex3f(-9, -3, -9);
    rtEnd();
    rtEndObject();
    rtInstantiateObject(floor);
    look(w);
    return context;
  }
  static Picture rendered() {
    rtRender();
    Picture picture(size_t(4 * width * height));
    rtReadPixels(RT_RGBA, picture.data(), picture.size());
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    return picture;
  }

  void start(World& w) {
    for (int i = 0; i < 6; i++) w.things.push_back({below(10), below(4) == 0, {}, 0});
    w.things[0].shape = 3;
    w.things[0].dynamic = false; // many triangles
    for (int i = 0; i < 3; i++) {
      Thing group{below(2) ? -1 : below(10), below(5) == 0, {}, 0};
      for (int k = 1 + below(3); k > 0; k--)
        group.children.push_back(randomPlace(below(w.things.size()), 2));
      w.things.push_back(std::move(group));
    }
    for (int i = 0; i < 10; i++) w.places.push_back(randomPlace(below(w.things.size()), 5));
    for (int i = 0; i < 3; i++)
      w.places.push_back(randomPlace(0, 5)); // these share one acceleration structure
    w.places[1].scopedLight = below(2);
    if (!w.things[7].children.empty()) w.things[7].children[0].scopedLight = below(2);
  }

  Place& anyPlace(World& w) {
    const int t = below(w.things.size() + 4);
    if (size_t(t) < w.things.size() && !w.things[size_t(t)].children.empty()) {
      auto& children = w.things[size_t(t)].children;
      return children[size_t(below(children.size()))];
    }
    return w.places[size_t(below(w.places.size()))];
  }

  void change(World& w) {
    switch (below(9)) {
    case 0:
    case 1:
    case 2: {
      Place& p = anyPlace(w);
      randomMatrix(p.m, 4);
      rtInstanceMatrix(p.id, p.m);
      p.dynamic = true;
      break;
    }
    case 3: {
      Place& p = anyPlace(w);
      p.visible = !p.visible;
      p.dynamic = true;
      rtInstanceVisible(p.id, p.visible);
      break;
    }
    case 4: {
      Thing& t = w.things[size_t(below(6))];
      t.shape = below(2) ? t.shape + 5 : below(10);
      t.dynamic = true;
      define(w, t, true);
      break;
    }
    case 5: {
      Place& p = anyPlace(w);
      p.shader = below(3);
      rtInstanceShader(p.id, w.shaders[size_t(p.shader)]);
      break;
    }
    case 6:
      if (below(2) && w.places.size() > 4) {
        const size_t which = size_t(below(w.places.size()));
        if (w.places[which].light) rtRemoveLight(w.places[which].light);
        rtDeleteInstance(w.places[which].id);
        w.places.erase(w.places.begin() + long(which));
      } else {
        w.places.push_back(randomPlace(below(w.things.size()), 5));
        emit(w, w.places.back(), true);
      }
      break;
    case 7:
      w.eye[0] = uniform(-14, 14);
      w.eye[1] = uniform(0, 8);
      w.eye[2] = uniform(4, 14);
      look(w);
      break;
    case 8:
      w.color = float(uniform(0, .9));
      setColor(w);
      break;
    }
  }

  static int different(const Picture& a, const Picture& b) {
    int count = 0;
    for (size_t i = 0; i < a.size(); i += 4) {
      bool same = true;
      for (size_t c = i; c < i + 4; c++)
        same = same && std::fabs(a[c] - b[c]) <= 1e-5f + 1e-4f * std::fabs(b[c]);
      count += !same;
    }
    return count;
  }
};

TEST_P(EditSequences, TheLastPictureIsThatOfTheLastState) {
  World w;
  const RTcontext first = rtNewContext("backend=null"); // matrices need a current context
  start(w);
  rtDeleteContext(first);
  const RTcontext context = emit(w, true, 1 + GetParam() % 2);
  Picture last = rendered();
  for (int step = 0; step < 12; step++) {
    for (int k = 1 + below(3); k > 0; k--) change(w);
    last = rendered();
  }
  ASSERT_NE(last, Picture(last.size(), 0));
  rtDeleteContext(context);

  World again = w;
  emit(again, true, 2 - GetParam() % 2);
  const Picture atOnce = rendered();
  EXPECT_TRUE(std::memcmp(atOnce.data(), last.data(), last.size() * sizeof(float)) == 0)
      << different(atOnce, last) << " pixels are not the same";
  rtDeleteContext(rtGetCurrent());

  emit(again, false, 1);
  // Samples on edges may fall to either side.
  EXPECT_LE(different(rendered(), last), width * height / 100);
  rtDeleteContext(rtGetCurrent());
}

// Queries prepare the geometry alone, and frames without light no tables for light: neither may
// leave traces in the pictures after them.
TEST_P(EditSequences, QueriesAndFramesWithoutLightLeaveNoTraces) {
  const auto shine = [](const World& w) {
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtBindShader(w.shaders[1]);
    rtParameter3f(rtParameterHandle("emissiveColor"), 2, 1.5f, w.color);
    rtBindShader(0);
  };
  World w;
  const RTcontext first = rtNewContext("backend=null"); // matrices need a current context
  start(w);
  rtDeleteContext(first);
  const RTcontext context = emit(w, true, 1 + GetParam() % 2);
  shine(w);
  rendered();
  for (int step = 0; step < 12; step++) {
    for (int k = 1 + below(3); k > 0; k--) change(w);
    shine(w);
    if (below(2)) { // commits the edits
      rtFrameBuffer(width, height, below(2) ? RT_DEPTH : RT_RGBA);
      rtRender();
    }
    const RTray ray{{float(w.eye[0]), float(w.eye[1]), float(w.eye[2])}, 0, {0, -.1f, -1}, 1e9f};
    RThit hit;
    if (below(2)) rtCastRays(1, &ray, &hit);
    if (below(2)) rtPick(width / 2., height / 2., &hit);
  }
  ASSERT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  rtFrameBuffer(width, height, RT_RGBA);
  const Picture last = rendered();
  ASSERT_NE(last, Picture(last.size(), 0));
  rtDeleteContext(context);

  World again = w;
  emit(again, true, 2 - GetParam() % 2);
  shine(again);
  const Picture atOnce = rendered();
  // Sums over emissive shapes may be rounded otherwise after edits.
  EXPECT_LE(different(atOnce, last), width * height / 100);
  rtDeleteContext(rtGetCurrent());
}

INSTANTIATE_TEST_SUITE_P(Seeds, EditSequences, testing::Range(1, 25));

} // namespace
} // namespace numeric
