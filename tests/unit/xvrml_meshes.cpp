// xvrml_meshes.cpp: STL, PLY, OBJ, glTF and OFF as worlds: how they are found out, the nodes that
// they become, and what a hostile file may cost. The values follow from the bytes by hand.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "parse/mesh/mesh_file.h"
#include "parse/mesh/weld.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> load(const std::string& bytes, const std::string& name,
                            const LoadOptions& options = {}) {
  return loadWorldFromMemory(bytes, name, options);
}

std::string messages(const World& world) {
  std::string text;
  for (const Diagnostic& one : world.diagnostics.list()) text += one.text() + '\n';
  return text;
}

// Returns the first node of a type below a node, in the order of the file.
template <class T> T* findNode(Node* node) {
  if (!node) return nullptr;
  if (auto* found = nodeCast<T>(node)) return found;
  for (const FieldInfo& field : node->type().fields) {
    if (field.type == FieldType::SFNode && holdsValue(field)) {
      if (T* found = findNode<T>(static_cast<NodeRef*>(node->storage(field))->get())) return found;
    } else if (field.type == FieldType::MFNode && holdsValue(field)) {
      for (const NodeRef& child : *static_cast<MFNode*>(node->storage(field)))
        if (T* found = findNode<T>(child.get())) return found;
    }
  }
  return nullptr;
}

template <class T> T* find(const World& world) {
  for (const NodeRef& root : world.scope.roots)
    if (T* found = findNode<T>(root.get())) return found;
  return nullptr;
}

MFVec3f pointsOf(const NodeRef& coord) {
  auto* node = nodeCast<nodes::Coordinate>(coord.get());
  return node ? node->point : MFVec3f();
}

template <class T> std::string bytesOf(std::initializer_list<T> numbers) {
  std::string bytes;
  for (const T number : numbers)
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  return bytes;
}

std::string binaryStl(uint32_t announced, int present) {
  std::string bytes(80, ' ');
  bytes += bytesOf({announced});
  for (int i = 0; i < present; ++i)
    bytes += bytesOf<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, float(i)}) + std::string(2, '\0');
  return bytes;
}

const char* const plyHead = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                            "property float y\nproperty float z\n";

std::string gltf(const std::string& members) {
  return R"({"asset":{"version":"2.0"},)" + members + "}";
}

// A triangle in the buffer "AAAA..." of zeros, as far as a document needs one.
std::string triangle(const std::string& more) {
  return gltf(R"("buffers":[{"byteLength":36,"uri":"data:;base64,)" + std::string(48, 'A') +
              R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],
                 "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
                 "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])" +
              more);
}

// A triangle with material 0, at a node that has light 0, too.
std::string shown(const std::string& more) {
  return gltf(R"("scene":0,"scenes":[{"nodes":[0]}],
      "nodes":[{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
      "buffers":[{"byteLength":36,"uri":"data:;base64,)" +
              std::string(48, 'A') + R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],
      "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],)" +
              more);
}

TEST(Meshes, ContentDecidesBeforeTheSuffix) {
  const auto encoding = [](const std::string& bytes, const char* name) {
    return load(bytes, name)->head.version.encoding;
  };
  EXPECT_EQ(encoding(binaryStl(1, 1), "a.wrl"), Encoding::stl);
  EXPECT_EQ(encoding("solid x\nfacet normal 0 0 1\n", "a.obj"), Encoding::stl);
  EXPECT_EQ(encoding(std::string(plyHead) + "end_header\n0 0 0 1 0 0 0 1 0\n", "a"), Encoding::ply);
  EXPECT_EQ(encoding("# VRML 1.0 export\nv 1 2 3\n", "a.wrl"), Encoding::obj);
  EXPECT_EQ(encoding(gltf(R"("nodes":[])"), "a.x3dj"), Encoding::gltf);
  EXPECT_EQ(encoding("#VRML V2.0 utf8\nGroup { }", "a.stl"), Encoding::vrml97);
  EXPECT_EQ(encoding("OFF\n8 6 12\n", "a.wrl"), Encoding::off);
  EXPECT_EQ(encoding("# made by x\nCOFF 3 1\n", "a.ply"), Encoding::off);
  EXPECT_EQ(encoding("OFF490 518 0\n", "a"), Encoding::off);
  // The suffix decides where the content says nothing.
  EXPECT_EQ(encoding(binaryStl(1, 1) + "tail", "part.STL"), Encoding::stl);
  EXPECT_EQ(encoding("f 1 2 3\n", "a.obj"), Encoding::obj);
  EXPECT_THROW(load("f 1 2 3\n", "a.wrl"), LoadError);
  EXPECT_TRUE(load("v 1 2 3\n", "a.obj")->head.version.isX3d());
}

TEST(Meshes, TheMessageForOtherFormatsNamesThoseThatCanBeRead) {
  try {
    load("BLENDER-v300", "a.off");
    FAIL();
  } catch (const LoadError& error) {
    for (const char* name :
         {"VRML97", "X3D ClassicVRML", "STL", "PLY", "Wavefront OBJ", "glTF", "OFF", "STEP"})
      EXPECT_NE(error.diagnostic.message.find(name), std::string::npos) << name;
  }
}

TEST(Meshes, FormFeedsAreBlanks) {
  EXPECT_THROW(loadWorldFromMemory("a \f\v b\n", "a.bin"), LoadError) << "it ends";
}

TEST(Meshes, WeldingKeepsTheFirstOfEqualPoints) {
  std::vector<Vec3f> points = {{0, 0, 0}, {1, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}, {1, 0, 1e-30f}};
  EXPECT_EQ(weldPoints(points), (std::vector<uint32_t>{0, 1, 0, 1, 2}));
  EXPECT_EQ(points, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 0, 1e-30f}}));
}

