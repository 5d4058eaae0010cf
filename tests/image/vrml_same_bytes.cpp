// vrml_same_bytes.cpp: pictures have the same bytes with one thread, with two threads and from a
// replayed recording.
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "image/vrml_scene.h"

using namespace xvrml::test;

namespace {

// Returns a world with a bit of everything: lights of all kinds with shadows, transparency,
// textures, instances, lines, sky and fog.
std::string everything() {
  std::string body =
      "Viewpoint { position 0 3 12 orientation 1 0 0 -0.2 }\n"
      "Background { skyColor [ 0.1 0.2 0.8, 0.8 0.8 1 ] skyAngle 1.6 groundColor [ 0.2 0.1 0, 0.4 "
      "0.3 0.1 ] groundAngle 1.5 }\n"
      "Fog { visibilityRange 60 color 0.8 0.8 0.9 }\n"
      "PointLight { location 3 5 4 attenuation 0.5 0.1 0 }\nSpotLight { location -4 6 3 direction "
      "0.5 -1 -0.4 beamWidth 0.2 cutOffAngle 0.7 }\n"
      "Shape { appearance Appearance { material Material { specularColor 1 1 1 } texture "
      "PixelTexture { image 2 2 3 0xFF8040 0x20A0F0 0x808000 0xC0C0C0 } textureTransform "
      "TextureTransform { scale 8 8 } } geometry Box { size 14 0.2 14 } }\n"
      "DEF Ball Transform { translation 0 1.2 0 children [ DirectionalLight { direction -1 -1 -1 "
      "intensity 0.4 } Shape { appearance Appearance { material Material { diffuseColor 0.2 0.8 "
      "0.3 transparency 0.4 specularColor 1 1 1 shininess 0.8 } } geometry Sphere { } } ] }\n"
      "Shape { appearance Appearance { material Material { emissiveColor 1 1 0 } } geometry "
      "IndexedLineSet { coord Coordinate { point [ -5 0.2 3, 5 4 -2, 0 1 5 ] } coordIndex [ 0 1 2 "
      "-1 ] } }\nDEF Cones Group { children [\n";
  for (int i = 0; i < 12; ++i)
    body += "Transform { translation " + std::to_string(i - 6) + " 1 " +
            std::to_string(-(i * i) % 5) +
            " children Shape { appearance Appearance { material Material { diffuseColor 0." +
            std::to_string(i % 9 + 1) +
            " 0.5 0.7 } } geometry Cone { height 1.5 bottomRadius 0.4 } } }\n";
  return body + "] }\nTransform { translation 0 1 -4 scale 1.5 1.5 1.5 children USE Cones "
                "}\nTransform { translation 3 0 0 children USE Ball }\n";
}

SceneOptions picture(const std::string& config) {
  SceneOptions options;
  options.config = config;
  options.width = 96;
  options.height = 72;
  options.samples = 4;
  return options;
}

std::vector<Pixel> rendered(const std::string& config) {
  Scene scene(everything(), picture(config));
  std::vector<Pixel> pixels = scene.render();
  scene.expectNoMessages();
  return pixels;
}

bool equal(const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)) == 0;
}

TEST(VrmlSameBytes, ForAnyNumberOfThreads) {
  const std::vector<Pixel> one = rendered("threads=1");
  double sum = 0;
  for (const Pixel& p : one) sum += p.r + p.g + p.b;
  EXPECT_GT(sum / double(one.size()), 0.3) << "there is something to compare";
  EXPECT_TRUE(equal(one, rendered("threads=2")));
  EXPECT_TRUE(equal(one, rendered("threads=5")));
}

// Returns the colours of a PFM file, first row at the top.
std::vector<float> readPfm(const std::filesystem::path& path, size_t width, size_t height) {
  std::ifstream file(path, std::ios::binary);
  std::string magic, w, h, scale;
  file >> magic >> w >> h >> scale;
  file.get();
  EXPECT_EQ(magic + w + h, "PF" + std::to_string(width) + std::to_string(height));
  std::vector<float> rows(3 * width * height), picture;
  file.read(reinterpret_cast<char*>(rows.data()), std::streamsize(rows.size() * sizeof(float)));
  EXPECT_TRUE(file.good());
  for (size_t y = height; y-- > 0;)
    picture.insert(picture.end(), &rows[3 * width * y], &rows[3 * width * y] + 3 * width);
  return picture;
}

TEST(VrmlSameBytes, ForARecordingReplayed) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "vrml_replay";
  std::filesystem::create_directories(folder);
  const std::string recording = (folder / "everything.orec").string(),
                    output = (folder / "replayed.pfm").string();
  const std::vector<Pixel> drawn = rendered("threads=1 record=\"" + recording + "\"");
  const std::string command =
      std::string(OPENRT_REPLAY) + " '" + recording + "' -o '" + output + "' --threads 2";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const std::vector<float> replayed = readPfm(output, 96, 72);
  ASSERT_EQ(replayed.size(), 3 * drawn.size());
  size_t different = 0;
  for (size_t i = 0; i < drawn.size(); ++i)
    different += std::memcmp(&drawn[i].r, &replayed[3 * i], 3 * sizeof(float)) != 0;
  EXPECT_EQ(different, 0u);
  std::filesystem::remove_all(folder);
}

TEST(VrmlSameBytes, ForASecondCameraAndBack) {
  Scene scene(everything(), picture("threads=2"));
  const std::vector<Pixel> first = scene.render();
  EXPECT_FALSE(equal(first, scene.render(Scene::at(1, 2, 9, 0.9))));
  EXPECT_TRUE(equal(first, scene.render()));
}

} // namespace
