// xvrml_vrml1.cpp: files in VRML 1.0: spellings, the traversal state, transformations, sharing,
// limits and messages. Expected values follow from the specification (26 May 1995) by hand.
#include <fstream>

#include <gtest/gtest.h>

#include "unit/xvrml_vrml1_support.h"

namespace {

using namespace vrml1_test;

TEST(Vrml1, HeadersAndVersions) {
  const auto world = load("Cube { }");
  EXPECT_EQ(world->head.version, (FileVersion{Encoding::vrml1, 1, 0}));
  EXPECT_EQ(versionOf(*world->scope.roots.at(0)).encoding, Encoding::vrml1);
  EXPECT_TRUE(world->head.version.texturesMultiply());
  EXPECT_FALSE(world->head.version.isX3d());
  EXPECT_EQ(messagesOf(*loadWorldFromMemory("# VRML V1.0 ascii\nCube { }", "a.wrl")).size(), 1u);
  const auto inventor = loadWorldFromMemory("#Inventor V2.1 ascii\nSelection { Cube { } }", "a.iv");
  EXPECT_EQ(only<nodes::Box>(*inventor)->size, (Vec3f{2, 2, 2}));
  EXPECT_EQ(inventor->diagnostics.warnings(), 1u);
}

TEST(Vrml1, SpellingsOfValues) {
  const auto world = load("DEF a+b Texture2 { filename pictures/wall.gif wrapS CLAMP }\n"
                          "PointLight { on 0 location 1 2 3 }\n"
                          "Cylinder { parts (SIDES | TOP) radius 2.  height +.5e1 }\n"
                          "AsciiText { string [ \"two words\", one ] justification CENTER }");
  EXPECT_EQ(messagesOf(*world), Messages());
  const auto all = every<nodes::Shape>(*world);
  const auto* cylinder = nodeCast<nodes::Cylinder>(all.at(0)->geometry);
  EXPECT_TRUE(cylinder->side && cylinder->top && !cylinder->bottom);
  EXPECT_EQ(cylinder->radius, 2);
  EXPECT_EQ(cylinder->height, 5);
  const auto* picture =
      nodeCast<nodes::ImageTexture>(nodeCast<nodes::Appearance>(all.at(0)->appearance)->texture);
  EXPECT_EQ(picture->url, MFString{"pictures/wall.gif"});
  EXPECT_FALSE(picture->repeatS);
  EXPECT_TRUE(picture->repeatT);
  const auto* text = nodeCast<nodes::Text>(all.at(1)->geometry);
  EXPECT_EQ(text->string, (MFString{"two words", "one"}));
  EXPECT_EQ(nodeCast<nodes::FontStyle>(text->fontStyle)->justify, MFString{"MIDDLE"});
  EXPECT_EQ(nodeCast<nodes::FontStyle>(text->fontStyle)->size, 10);
  EXPECT_FALSE(only<nodes::PointLight>(*world)->on);
}

TEST(Vrml1, SeparatorsRestoreTheStateAndGroupsLeaveIt) {
  const auto world = load("Material { diffuseColor 1 0 0 }\n"
                          "Separator { Material { diffuseColor 0 1 0 } Cube { } }\n"
                          "Cube { }\n"
                          "Group { Material { diffuseColor 0 0 1 } }\n"
                          "Cube { }\n"
                          "TransformSeparator { Translation { translation 9 0 0 }\n"
                          "  Material { diffuseColor 1 1 1 } }\n"
                          "Cube { }");
  std::vector<Color> colours;
  for (const auto* shape : every<nodes::Shape>(*world))
    colours.push_back(materialOf(*shape)->diffuseColor);
  EXPECT_EQ(colours, (std::vector<Color>{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {1, 1, 1}}));
  EXPECT_TRUE(every<nodes::Transform>(*world).empty()); // the translation has ended
}

TEST(Vrml1, TransformationsAccumulate) {
  const auto world = load("Translation { translation 1 0 0 }\nCube { }\nSphere { }\n"
                          "Rotation { rotation 0 0 1 1.5707963 }\nCube { }\n"
                          "Scale { scaleFactor 2 3 4 }\nCube { }\n"
                          "Translation { translation 1 0 0 }\nCube { }");
  const auto all = every<nodes::Transform>(*world);
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0]->translation, (Vec3f{1, 0, 0}));
  EXPECT_EQ(all[0]->children.size(), 2u); // both at one place
  EXPECT_EQ(all[1]->rotation, (Rotation{0, 0, 1, 1.5707963f}));
  EXPECT_EQ(all[2]->scale, (Vec3f{2, 3, 4}));
  EXPECT_EQ(all[2]->translation, (Vec3f{1, 0, 0}));
  // (1 0 0) is scaled to (2 0 0), turned to (0 2 0), and moved.
  EXPECT_NEAR(all[3]->translation.x, 1, 1e-6);
  EXPECT_NEAR(all[3]->translation.y, 2, 1e-6);
  EXPECT_NEAR(all[3]->scale.y, 3, 1e-6);
  EXPECT_NEAR(all[3]->rotation.angle, 1.5707963, 1e-6);
}