TEST(Meshes, StlVerticesAreWelded) {
  const auto world = load(binaryStl(2, 2), "a.stl");
  EXPECT_EQ(messages(*world), "");
  auto* faces = find<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(faces);
  EXPECT_EQ(pointsOf(faces->coord), (MFVec3f{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 1}}));
  EXPECT_EQ(faces->coordIndex, (MFInt32{0, 1, 2, -1, 0, 1, 3, -1}));
  EXPECT_FALSE(faces->solid);
  EXPECT_NEAR(faces->creaseAngle, 0.5236, 1e-4);
}

TEST(Meshes, StlThatEndsEarlyShowsWhatItHas) {
  const auto world = load(binaryStl(7, 2), "a.stl");
  EXPECT_NE(messages(*world).find("announces 7 triangles and has 2"), std::string::npos);
  EXPECT_EQ(find<nodes::IndexedFaceSet>(*world)->coordIndex.size(), 8u);
}

TEST(Meshes, StlColoursOfBothKinds) {
  std::string own = binaryStl(2, 2), magics = own;
  own[84 + 48] = char(0x1f); // VisCAM: blue in the lowest bits, bit 15: it has a colour
  own[84 + 49] = char(0x80);
  auto world = load(own, "a.stl");
  auto* color = find<nodes::Color>(*world);
  ASSERT_TRUE(color);
  EXPECT_EQ(color->color, (MFColor{{0, 0, 1}, {0.8f, 0.8f, 0.8f}}));
  std::memcpy(magics.data(), "COLOR=\xff\x00\x33\xff", 10);
  magics[84 + 48] = char(0x1f); // Magics: red in the lowest bits
  magics[84 + 50 + 49] = char(0x80);
  world = load(magics, "a.stl");
  EXPECT_EQ(find<nodes::Color>(*world)->color, (MFColor{{1, 0, 0}, {1, 0, 0.2f}}));
}

TEST(Meshes, PlyNormalsColoursAndCornersOfTextures) {
  const auto world = load("ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 3\n"
                          "property float x\nproperty float y\nproperty float z\n"
                          "property float nx\nproperty float ny\nproperty float nz\n"
                          "property ushort red\nproperty ushort green\nproperty ushort blue\n"
                          "element face 1\nproperty list uchar uint vertex_indices\n"
                          "property list uchar float texcoord\nend_header\n"
                          "0 0 0 0 0 1 65535 0 0\n1 0 0 0 0 1 0 65535 0\n0 1 0 0 0 1 0 0 0\n"
                          "3 2 1 0 6 0 1 1 0 0 0.5\n",
                          "a.ply");
  EXPECT_EQ(messages(*world), "");
  auto* faces = find<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(faces);
  EXPECT_EQ(faces->coordIndex, (MFInt32{2, 1, 0, -1}));
  EXPECT_EQ(faces->texCoordIndex, (MFInt32{0, 1, 2, -1}));
  EXPECT_EQ(find<nodes::TextureCoordinate>(*world)->point, (MFVec2f{{0, 1}, {1, 0}, {0, 0.5f}}));
  EXPECT_EQ(find<nodes::Color>(*world)->color, (MFColor{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}));
  EXPECT_EQ(find<nodes::Normal>(*world)->vector, MFVec3f(3, Vec3f{0, 0, 1}));
  EXPECT_EQ(find<nodes::ImageTexture>(*world)->url, MFString{"skin.png"});
}

