// mapper_budget.cpp: Tests what the mapper draws from the budget of a world, and the messages about
// shapes that would vanish in silence.
#include <malloc.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/budget.h"
#include "mapper/graph/cost.h"
#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

using namespace mapper;

std::string messages(const World& world) {
  std::string text;
  for (const Diagnostic& d : world.diagnostics.list()) text += d.text() + "\n";
  return text;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

class MapBudget : public MapRunning {
 protected:
  // Draws a still world once; `room`: bytes beyond what its nodes take, 0 for the default.
  MapStats draw(const std::string& body, uint64_t room = 0) {
    const std::string text = "#VRML V2.0 utf8\n" + body;
    LoadOptions options;
    if (room > 0)
      options.limits.worldBytes = budgetOf(*loadWorldFromMemory(text, "test.wrl"))->used() + room;
    mapper_.reset();
    world_ = loadWorldFromMemory(text, "test.wrl", options);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    mapper_->map(mapper_->viewpointCamera(0));
    return mapper_->stats();
  }
  void expectRefused(const std::string& what) {
    const std::string text = messages(*world_);
    EXPECT_GE(count(text, "limit worldBytes="), 1u) << text;
    EXPECT_LE(count(text, "limit worldBytes="), 4u) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
    EXPECT_LE(budgetOf(*world_)->used(), budgetOf(*world_)->limit());
  }
};

TEST_F(MapBudget, Lights) {
  const std::string lights = repeat("PointLight { }\n", 500);
  EXPECT_EQ(draw(lights).lights, 501u); // and the headlight
  EXPECT_EQ(messages(*world_), "");
  EXPECT_LT(draw(lights, 1'000'000).lights, 450u);
  expectRefused("lights from here on are left out");
}

// Returns the number of bytes that are allocated.
uint64_t heap() { return mallinfo2().uordblks + mallinfo2().hblkhd; }

// The API keeps no values of a light's parameters once more for geometry, which has none of lights.
TEST_F(MapBudget, LightsInTheApi) {
  if (heap() == 0) GTEST_SKIP() << "this allocator does not tell what it holds";
  const std::string lights = repeat("SpotLight { }\n", 4000);
  draw(lights);
  const uint64_t before = (mapper_.reset(), world_.reset(), heap());
  EXPECT_EQ(draw(lights).lights, 4001u);
  EXPECT_LT((heap() - before) / 4000, 3000u);
}

// Lights that are left out leave nothing behind that is not counted.
TEST_F(MapBudget, LightsThatAreLeftOut) {
  if (heap() == 0) GTEST_SKIP() << "this allocator does not tell what it holds";
  const std::string lights =
      repeat("PointLight { intensity .5 attenuation 1 2 3 location 4 5 6 }\n", 5000);
  draw(lights, 5000 * (bytesOfItem + bytesOfPlace) + 1'000'000);
  const uint64_t before = (mapper_.reset(), world_.reset(), heap());
  const uint64_t drawn = draw(lights, 5000 * (bytesOfItem + bytesOfPlace) + 1'000'000).lights;
  EXPECT_LT(drawn, 600u);
  EXPECT_LT(heap() - before, budgetOf(*world_)->used());
}

// A light that goes out keeps its shader, and what is counted for it, until its node goes.
TEST_F(MapBudget, LightsThatGoOut) {
  load("DEF G Group { children DEF L PointLight { } }");
  const uint64_t on = budgetOf(*world_)->used();
  send("L", "set_on", false);
  frame();
  EXPECT_EQ(budgetOf(*world_)->used(), on - bytesOfLight);
  send("L", "set_on", true);
  frame();
  EXPECT_EQ(budgetOf(*world_)->used(), on);
  send("G", "children", MFNode());
  frame();
  EXPECT_LE(budgetOf(*world_)->used(), on - bytesOfLight - bytesOfLightShader);
}

// In a world with many appearances, equal ones share a shader.
TEST_F(MapBudget, EqualAppearancesShareAShader) {
  const auto shape = [](int green) {
    return "Shape { appearance Appearance { material Material { diffuseColor 0 ." +
           std::to_string(green) + " 0 } } geometry Box { } }\n";
  };
  const auto used = [&](const std::string& body) {
    draw(body);
    return budgetOf(*world_)->used();
  };
  const std::string many = repeat(shape(1), 300);
  const uint64_t before = used(many + repeat("Shape { geometry Box { } }\n", 100));
  const uint64_t equal = used(many + repeat(shape(1), 100));
  std::string others;
  for (int i = 0; i < 100; ++i) others += shape(200 + i);
  const uint64_t different = used(many + others);
  EXPECT_EQ(messages(*world_), "");
  EXPECT_EQ(different - equal, 100 * (bytesOfSurface - bytesOfSharedSurface));
  EXPECT_LT(before, equal);
  EXPECT_GT(before + 100 * bytesOfSurface, equal);
}

// Each appearance with a material has a shader of its own, and with it the texts of the options.
TEST_F(MapBudget, OptionsOfShaders) {
  const std::string text = "Shape { appearance ORTAppearance { material Material { } shader DEF S "
                           "ORTShader { name \"Diffuse\" file \"diffuse\" options \"string note " +
                           std::string(100'000, 'x') + "\" } } geometry Box { } }\n" +
                           repeat("Shape { appearance ORTAppearance { material Material { } shader "
                                  "USE S } geometry Box { } }\n",
                                  9);
  draw(text);
  EXPECT_EQ(count(messages(*world_), "limit worldBytes="), 0u) << messages(*world_);
  EXPECT_GT(budgetOf(*world_)->used(), 10u * 200'000);
  draw(text, 1'000'000);
  EXPECT_EQ(count(messages(*world_), "options of shaders from here on are left out"), 1u)
      << messages(*world_);
  EXPECT_LE(budgetOf(*world_)->used(), budgetOf(*world_)->limit());
}

TEST_F(MapBudget, TrianglesOfOneGeometry) {
  const std::string text = "Shape { geometry Text { string [ " + repeat("\"abc\" ", 1000) + "] } }";
  const uint64_t all = draw(text).triangles;
  EXPECT_EQ(messages(*world_), "");
  const uint64_t some = draw(text, 5'000'000).triangles;
  EXPECT_LT(some, all / 2);
  expectRefused("Text: ");
  draw("Shape { geometry " + grid(300) + " }", 5'000'000);
  expectRefused("ElevationGrid: ");
}

TEST_F(MapBudget, Shapes) {
  const std::string shapes = repeat("Shape { geometry Box { } }\n", 500);
  EXPECT_EQ(draw(shapes).triangles, 6000u);
  draw(shapes, 700'000);
  expectRefused("from here on are left out");
}

TEST_F(MapBudget, Instances) {
  const std::string text = "DEF T Transform { children ORTInstance { children Shape { geometry " +
                           grid(5) + " } } }\n" + repeat("Transform { children USE T }\n", 1000);
  EXPECT_GT(draw(text).instances, 1000u);
  EXPECT_EQ(messages(*world_), "");
  EXPECT_LT(draw(text, 1'500'000).instances, 1000u);
  expectRefused("from here on are left out");
}

// Groups that instantiate groups multiply when they are flattened.
// Each shape of an object takes room for each of its instances.
TEST_F(MapBudget, ShapesInInstances) {
  if (heap() == 0) GTEST_SKIP() << "this allocator does not tell what it holds";
  const std::string shape =
      "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 0 0 1 ] } "
      "coordIndex [ 0 1 2 -1 0 1 3 -1 0 2 3 -1 1 2 3 ] } }\n";
  const std::string world = "DEF G Group { children [\n" + repeat(shape, 16) + "] }\n" +
                            repeat("Transform { translation 1 0 0 children USE G }\n", 4000);
  draw(world);
  mapper_.reset();
  world_.reset();
  const uint64_t before = heap();
  const MapStats stats = draw(world);
  EXPECT_EQ(messages(*world_), "");
  EXPECT_GT(stats.instances, 4000u);
  rtPerspective(45);
  rtFrameBuffer(4, 4, RT_RGBA);
  rtRender();
  EXPECT_LT(heap() - before, budgetOf(*world_)->used());
}

TEST_F(MapBudget, InstancesOfInstances) {
  std::string text = "DEF L0 ORTInstance { children Shape { geometry " + grid(5) + " } }\n";
  for (int i = 1; i <= 18; ++i) {
    const std::string below = "USE L" + std::to_string(i - 1);
    text += "DEF L" + std::to_string(i) +
            " ORTInstance { children [ Transform { translation 1 0 0 children " + below +
            " } Transform { children " + below + " } ] }\n";
  }
  draw(text, 100'000'000); // 2^18 instances take more
  expectRefused("from here on are left out");
}

TEST_F(MapBudget, ComesBackWhatIsNotDrawnAnyMore) {
  load("DEF G Group { children [ " + repeat("Shape { geometry Box { } }\n", 100) +
       "PointLight { } ] }\nDEF S Shape { }");
  const uint64_t full = budgetOf(*world_)->used();
  send("G", "children", MFNode());
  frame();
  const uint64_t empty = budgetOf(*world_)->used();
  EXPECT_LT(empty + 100 * 1000, full);
  for (int i = 0; i < 3; ++i) {
    const NodeRef shape = make("Shape { geometry Box { } }");
    send("G", "addChildren", MFNode{shape});
    frame();
    EXPECT_GT(budgetOf(*world_)->used(), empty);
    send("G", "removeChildren", MFNode{shape});
    frame();
    EXPECT_EQ(budgetOf(*world_)->used(), empty) << i;
  }
}

// A picture that is too large is left out, and the one before it is not shown instead of it.
TEST_F(MapBudget, APictureThatChanges) {
  load("Shape { appearance Appearance { texture DEF P PixelTexture { image 1 1 3 0xFF0000 } } "
       "geometry "
       "Box { } }");
  const auto image = [](int size) {
    return Image{size, size, 1, std::vector<uint8_t>(size_t(size) * size_t(size), 9)};
  };
  Share others(budgetOf(*world_));
  ASSERT_TRUE(others.take(budgetOf(*world_)->limit() - budgetOf(*world_)->used() - 5'000'000));
  EXPECT_EQ(mapper_->stats().textures, 1u);
  send("P", "set_image", image(3000));
  frame();
  EXPECT_EQ(mapper_->stats().textures, 0u);
  EXPECT_EQ(count(messages(*world_), "PixelTexture: no picture: together with"), 1u);
  const uint64_t without = budgetOf(*world_)->used();
  send("P", "set_image", image(100));
  frame();
  EXPECT_EQ(mapper_->stats().textures, 1u);
  EXPECT_EQ(budgetOf(*world_)->used(), without + 10'000);
}

TEST_F(MapBudget, PicturesInAll) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("map_budget_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::string text = "#VRML V2.0 utf8\n";
  for (int i = 0; i < 5; ++i) { // 48 x 48 pixels
    const std::string name = "p" + std::to_string(i) + ".png";
    std::filesystem::copy_file("apps/vv/desktop/icon-48.png", folder / name,
                               std::filesystem::copy_options::overwrite_existing);
    text += "Shape { appearance Appearance { texture ImageTexture { url \"" + name +
            "\" } } geometry Box { } }\n";
  }
  std::ofstream(folder / "world.wrl") << text;
  const auto textures = [&](uint64_t imagePixels) {
    LoadOptions options;
    options.limits.imagePixels = imagePixels;
    mapper_.reset();
    world_ = loadWorld((folder / "world.wrl").string(), options);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    mapper_->map(mapper_->viewpointCamera(0));
    return mapper_->stats().textures;
  };
  EXPECT_EQ(textures(1 << 20), 5u);
  EXPECT_EQ(messages(*world_), "");
  const uint64_t few = textures(2 * 48 * 48); // two or three of them, by their components
  EXPECT_GE(few, 2u);
  EXPECT_LT(few, 5u);
  EXPECT_NE(messages(*world_).find("all pictures of a world together"), std::string::npos)
      << messages(*world_);
  mapper_.reset();
  std::filesystem::remove_all(folder);
}

TEST_F(MapBudget, WhatIsTooFarIsTold) {
  draw("Transform { scale 1e10 1e10 1e10 children Transform { scale 1e30 1e30 1e30 children Shape "
       "{ geometry Box { } } } }\n"
       "Shape { geometry Sphere { } }");
  EXPECT_EQ(count(messages(*world_), "larger than 1e38"), 1u) << messages(*world_);
  EXPECT_EQ(world_->diagnostics.warnings(), 1u);
  // Through an instance: neither of the two matrices alone is beyond.
  draw("Transform { scale 1e30 1e30 1e30 children ORTInstance { children Transform { scale 1e30 "
       "1e30 1e30 children Shape { geometry " +
       grid(3) + " } } } }");
  EXPECT_GE(count(messages(*world_), "larger than 1e38"), 1u) << messages(*world_);
  // Far, but within what floats can hold.
  draw("Transform { translation 1e37 0 0 children Shape { geometry Box { } } }");
  EXPECT_EQ(count(messages(*world_), "beyond 1e20"), 1u) << messages(*world_);
  draw("Transform { translation 9e19 0 0 children Shape { geometry Box { } } }");
  EXPECT_EQ(messages(*world_), "");
  // By its own coordinates. Each node is told of once, by itself or as the geometry of two shapes.
  const std::string large =
      "IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1e21 0 0, 0 1e21 0, "
      "1e21 1e21 0, 0 2e21 0, 1e21 2e21 0, 0 3e21 0 ] } coordIndex [ 0 1 2 -1 "
      "1 2 3 -1 2 3 4 -1 3 4 5 -1 4 5 6 -1 ] }";
  draw("Group { children Shape { geometry " + large + " } }");
  EXPECT_EQ(count(messages(*world_), "beyond 1e20"), 1u) << messages(*world_);
  EXPECT_EQ(world_->diagnostics.warnings(), 1u) << messages(*world_);
  draw("Shape { geometry DEF G " + large +
       " } Transform { translation 1 0 0 children Shape { geometry USE G } }");
  EXPECT_GE(count(messages(*world_), "beyond 1e20"), 1u) << messages(*world_);
  EXPECT_LE(world_->diagnostics.warnings(), 2u) << messages(*world_);
}

TEST_F(MapBudget, ACameraThatIsTooFarIsTold) {
  draw("Viewpoint { position 0 0 2e17 } Shape { geometry Sphere { radius 1e17 } }");
  EXPECT_EQ(count(messages(*world_), "the camera stands farther than 1e17"), 1u)
      << messages(*world_);
  mapper_->map(mapper_->viewpointCamera(0));
  EXPECT_EQ(world_->diagnostics.warnings(), 1u);
  draw("Viewpoint { position 0 0 9e16 } Shape { geometry Sphere { radius 1e16 } }");
  EXPECT_EQ(messages(*world_), "");
}

TEST_F(MapBudget, AGridWithoutHeightsIsTold) {
  draw("Shape { geometry ElevationGrid { xDimension 20000 zDimension 20000 } }");
  EXPECT_NE(messages(*world_).find("height has 0 values where xDimension and zDimension ask for "
                                   "400000000; nothing is drawn"),
            std::string::npos)
      << messages(*world_);
  draw("Shape { geometry ElevationGrid { } }"); // nothing is asked for
  EXPECT_EQ(messages(*world_), "");
}

} // namespace
} // namespace xvrml::test