// Any matrix without a perspective part becomes a Transform with the same matrix.
TEST(Vrml1, MatricesAreDecomposed) {
  for (const std::string rows : {"0 2 0 0 -3 0 0 0 0 0 4 0 5 6 7 1",       // turned and scaled
                                 "1 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1",        // sheared
                                 "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",       // mirrored
                                 "1 .5 0 0 0 1 .25 0 .125 0 -1 0 1 2 3 1", // sheared and mirrored
                                 "2 0 0 0 0 0 0 0 0 0 1 0 0 0 0 1",        // flat
                                 "2 0 0 0 0 2 0 0 0 0 2 0 4 0 0 2"}) {     // w is 2
    const auto world = load("MatrixTransform { matrix " + rows + " }\nCube { }");
    EXPECT_EQ(messagesOf(*world), Messages()) << rows;
    Matrix wanted;
    std::istringstream numbers(rows);
    for (int i = 0; i < 16; ++i) numbers >> wanted[i / 4][i % 4];
    wanted *= 1 / wanted[3][3];
    const auto* t = only<nodes::Transform>(*world);
    ASSERT_TRUE(t);
    const Matrix made =
        transformMatrix({t->center, t->translation, t->scale, t->rotation, t->scaleOrientation});
    for (int i = 0; i < 16; ++i)
      EXPECT_NEAR(made[i / 4][i % 4], wanted[i / 4][i % 4], 2e-6) << rows << " at " << i;
  }
  const auto world =
      load("MatrixTransform { matrix 1 0 0 .5  0 1 0 0  0 0 1 0  7 0 0 1 }\nCube { }");
  EXPECT_EQ(only<nodes::Transform>(*world)->translation, (Vec3f{7, 0, 0}));
  ASSERT_EQ(messagesOf(*world).size(), 1u);
  EXPECT_NE(messagesOf(*world)[0].find("test.wrl:2:1: warning: the perspective part"),
            std::string::npos);
}