TEST(Meshes, PlyWithoutFacesIsPointsOrLines) {
  const std::string points = " 0 0 0 1 0 0 0 1 0\n";
  EXPECT_TRUE(
      find<nodes::PointSet>(*load(std::string(plyHead) + "end_header\n" + points, "a.ply")));
  const auto lines = load(std::string(plyHead) +
                              "element edge 2\nproperty int vertex1\n"
                              "property int vertex2\nend_header\n" +
                              points + "0 1\n1 2\n",
                          "a.ply");
  EXPECT_EQ(find<nodes::IndexedLineSet>(*lines)->coordIndex, (MFInt32{0, 1, -1, 1, 2, -1}));
}

TEST(Meshes, ObjIndicesCountFromBothEnds) {
  const auto world = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                          "f 1/3 2/2 3/1\nf -3/-1 -2/-2 -1/-3\n",
                          "a.obj");
  EXPECT_EQ(messages(*world), "");
  auto* faces = find<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(faces);
  EXPECT_EQ(faces->coordIndex, (MFInt32{0, 1, 2, -1, 0, 1, 2, -1}));
  EXPECT_EQ(find<nodes::TextureCoordinate>(*world)->point, (MFVec2f{{0, 1}, {1, 0}, {0, 0}}));
}

TEST(Meshes, ObjNumbersThatCannotBeReadAreZero) {
  const auto world = load("v 1 1e400 2\nv nan 0 0\nv 1 0 0\nf 1 2 3\n", "a.obj");
  EXPECT_NE(messages(*world).find("2 lines without the numbers"), std::string::npos);
  EXPECT_EQ(pointsOf(find<nodes::IndexedFaceSet>(*world)->coord),
            (MFVec3f{{1, 0, 0}, {0, 0, 0}, {1, 0, 0}}));
}

TEST(Meshes, ObjSmoothingGroupsAreShapesOfTheirOwn) {
  const auto world = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
                          "s off\nf 1 2 3\ns 2\nf 2 4 3\nf 1 2 4\n",
                          "a.obj");
  ASSERT_EQ(world->scope.roots.size(), 2u);
  auto* flat = findNode<nodes::IndexedFaceSet>(world->scope.roots[0].get());
  auto* smooth = findNode<nodes::IndexedFaceSet>(world->scope.roots[1].get());
  EXPECT_EQ(flat->creaseAngle, 0);
  EXPECT_EQ(flat->coordIndex.size(), 4u);
  EXPECT_GT(smooth->creaseAngle, 3);
  EXPECT_EQ(smooth->coordIndex.size(), 8u);
  // Each Shape has the points that it uses.
  EXPECT_EQ(pointsOf(flat->coord).size(), 3u);
}

TEST(Meshes, NamesBecomeValidAndUnique) {
  const auto world = load("v 0 0 0\nv 1 0 0\nv 0 1 0\ng a.b c\nf 1 2 3\ng 1\nf 1 2 3\n"
                          "g a_b_c\nf 1 2 3\n",
                          "a.obj");
  ASSERT_EQ(world->scope.roots.size(), 3u);
  EXPECT_EQ(world->scope.roots[0]->defName, "a_b_c");
  EXPECT_EQ(world->scope.roots[1]->defName, "_1");
  EXPECT_EQ(world->scope.roots[2]->defName, "a_b_c_2");
}

