// xvrml_vrml1_shapes.cpp: what shapes, lights and cameras of VRML 1.0 become: bindings of materials
// and normals, parts, hints. Expected values follow from the specification by hand.
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/mesh.h"
#include "parse/vrml1/shapes.h"
#include "unit/xvrml_vrml1_support.h"

namespace {

using namespace vrml1_test;
using vrml1::Binding;
using vrml1::boundIndices;

const std::string twoTriangles = "Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }\n";
const std::string faces = "IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 0, 2, 3, -1 ] }\n";
const MFInt32 coordIndex{0, 1, 2, -1, 0, 2, 3, -1};

TEST(Vrml1Shapes, BindingsChooseIndices) {
  EXPECT_EQ(vrml1::faceCount(coordIndex), 2u);
  EXPECT_EQ(vrml1::faceCount({0, 1, 2}), 1u);
  EXPECT_EQ(vrml1::faceCount({-1, -1}), 0u);
  EXPECT_EQ(boundIndices(coordIndex, {}, Binding::overall), (MFInt32{0, 0}));
  EXPECT_EQ(boundIndices(coordIndex, {}, Binding::perFace), (MFInt32{0, 1}));
  EXPECT_EQ(boundIndices(coordIndex, {5, 4}, Binding::perFace), (MFInt32{0, 1}));
  EXPECT_EQ(boundIndices(coordIndex, {5, 4}, Binding::perFaceIndexed), (MFInt32{5, 4}));
  EXPECT_EQ(boundIndices(coordIndex, {5, -1, 4}, Binding::perPartIndexed), (MFInt32{5, 4}));
  EXPECT_EQ(boundIndices(coordIndex, {5}, Binding::perFaceIndexed), (MFInt32{5, 0}));
  EXPECT_EQ(boundIndices(coordIndex, {-1}, Binding::perFaceIndexed), (MFInt32{0, 1}));
  EXPECT_EQ(boundIndices(coordIndex, {}, Binding::perVertex), (MFInt32{0, 1, 2, -1, 3, 4, 5, -1}));
  EXPECT_EQ(boundIndices(coordIndex, {-1}, Binding::perVertexIndexed), coordIndex);
  EXPECT_EQ(boundIndices(coordIndex, {9, 8, 7, -1, 6}, Binding::perVertexIndexed),
            (MFInt32{9, 8, 7, -1, 6, 0, 0, -1}));
}

TEST(Vrml1Shapes, MaterialsOfFacesAndVertices) {
  const std::string red = "Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1, 1 1 1 ] }\n";
  auto world = load(twoTriangles + red + "MaterialBinding { value PER_FACE }\n" + faces);
  auto* set = only<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(set && set->color);
  EXPECT_FALSE(set->colorPerVertex);
  EXPECT_EQ(set->colorIndex, (MFInt32{0, 1}));
  EXPECT_EQ(nodeCast<nodes::Color>(set->color)->color.at(2), (Color{0, 0, 1}));
  world = load(twoTriangles + red + "MaterialBinding { value PER_VERTEX_INDEXED }\n" + faces);
  set = only<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(set && set->color);
  EXPECT_TRUE(set->colorPerVertex);
  EXPECT_TRUE(set->colorIndex.empty()); // coordIndex
  world = load(twoTriangles + red + "MaterialBinding { value OVERALL }\n" + faces);
  EXPECT_FALSE(only<nodes::IndexedFaceSet>(*world)->color);
  EXPECT_EQ(only<nodes::Material>(*world)->diffuseColor, (Color{1, 0, 0}));
  // One material of the list for all faces is no list.
  world = load(twoTriangles + red + "MaterialBinding { value PER_FACE_INDEXED }\n" +
               "IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 0, 2, 3 ] materialIndex [ 2, 2 ] }");
  EXPECT_FALSE(only<nodes::IndexedFaceSet>(*world)->color);
  EXPECT_EQ(only<nodes::Material>(*world)->diffuseColor, (Color{0, 0, 1}));
}

// Transparency differs: two Shapes, each with its faces, normals and texture coordinates.
TEST(Vrml1Shapes, MaterialsThatDifferInMoreThanColourSplitTheShape) {
  const auto world =
      load(twoTriangles +
           "Material { diffuseColor [ 1 0 0, 0 1 0 ] transparency [ 0, 0.5 ] }\n"
           "MaterialBinding { value PER_FACE_INDEXED }\n"
           "Texture2 { image 1 1 3 0xff }\nNormal { vector [ 0 0 1, 0 1 0 ] }\n"
           "NormalBinding { value PER_FACE }\n"
           "IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 0, 2, 3, -1 ] materialIndex [ 1, 0 ] }");
  EXPECT_EQ(messagesOf(*world), Messages());
  const auto shapes = every<nodes::Shape>(*world);
  ASSERT_EQ(shapes.size(), 2u);
  const auto* opaque = nodeCast<nodes::IndexedFaceSet>(shapes[0]->geometry);
  const auto* glass = nodeCast<nodes::IndexedFaceSet>(shapes[1]->geometry);
  EXPECT_EQ(materialOf(*shapes[0])->transparency, 0);
  EXPECT_EQ(materialOf(*shapes[0])->diffuseColor, (Color{1, 0, 0}));
  EXPECT_EQ(opaque->coordIndex, (MFInt32{0, 2, 3, -1}));
  EXPECT_EQ(opaque->normalIndex, MFInt32{1});
  EXPECT_EQ(materialOf(*shapes[1])->transparency, 0.5f);
  EXPECT_EQ(glass->coordIndex, (MFInt32{0, 1, 2, -1}));
  EXPECT_EQ(glass->normalIndex, MFInt32{0});
  EXPECT_FALSE(glass->normalPerVertex);
  EXPECT_EQ(glass->coord, opaque->coord);
  // The default mapping is that of the whole shape.
  ASSERT_TRUE(glass->texCoord);
  EXPECT_EQ(glass->texCoord, opaque->texCoord);
  EXPECT_EQ(nodeCast<nodes::TextureCoordinate>(glass->texCoord)->point.at(2), (Vec2f{1, 1}));
}

TEST(Vrml1Shapes, PrecomputedLighting) {
  const auto world = load(twoTriangles +
                          "Material { ambientColor [ ] diffuseColor [ ] specularColor [ ]\n"
                          "  emissiveColor [ 1 0 0, 0 1 0 ] }\n"
                          "MaterialBinding { value PER_FACE }\n" +
                          faces);
  const auto* shape = only<nodes::Shape>(*world);
  EXPECT_FALSE(materialOf(*shape)); // VRML97: unlit, in the colours of the Color node
  EXPECT_EQ(only<nodes::Color>(*world)->color, (MFColor{{1, 0, 0}, {0, 1, 0}}));
}

// Files write black where the specification asks for empty lists, and colours for each vertex.
TEST(Vrml1Shapes, PrecomputedLightingOfVerticesBesideBlack) {
  const auto world =
      load(twoTriangles +
           "Material { diffuseColor 0 0 0 emissiveColor [ 1 0 0, 0 1 0, 0 0 1, 1 1 1 "
           "] }\nMaterialBinding { value PER_VERTEX_INDEXED }\n" +
           faces);
  EXPECT_EQ(messagesOf(*world), Messages());
  EXPECT_FALSE(materialOf(*only<nodes::Shape>(*world)));
  EXPECT_TRUE(only<nodes::IndexedFaceSet>(*world)->colorPerVertex);
  EXPECT_EQ(only<nodes::Color>(*world)->color,
            (MFColor{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}));
  // Highlights need light.
  const auto shiny =
      load(twoTriangles +
           "Material { diffuseColor 0 0 0 specularColor 1 1 1 emissiveColor [ 1 0 0, "
           "0 1 0 ] }\nMaterialBinding { value PER_FACE }\n" +
           faces);
  EXPECT_TRUE(materialOf(*every<nodes::Shape>(*shiny).at(0)));
}

TEST(Vrml1Shapes, TransparentPrecomputedLighting) {
  const auto world = load(twoTriangles +
                          "Material { diffuseColor [ ] emissiveColor [ 1 0 0, 0 1 0 ] transparency "
                          ".25 }\nMaterialBinding { value PER_FACE }\n" +
                          faces);
  EXPECT_FLOAT_EQ(only<nodes::UnlitMaterial>(*world)->transparency, .25f);
  EXPECT_EQ(only<nodes::Color>(*world)->color, (MFColor{{1, 0, 0}, {0, 1, 0}}));
}

TEST(Vrml1Shapes, AmbientIntensityIsAShare) {
  const auto world = load("Material { ambientColor .1 .1 .1 diffuseColor .4 .4 .4 }\nCube { }");
  const auto* material = only<nodes::Material>(*world);
  EXPECT_NEAR(material->ambientIntensity, 0.25, 1e-6);
}

TEST(Vrml1Shapes, NormalsBelongToVerticesByDefault) {
  const std::string four = "Normal { vector [ 0 0 1, 0 0 1, 0 0 1, 0 1 0 ] }\n";
  auto world = load(twoTriangles + four + faces);
  auto* set = only<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(set->normal);
  EXPECT_TRUE(set->normalPerVertex);
  EXPECT_TRUE(set->normalIndex.empty());
  // Too few: computed without a word, because nobody asked for them.
  world = load(twoTriangles + "Normal { vector [ 0 0 1 ] }\n" + faces);
  EXPECT_EQ(messagesOf(*world), Messages());
  EXPECT_FALSE(only<nodes::IndexedFaceSet>(*world)->normal);
  EXPECT_EQ(only<nodes::IndexedFaceSet>(*world)->creaseAngle, 0.5f);
  world = load(twoTriangles + "Normal { vector 0 0 1 }\nNormalBinding { value OVERALL }\n" + faces);
  set = only<nodes::IndexedFaceSet>(*world);
  EXPECT_FALSE(set->normalPerVertex);
  EXPECT_EQ(set->normalIndex, (MFInt32{0, 0}));
  world =
      load(twoTriangles + "Normal { vector 0 0 1 }\nNormalBinding { value PER_FACE }\n" + faces);
  EXPECT_EQ(world->diagnostics.warnings(), 1u);
}

TEST(Vrml1Shapes, Hints) {
  struct Case {
    const char* hints;
    bool ccw, solid, convex;
  };
  for (const auto& [hints, ccw, solid, convex] :
       {Case{"", true, false, true}, Case{"vertexOrdering CLOCKWISE", false, false, true},
        Case{"vertexOrdering COUNTERCLOCKWISE shapeType SOLID", true, true, true},
        Case{"shapeType SOLID", true, false, true},
        Case{"faceType UNKNOWN_FACE_TYPE", true, false, false}}) {
    const auto world = load(twoTriangles + "ShapeHints { " + hints + " }\n" + faces);
    const auto* set = only<nodes::IndexedFaceSet>(*world);
    EXPECT_EQ(set->ccw, ccw) << hints;
    EXPECT_EQ(set->solid, solid) << hints;
    EXPECT_EQ(set->convex, convex) << hints;
  }
}

TEST(Vrml1Shapes, PartsHaveMaterialsOfTheirOwn) {
  const std::string three = "Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] }\n"
                            "MaterialBinding { value PER_PART }\n";
  auto world = load(three + "Cylinder { parts ( SIDES | BOTTOM ) }");
  auto shapes = every<nodes::Shape>(*world);
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_TRUE(nodeCast<nodes::Cylinder>(shapes[0]->geometry)->side);
  EXPECT_FALSE(nodeCast<nodes::Cylinder>(shapes[0]->geometry)->bottom);
  EXPECT_EQ(materialOf(*shapes[1])->diffuseColor, (Color{0, 0, 1})); // the third part
  world = load(three + "Cone { }");
  shapes = every<nodes::Shape>(*world);
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_EQ(materialOf(*shapes[1])->diffuseColor, (Color{0, 1, 0}));
  EXPECT_EQ(every<nodes::Shape>(*load("Cone { parts NONE }")).size(), 0u);
  // A Cube: front, back, left, right, top, bottom; three materials begin again.
  world = load(three + "Cube { width 4 }");
  const auto* cube = only<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(cube);
  EXPECT_EQ(cube->colorIndex, (MFInt32{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(nodeCast<nodes::Coordinate>(cube->coord)->point.at(0), (Vec3f{-2, -1, 1}));
}

TEST(Vrml1Shapes, LinesAndPoints) {
  const std::string head = twoTriangles + "Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] }\n";
  auto world = load(head + "MaterialBinding { value PER_PART }\n"
                           "IndexedLineSet { coordIndex [ 0, 1, 2, -1, 3, 0 ] }");
  const auto* lines = only<nodes::IndexedLineSet>(*world);
  EXPECT_EQ(lines->coordIndex, (MFInt32{0, 1, -1, 1, 2, -1, 3, 0, -1}));
  EXPECT_EQ(lines->colorIndex, (MFInt32{0, 1, 2}));
  EXPECT_FALSE(lines->colorPerVertex);
  EXPECT_EQ(only<nodes::Material>(*world)->emissiveColor, (Color{1, 0, 0}));
  world = load(head + "MaterialBinding { value PER_VERTEX }\n"
                      "PointSet { startIndex 1 numPoints 2 }");
  const auto* points = only<nodes::PointSet>(*world);
  EXPECT_EQ(nodeCast<nodes::Coordinate>(points->coord)->point, (MFVec3f{{1, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(nodeCast<nodes::Color>(points->color)->color, (MFColor{{1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(load(head + "PointSet { startIndex 3 numPoints 9 }")->diagnostics.warnings(), 1u);
}

TEST(Vrml1Shapes, SizesThatVrml97DoesNotAllow) {
  const auto world = load("Cube { depth 0 }\nCylinder { radius -2 height 0 }\nSphere { radius 0 }");
  EXPECT_EQ(messagesOf(*world), Messages());
  EXPECT_EQ(every<nodes::Shape>(*world).size(), 2u);
  EXPECT_GT(only<nodes::Box>(*world)->size.z, 0);
  EXPECT_LT(only<nodes::Box>(*world)->size.z, 1e-4f);
  EXPECT_EQ(only<nodes::Cylinder>(*world)->radius, 2);
}

// A light shines on what follows it in its Separator.
TEST(Vrml1Shapes, LightsAreNested) {
  const auto world =
      load("Separator { Cube { } Translation { translation 1 0 0 }\n"
           "  DEF L PointLight { location 0 2 0 } DirectionalLight { } Sphere { } }\n"
           "Cone { }");
  EXPECT_EQ(messagesOf(*world), Messages());
  const auto* outer = nodeCast<nodes::Group>(world->scope.roots.at(0));
  ASSERT_TRUE(outer);
  ASSERT_EQ(outer->children.size(), 2u); // the Cube, and all that the lights shine on
  const auto* lit = nodeCast<nodes::Group>(outer->children[1]);
  ASSERT_TRUE(lit);
  ASSERT_EQ(lit->children.size(), 3u);
  const auto* light = nodeCast<nodes::PointLight>(lit->children[0]);
  EXPECT_EQ(light->location, (Vec3f{1, 2, 0})); // with the translation
  EXPECT_GE(light->radius, 1e9f);
  EXPECT_TRUE(nodeCast<nodes::DirectionalLight>(lit->children[1]));
  EXPECT_TRUE(nodeCast<nodes::Transform>(lit->children[2]));
  EXPECT_EQ(world->scope.names.at("L").get(), light);
}

// The light of a spot is half as bright at the same angle in both versions.
TEST(Vrml1Shapes, SpotsFallToOneHalfAtTheSameAngle) {
  const auto even = load("SpotLight { cutOffAngle 0.5 }");
  EXPECT_EQ(only<nodes::SpotLight>(*even)->beamWidth, 0.5f);
  const auto world = load("SpotLight { cutOffAngle 1.5 dropOffRate 0.0625 }"); // exponent 8
  const auto* light = only<nodes::SpotLight>(*world);
  const double half = (double(light->beamWidth) + double(light->cutOffAngle)) / 2;
  EXPECT_NEAR(std::pow(std::cos(half), 8), 0.5, 1e-3);
}

// VRML97 has no `solid` for Cone and Cylinder, and draws only their outside.
TEST(Vrml1Shapes, WrittenAsVrml97HasNoFieldsOfX3d) {
  // Parts that are Shapes of their own close the body together.
  const std::string three = "Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] }\n"
                            "MaterialBinding { value PER_PART }\n";
  for (const char* closed : {"Cone { }", "Cylinder { }", "Cone { parts ( SIDES | BOTTOM ) }"}) {
    const std::string text = writeWorld(*load(three + closed));
    EXPECT_EQ(text.find("solid"), std::string::npos) << text;
    EXPECT_EQ(messagesOf(*loadWorldFromMemory(text, "new.wrl")), Messages());
  }
  for (const char* open : {"DEF A Cone { parts SIDES } USE A", "Cylinder { parts SIDES }",
                           "Cylinder { parts ( SIDES | BOTTOM ) }", "Cone { parts BOTTOM }"}) {
    const auto old = load(open);
    const auto world = loadWorldFromMemory(writeWorld(*old), "new.wrl");
    EXPECT_EQ(messagesOf(*world), Messages()) << open;
    const auto shapes = every<nodes::Shape>(*world), before = every<nodes::Shape>(*old);
    ASSERT_EQ(shapes.size(), before.size());
    MeshOptions options;
    options.needTexCoords = true;
    const Mesh was = buildMesh(*before[0]->geometry, options);
    const Mesh is = buildMesh(*shapes[0]->geometry, options);
    EXPECT_FALSE(is.solid);
    EXPECT_EQ(is.indices.size(), was.indices.size()) << open;
    ASSERT_EQ(is.points.size(), was.points.size()) << open;
    for (size_t i = 0; i < is.indices.size(); i++) {
      EXPECT_EQ(is.points[is.indices[i]], was.points[was.indices[i]]) << open;
      EXPECT_EQ(is.texCoords[is.indices[i]], was.texCoords[was.indices[i]]) << open;
      EXPECT_NEAR(is.normals[is.indices[i]].y, was.normals[was.indices[i]].y, 1e-6) << open;
    }
    // X3D has the field.
    EXPECT_NE(writeWorld(*old, "", Encoding::x3dClassic).find("solid FALSE"), std::string::npos);
  }
}

TEST(Vrml1Shapes, ManyOpenShapesDoNotFillTheMemory) {
  std::string many;
  for (int i = 0; i < 5010; i++)
    many += "Cone { parts SIDES height " + std::to_string(i + 1) + " }\n";
  const std::string text = writeWorld(*load(many));
  size_t cones = 0;
  for (size_t at = 0; (at = text.find("geometry Cone", at)) != text.npos; at++) cones++;
  EXPECT_EQ(cones, 10u);
}

TEST(Vrml1Shapes, Cameras) {
  const auto world = load("DEF Cameras Switch { whichChild 1\n"
                          "  DEF Front PerspectiveCamera { position 0 0 9 heightAngle 1 }\n"
                          "  DEF Top PerspectiveCamera { position 0 9 0 } }\nCube { }");
  EXPECT_EQ(messagesOf(*world), Messages());
  const auto views = every<nodes::Viewpoint>(*world);
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0]->description, "Top"); // the chosen one is the first
  EXPECT_EQ(views[1]->description, "Front");
  EXPECT_EQ(views[1]->position, (Vec3f{0, 0, 9}));
  EXPECT_EQ(views[1]->fieldOfView, 1);
}

// Two extensions of one browser: the view along +x is a turn by -90 degrees about y.
TEST(Vrml1Shapes, CamerasWithADirection) {
  const auto world = load("PerspectiveCamera { direction 1 0 0 up 0 1 0 }");
  EXPECT_EQ(world->diagnostics.warnings(), 2u);
  const Rotation turn = only<nodes::Viewpoint>(*world)->orientation;
  EXPECT_NEAR(double(turn.y) * double(turn.angle), -std::numbers::pi / 2, 1e-6);
}

} // namespace