TEST(Vrml1, TextureTransformations) {
  const std::string textured = "Texture2 { image 1 1 1 255 }\n";
  // s' = 2 s + 0.5 is 2 (s + 0.25): VRML97 moves first.
  auto world = load(textured + "Texture2Transform { translation .5 0 scaleFactor 2 4 }\nCube { }");
  const auto* t = only<nodes::TextureTransform>(*world);
  ASSERT_TRUE(t);
  EXPECT_NEAR(t->translation.x, 0.25, 1e-6);
  EXPECT_NEAR(t->scale.x, 2, 1e-6);
  EXPECT_NEAR(t->scale.y, 4, 1e-6);
  EXPECT_NEAR(t->rotation, 0, 1e-6);
  // Scale about the centre (1 1): s' = 2 s - 1, and a second node that halves it again.
  world = load(textured + "Texture2Transform { center 1 1 scaleFactor 2 2 }\n"
                          "Texture2Transform { scaleFactor .5 .5 }\nCube { }");
  t = only<nodes::TextureTransform>(*world);
  EXPECT_NEAR(t->scale.x, 1, 1e-6);
  EXPECT_NEAR(t->translation.x, -1, 1e-6);
  // A scale and then a turn by 45 degrees is no TextureTransform: the coordinates are changed.
  world = load(textured + "Texture2Transform { scaleFactor 2 1 rotation .78539816 }\n"
                          "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] }\n"
                          "TextureCoordinate2 { point [ 0 0, 1 0, 0 1 ] }\n"
                          "IndexedFaceSet { coordIndex [ 0, 1, 2 ] }");
  EXPECT_FALSE(only<nodes::TextureTransform>(*world));
  const auto* c = only<nodes::TextureCoordinate>(*world);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->point[1].x, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(c->point[1].y, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(c->point[2].x, -std::sqrt(0.5), 1e-6);
}

TEST(Vrml1, UsesShareWhatTheyCan) {
  const auto world = load("Material { diffuseColor 1 0 0 }\n"
                          "DEF C Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] }\n"
                          "DEF S Separator { DEF F IndexedFaceSet { coordIndex [ 0, 1, 2 ] } }\n"
                          "Translation { translation 1 0 0 }\nUSE S\n"
                          "FontStyle { size 3 }\nUSE S\n" // a property that S does not depend on
                          "Material { diffuseColor 0 1 0 }\nUSE S\nUSE F");
  EXPECT_EQ(messagesOf(*world), Messages());
  const auto uses = every<nodes::Shape>(*world);
  ASSERT_EQ(uses.size(), 5u);
  EXPECT_EQ(uses[0], uses[1]);
  EXPECT_EQ(uses[0], uses[2]);
  EXPECT_NE(uses[0], uses[3]);
  EXPECT_EQ(uses[3], uses[4]);
  EXPECT_EQ(materialOf(*uses[3])->diffuseColor, (Color{0, 1, 0}));
  EXPECT_EQ(nodeCast<nodes::IndexedFaceSet>(uses[0]->geometry)->coord,
            nodeCast<nodes::IndexedFaceSet>(uses[3]->geometry)->coord);
  EXPECT_TRUE(nodeCast<nodes::Coordinate>(world->scope.names.at("C")));
}

// An inner Separator that restores a property leaves the outer one dependent on it.
TEST(Vrml1, UsesAreConvertedAgainInAnotherState) {
  const auto world = load("Material { diffuseColor 1 0 0 }\n"
                          "DEF S Separator { Separator { Material { } Sphere { } } Cube { } }\n"
                          "Material { diffuseColor 0 0 1 }\nUSE S");
  std::vector<Color> colours;
  for (const auto* shape : every<nodes::Shape>(*world))
    if (nodeCast<nodes::Box>(shape->geometry)) colours.push_back(materialOf(*shape)->diffuseColor);
  EXPECT_EQ(colours, (std::vector<Color>{{1, 0, 0}, {0, 0, 1}}));
}

TEST(Vrml1, UsesOfUsesEndAtLimits) {
  for (const std::string group : {"Separator", "Group"}) {
    std::string text = "DEF N0 " + group + " { Cube { } }\n";
    for (int i = 1; i < 40; ++i) {
      const std::string inner = "USE N" + std::to_string(i - 1) + " ";
      text += "DEF N" + std::to_string(i) + " " + group + " { " + inner + inner + "}\n";
    }
    LoadOptions options;
    options.limits.expandedNodes = 10'000;
    const auto world = load(text, options);
    EXPECT_GE(world->diagnostics.errors(), 1u) << group;
    EXPECT_NE(messagesOf(*world)[0].find("expandedNodes=10000"), std::string::npos)
        << messagesOf(*world)[0];
    EXPECT_LT(world->nodeCount, 10'100u);
  }
}

TEST(Vrml1, DepthIsCountedThroughUses) {
  std::string text = "DEF N0 Separator { Cube { } Sphere { } }\n";
  for (int i = 1; i < 3000; ++i)
    text += "Switch { DEF N" + std::to_string(i) + " Separator { USE N" + std::to_string(i - 1) +
            " Sphere { } } }\n";
  text += "USE N2999";
  const auto world = load(text);
  ASSERT_EQ(world->diagnostics.errors(), 1u);
  EXPECT_NE(messagesOf(*world)[0].find("nesting=1000"), std::string::npos);
  std::string nested;
  for (int i = 0; i < 3000; ++i) nested += "Separator { ";
  EXPECT_GE(load(nested)->diagnostics.errors(), 1u);
  LoadOptions options;
  options.limits.nesting = 5000;
  EXPECT_GE(load(nested + "Cube { }", options)->diagnostics.errors(), 1u);
}

// N uses of a big shape in N states share its points.
TEST(Vrml1, MemoryGrowsWithTheUsesAndNotWithTheirProduct) {
  std::string text = "DEF C Coordinate3 { point [ ";
  for (int i = 0; i < 20'000; ++i) text += "0 0 " + std::to_string(i) + ", ";
  text += "] }\n";
  for (int i = 0; i < 500; ++i)
    text += "Material { transparency 0.5 }\nIndexedLineSet { coordIndex [ 0, 1 ] }\nPointSet { }\n";
  LoadOptions options;
  options.limits.worldBytes = 8 << 20; // 500 copies of the points would take 120 MB
  EXPECT_EQ(messagesOf(*load(text, options)), Messages());
}

TEST(Vrml1, ExtensionNodes) {
  const auto world = load("Paint { fields [ MFString isA, MFColor diffuseColor, SFFloat gloss ]\n"
                          "  isA [ \"Material\" ] gloss 3 diffuseColor 1 0 0 }\n"
                          "Strange { fields [ SFLong size ] size 5 Separator { Sphere { } } }\n"
                          "Strange { }\nCube { fields [ SFFloat width ] width 4 }");
  ASSERT_EQ(messagesOf(*world),
            Messages{"test.wrl:4:1: warning: 'Strange' is not a node of VRML 1.0; it is left out"});
  EXPECT_EQ(every<nodes::Shape>(*world).size(), 1u);
  EXPECT_EQ(only<nodes::Box>(*world)->size.x, 4);
  EXPECT_EQ(materialOf(*every<nodes::Shape>(*world)[0])->diffuseColor, (Color{1, 0, 0}));
}

TEST(Vrml1, NodesOfVrml97) {
  const auto world = load("Background { skyColor [ 0 0 1 ] }\nFog { visibilityRange 10 }\n"
                          "DEF Viewer Info { string \"walk\" }\n"
                          "DEF Title Info { string \"A title\" }");
  EXPECT_EQ(messagesOf(*world), Messages());
  EXPECT_EQ(only<nodes::Background>(*world)->skyColor, (MFColor{{0, 0, 1}}));
  EXPECT_EQ(only<nodes::Fog>(*world)->visibilityRange, 10);
  EXPECT_EQ(only<nodes::NavigationInfo>(*world)->type, (MFString{"WALK", "ANY"}));
  EXPECT_EQ(only<nodes::WorldInfo>(*world)->title, "A title");
  const auto colour = load("DEF BackgroundColor Info { string \"0.25 0.5 1\" }");
  EXPECT_EQ(only<nodes::Background>(*colour)->skyColor, (MFColor{{0.25f, 0.5f, 1}}));
}

TEST(Vrml1, GroupsWithFieldsOfTheirOwn) {
  const auto world = load("WWWAnchor { name \"x.wrl\" description \"there\" Cube { } }\n"
                          "LOD { range [ 5, 10 ] center 1 2 3 Cube { } Group { } Sphere { } }\n"
                          "Switch { whichChild 1 Cone { } Cylinder { } }\n"
                          "Switch { Cone { } }\n"
                          "WWWInline { name \"\" }\n");
  EXPECT_EQ(messagesOf(*world), Messages());
  const auto* anchor = only<nodes::Anchor>(*world);
  EXPECT_EQ(anchor->url, MFString{"x.wrl"});
  EXPECT_EQ(anchor->description, "there");
  EXPECT_EQ(anchor->children.size(), 1u);
  const auto* lod = only<nodes::LOD>(*world);
  ASSERT_EQ(lod->level.size(), 3u);
  EXPECT_EQ(lod->range, (MFFloat{5, 10}));
  EXPECT_EQ(lod->center, (Vec3f{1, 2, 3}));
  EXPECT_TRUE(nodeCast<nodes::Group>(lod->level[1])->children.empty());
  EXPECT_EQ(every<nodes::Cone>(*world).size(), 0u);
  EXPECT_EQ(every<nodes::Cylinder>(*world).size(), 1u);
}

TEST(Vrml1, FilesOfBothVersionsHoldEachOther) {
  const parser_test::Folder folder;
  folder.write("old.wrl", "#VRML V1.0 ascii\nWWWInline { name \"new.wrl\" bboxSize 2 2 2 }");
  folder.write("new.wrl", "#VRML V2.0 utf8\nShape { geometry Sphere { } }");
  const auto world = loadWorld(
      folder.write("world.wrl", "#VRML V2.0 utf8\nGroup { children Inline { url \"old.wrl\" } }"));
  EXPECT_EQ(messagesOf(*world), Messages());
  const auto* inner = only<nodes::Inline>(*world);
  ASSERT_TRUE(inner && inlineScope(*inner));
  const Node* old = inlineScope(*inner)->roots.at(0).get();
  EXPECT_EQ(versionOf(*old).encoding, Encoding::vrml1);
  EXPECT_EQ(static_cast<const nodes::Inline*>(old)->bboxSize, (Vec3f{2, 2, 2}));
  ASSERT_TRUE(inlineScope(*old));
  EXPECT_EQ(versionOf(*inlineScope(*old)->roots.at(0)), FileVersion());
}

} // namespace