TEST(Meshes, GltfModesOfPrimitives) {
  const auto world = loadWorld("tests/conformance/good/mesh-gltf-modes-of-primitives.gltf");
  ASSERT_EQ(world->scope.roots.size(), 7u);
  const auto index = [&](size_t mode) {
    Node* root = world->scope.roots[mode].get();
    if (auto* lines = findNode<nodes::IndexedLineSet>(root)) return lines->coordIndex;
    if (auto* faces = findNode<nodes::IndexedFaceSet>(root)) return faces->coordIndex;
    return MFInt32();
  };
  EXPECT_TRUE(findNode<nodes::PointSet>(world->scope.roots[0].get()));
  // No lamp lights points: without a material they are white.
  auto* material = findNode<nodes::Material>(world->scope.roots[0].get());
  if (material) { EXPECT_EQ(material->emissiveColor, (Color{1, 1, 1})); }
  EXPECT_EQ(index(1), (MFInt32{0, 1, -1, 2, 3, -1}));
  EXPECT_EQ(index(2), (MFInt32{0, 1, 3, 2, 0, -1}));
  EXPECT_EQ(index(3), (MFInt32{0, 1, 2, 3, -1}));
  EXPECT_EQ(index(4), (MFInt32{0, 1, 2, -1, 0, 2, 3, -1}));
  EXPECT_EQ(index(5), (MFInt32{0, 1, 3, -1, 1, 2, 3, -1})); // every second one is turned
  EXPECT_EQ(index(6), (MFInt32{1, 2, 0, -1, 2, 3, 0, -1}));
}

TEST(Meshes, GltfAccessorsAreInterleavedNormalizedAndSparse) {
  const auto world = loadWorld("tests/conformance/good/mesh-gltf-accessors-and-scenes.gltf");
  auto* fan = find<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(fan);
  EXPECT_EQ(pointsOf(fan->coord), (MFVec3f{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  // The byte 128 is a linear number, of which 0.7366 is the sRGB code.
  const MFColor& colors = find<nodes::Color>(*world)->color;
  ASSERT_EQ(colors.size(), 4u);
  EXPECT_NEAR(colors[3].r, 1, 1e-6);
  EXPECT_EQ(colors[3].g, 0);
  EXPECT_NEAR(colors[3].b, 0.736647, 1e-5);
  EXPECT_EQ(pointsOf(find<nodes::PointSet>(*world)->coord),
            (MFVec3f{{0, 0, 0}, {0, 0, 0}, {5, 6, 7}, {0, 0, 0}}));
  auto* scenes = nodeCast<nodes::Switch>(world->scope.roots[0].get());
  ASSERT_TRUE(scenes);
  EXPECT_EQ(scenes->whichChoice, 0);
  EXPECT_EQ(scenes->choice.size(), 2u);
  // A quarter turn about z: x becomes y.
  auto* turned = nodeCast<nodes::Transform>(
      nodeCast<nodes::Group>(scenes->choice[0].get())->children[1].get());
  EXPECT_NEAR(turned->rotation.angle * turned->rotation.z, std::acos(-1) / 2, 1e-6);
  EXPECT_EQ(turned->translation, (Vec3f{3, 4, 5}));
}

TEST(Meshes, GltfAnimationsViewsAndLights) {
  const auto world =
      loadWorld("tests/conformance/good/mesh-gltf-materials-views-and-animations.glb");
  EXPECT_EQ(messages(*world), "");
  auto* clock = find<nodes::TimeSensor>(*world);
  ASSERT_TRUE(clock);
  EXPECT_EQ(clock->cycleInterval, 2);
  EXPECT_TRUE(clock->loop);
  auto* turns = find<nodes::OrientationInterpolator>(*world);
  EXPECT_EQ(turns->key, (MFFloat{0, 0.5f, 1}));
  EXPECT_NEAR(turns->keyValue[1].angle, std::acos(-1) / 2, 1e-5);
  // A step is two keys at one time.
  EXPECT_EQ(find<nodes::PositionInterpolator>(*world)->key, (MFFloat{0, 0.5f, 0.5f, 1, 1}));
  // Weight 1 at the second key moves by the whole target.
  auto* morph = find<nodes::CoordinateInterpolator>(*world);
  ASSERT_TRUE(morph);
  ASSERT_EQ(morph->keyValue.size(), 12u);
  EXPECT_EQ(morph->keyValue[4], (Vec3f{0, 0, 0.5f}));
  // The mesh itself stands at weight 0.5.
  EXPECT_EQ(pointsOf(NodeRef(world->scope.names.at("Morph")))[0], (Vec3f{0, 0, 0.25f}));
  // The width is the smaller side: tan(x / 2) = aspectRatio tan(y / 2).
  EXPECT_NEAR(find<nodes::Viewpoint>(*world)->fieldOfView, 2 * std::atan(0.5 * std::tan(0.35)),
              1e-6);
  EXPECT_NEAR(find<nodes::SpotLight>(*world)->cutOffAngle, 0.4, 1e-6);
  auto* image = find<nodes::ImageTexture>(*world);
  ASSERT_TRUE(image);
  EXPECT_TRUE(image->url[0].starts_with("data:image/png;base64,iVBOR"));
  EXPECT_FALSE(image->repeatS);
}

// glTF 2.0, 3.9.2: factors are linear. Nodes have sRGB codes.
TEST(Meshes, GltfColoursAreLinear) {
  const auto world = load(shown(R"("materials":[{"emissiveFactor":[0.5,0,0.001],
      "pbrMetallicRoughness":{"baseColorFactor":[0.2140411,1,0,1]}}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","color":[0.2140411,0,1]}]}})"),
                          "a.gltf");
  auto* physical = find<nodes::PhysicalMaterial>(*world);
  ASSERT_TRUE(physical);
  EXPECT_NEAR(physical->baseColor.r, 0.5, 1e-6);
  EXPECT_NEAR(physical->baseColor.g, 1, 1e-6);
  EXPECT_EQ(physical->baseColor.b, 0);
  EXPECT_NEAR(physical->emissiveColor.r, 0.735357, 1e-5);
  EXPECT_NEAR(physical->emissiveColor.b, 0.01292, 1e-6); // the straight part of the curve
  EXPECT_NEAR(find<nodes::PointLight>(*world)->color.r, 0.5, 1e-6);
}

// Lux and candela stay as they are: lights of X3D 4 have no upper limit.
TEST(Meshes, GltfLightsKeepTheirStrength) {
  const auto lit = [](const std::string& light) {
    return load(gltf(R"("nodes":[{"extensions":{"KHR_lights_punctual":{"light":0}}}],
      "scenes":[{"nodes":[0]}],"extensions":{"KHR_lights_punctual":{"lights":[{)" +
                     light + "}]}}"),
                "a.gltf");
  };
  const auto sun = lit(R"("type":"directional","intensity":10)");
  EXPECT_EQ(find<nodes::DirectionalLight>(*sun)->intensity, 10);
  EXPECT_EQ(messages(*sun), "");
  EXPECT_EQ(find<nodes::DirectionalLight>(*lit(R"("type":"directional")"))->intensity, 1);
  EXPECT_EQ(
      find<nodes::DirectionalLight>(*lit(R"("type":"directional","intensity":-1)"))->intensity, 0);
  const auto lamp = lit(R"("type":"point","intensity":5000)");
  EXPECT_EQ(find<nodes::PointLight>(*lamp)->intensity, 5000);
  EXPECT_EQ(find<nodes::PointLight>(*lamp)->attenuation, (Vec3f{0, 0, 1}));
  EXPECT_EQ(find<nodes::SpotLight>(*lit(R"("type":"spot","intensity":1e300)"))->intensity, 1e30f);
}

TEST(Meshes, GltfSamplersThatNeedTextureProperties) {
  const auto world = load(shown(R"("samplers":[{"wrapS":33648,"wrapT":33071,"magFilter":9728}],
      "images":[{"uri":"a.png"}],"textures":[{"source":0,"sampler":0}],
      "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"),
                          "a.gltf");
  auto* properties = find<nodes::TextureProperties>(*world);
  ASSERT_TRUE(properties);
  EXPECT_EQ(properties->boundaryModeS, "MIRRORED_REPEAT");
  EXPECT_EQ(properties->boundaryModeT, "CLAMP_TO_EDGE");
  EXPECT_EQ(properties->magnificationFilter, "NEAREST_PIXEL");
  EXPECT_EQ(messages(*world).find("MIRRORED"), std::string::npos) << messages(*world);
}

TEST(Meshes, GltfMatricesWithShearAreTheSameTransform) {
  const auto world = load(gltf(R"("nodes":[{"matrix":[1,0,0,0, 0.5,1,0,0, 0,0,2,0, 1,2,3,1]}],
                                   "scenes":[{"nodes":[0]}])"),
                          "a.gltf");
  auto* node = find<nodes::Transform>(*world);
  ASSERT_TRUE(node);
  // R SO S -SO of the standard, applied to the y axis, is the matrix' second column 0.5 1 0.
  const auto turn = [](const Rotation& r, double sign, Vec3f p) { // Rodrigues' formula
    const double c = std::cos(sign * r.angle), s = std::sin(sign * r.angle);
    const double d = (r.x * p.x + r.y * p.y + r.z * p.z) * (1 - c);
    return Vec3f{float(p.x * c + (r.y * p.z - r.z * p.y) * s + r.x * d),
                 float(p.y * c + (r.z * p.x - r.x * p.z) * s + r.y * d),
                 float(p.z * c + (r.x * p.y - r.y * p.x) * s + r.z * d)};
  };
  Vec3f p = turn(node->scaleOrientation, -1, {0, 1, 0});
  p = {p.x * node->scale.x, p.y * node->scale.y, p.z * node->scale.z};
  p = turn(node->rotation, 1, turn(node->scaleOrientation, 1, p));
  EXPECT_NEAR(p.x, 0.5, 1e-5);
  EXPECT_NEAR(p.y, 1, 1e-5);
  EXPECT_NEAR(p.z, 0, 1e-5);
}

// A size of 0 along one axis is allowed, and makes a figure flat.
TEST(Meshes, GltfFiguresMayBeFlat) {
  for (const char* place :
       {R"("scale":[2,3,0])", R"("matrix":[2,0,0,0, 0,3,0,0, 0,0,0,0, 0,0,0,1])",
        R"("matrix":[0,2,0,0, -3,0,0,0, 0,0,0,0, 0,0,0,1])"}) {
    SCOPED_TRACE(place);
    const auto world = load(
        gltf(std::string(R"("nodes":[{)") + place + R"(}],"scenes":[{"nodes":[0]}])"), "a.gltf");
    EXPECT_EQ(world->diagnostics.list().size(), 0u);
    auto* node = find<nodes::Transform>(*world);
    ASSERT_TRUE(node);
    EXPECT_NEAR(node->scale.x, 2, 1e-6);
    EXPECT_NEAR(node->scale.y, 3, 1e-6);
    EXPECT_NEAR(node->scale.z, 3e-6, 1e-9);
  }
  const auto world =
      load(gltf(R"("nodes":[{"scale":[0,0,1]}],"scenes":[{"nodes":[0]}])"), "a.gltf");
  EXPECT_EQ(world->diagnostics.warnings(), 0u); // X3D 4 allows it: nothing of it has an area
}

TEST(Meshes, HostileFilesCostLittle) {
  LoadOptions small;
  small.limits.worldBytes = 1 << 20;
  const std::string deep(5'000'000, '[');
  EXPECT_NE(messages(*load(gltf("\"extras\":" + deep), "a.gltf")).find("limit nesting="),
            std::string::npos);
  EXPECT_NE(messages(*load(gltf("\"extras\":[" + std::string(3'000'000, ' ') + "0" +
                                [] {
                                  std::string zeros;
                                  for (int i = 0; i < 100'000; ++i) zeros += ",0";
                                  return zeros;
                                }() +
                                "]"),
                           "a.gltf", small))
                .find("limit worldBytes="),
            std::string::npos);
  EXPECT_NE(messages(*load(binaryStl(100'000, 100'000), "a.stl", small)).find("limit worldBytes="),
            std::string::npos);
  // Numbers of rows and lists that the file has no bytes for.
  EXPECT_NE(messages(*load("ply\nformat binary_little_endian 1.0\nelement face 1\n"
                           "property list uint int vertex_indices\nend_header\n\xff\xff\xff\x7f",
                           "a.ply"))
                .find("does not fit into the file"),
            std::string::npos);
}

// A file names no files that a world may not name.
TEST(Meshes, OtherFilesFollowTheRulesOfUrls) {
  EXPECT_EQ(messages(*load(triangle(R"(,"images":[{"uri":"/etc/x.png"}])"), "a.gltf")),
            ""); // not shown
  const auto outside =
      load(gltf(R"("buffers":[{"byteLength":4,"uri":"/etc/passwd"}],"bufferViews":[{"buffer":0,
             "byteLength":4}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3",
             "count":1}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"),
           "a.gltf");
  EXPECT_NE(messages(*outside).find("absolute paths are not followed"), std::string::npos);
  EXPECT_NE(messages(*load("mtllib /etc/passwd\nv 0 0 0\n", "a.obj"))
                .find("absolute paths are not followed"),
            std::string::npos);
}

} // namespace
