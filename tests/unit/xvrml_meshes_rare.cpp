// xvrml_meshes_rare.cpp: meshes and X3D that are legal but rare, and files that would make a reader
// do far more work than they have bytes. The values follow from the formats' own documents.
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::string messages(const World& world) {
  std::string text;
  for (const Diagnostic& one : world.diagnostics.list()) text += one.text() + '\n';
  return text;
}

bool holds(const World& world, const std::string& text) {
  return writeWorld(world).find(text) != std::string::npos;
}

std::string gltf(const std::string& members) {
  return R"({"asset":{"version":"2.0"},)" + members + "}";
}

// Returns a list of elements that a function writes.
template <class Function> std::string listOf(int count, Function element) {
  std::string text;
  for (int i = 0; i < count; ++i) text += (i ? "," : "") + std::string(element(i));
  return "[" + text + "]";
}

std::string fileWith(const std::string& name, const std::string& text) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "xvrml_meshes_rare";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name) << text;
  return (folder / name).string();
}

const std::string triangleObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

TEST(RareMeshes, PlyFacesMayStandBeforeTheirVertices) {
  const auto world = loadWorldFromMemory("ply\nformat ascii 1.0\nelement face 2\n"
                                         "property list uchar int vertex_indices\n"
                                         "element vertex 3\nproperty float x\nproperty float y\n"
                                         "property float z\nend_header\n3 0 1 2\n3 0 1 3\n"
                                         "0 0 0 1 0 0 0 1 0\n",
                                         "a.ply");
  EXPECT_TRUE(holds(*world, "coordIndex [ 0 1 2 -1 ]")) << writeWorld(*world);
  EXPECT_NE(messages(*world).find("1 faces or edges name a vertex"), std::string::npos);
}

TEST(RareMeshes, KeywordsOfStlInAnyCase) {
  const auto world = loadWorldFromMemory("Solid x\nFacet Normal 0 0 1\nOuter Loop\nVertex 0 0 0\n"
                                         "Vertex 1 0 0\nVertex 0 1 0\nEndLoop\nEndFacet\n"
                                         "EndSolid x\n",
                                         "a.stl");
  EXPECT_EQ(messages(*world), "");
  EXPECT_TRUE(holds(*world, "IndexedFaceSet"));
}

TEST(RareMeshes, MtlScalesBeforeItMoves) {
  fileWith("move.mtl", "newmtl a\nmap_Kd -s 2 4 1 -o 0.5 1 0 p.png\n");
  const auto world = loadWorld(fileWith("move.obj", "mtllib move.mtl\n" + triangleObj));
  EXPECT_TRUE(holds(*world, "scale 2 4")) << writeWorld(*world);
  EXPECT_TRUE(holds(*world, "translation 0.25 0.25")) << writeWorld(*world);
}

TEST(RareMeshes, NamesOfFilesInObjAreNoUrls) {
  fileWith("a#1.mtl", "newmtl a\nKd 0.5 0 0\nmap_Kd p#1.png\n");
  const auto world = loadWorld(fileWith("names.obj", "mtllib a#1.mtl\n" + triangleObj));
  EXPECT_EQ(messages(*world), "");
  EXPECT_TRUE(holds(*world, "diffuseColor 0.5 0 0")) << writeWorld(*world);
  EXPECT_TRUE(holds(*world, "p%231.png")) << writeWorld(*world);
}

TEST(RareMeshes, ObjCornersNeedTheirVertexAlone) {
  const std::string points = "v -2 -2 0 # first\nv 2 -2 0 #second\nv 2 2 0\nv -2 2 0\nvt 0 0\n";
  const auto faces = [&](const std::string& rest) {
    const auto world = loadWorldFromMemory(points + rest, "a.obj");
    return messages(*world) + writeWorld(*world);
  };
  for (const char* good : {"f 1 2 3 # lower\n", "f 1 2 3#lower\n", "f 1// 2// 3//\n", "F 1 2 3\n",
                           "f 1/1/ 2/1/ 3/1/\n", "f 1 2\\\n 3\n", "f\\\r\n 1 2 \\\r\n3",
                           "fo 1/ 2/ 3/", "f 1/1 2 3/1 # mixed\n"}) {
    const std::string text = faces(good);
    EXPECT_NE(text.find("coordIndex [ 0 1 2 -1 ]"), std::string::npos) << good << text;
    EXPECT_EQ(text.find("warning"), std::string::npos) << good << text;
    EXPECT_EQ(text.find("error"), std::string::npos) << good << text;
  }
  for (const char* named : {"f 1/7 2/-9 3/0\n", "f 1/1/1 2/1/2 3/1/3\n", "f 1//x 2//y 3//z\n",
                            "f 1.0 2.0 3.0\n", "f 1/1/1/1 2/1 3/1\n"}) {
    const std::string text = faces(named);
    EXPECT_NE(text.find("coordIndex [ 0 1 2 -1 ]"), std::string::npos) << named << text;
    EXPECT_NE(text.find("1 faces or lines have corners"), std::string::npos) << named << text;
  }
  EXPECT_NE(faces("f 1 2 5\nf 1 2\nf a b c\n").find("3 faces, lines or points are left out"),
            std::string::npos);
}

TEST(RareMeshes, MtlOfOtherPrograms) {
  fileWith("other.mtl", "NEWMTL a # comment\nKD 0.5 0 0\nD 1\nTR 1\n"
                        "newmtl b\nTr 1\nKd 0 0.5 0\nnewmtl c\nTr 0.25\nnewmtl d\nTr 0.5\nd 0.75\n"
                        "newmtl e # 2\nd 0\n");
  const auto load = [](const std::string& name) {
    const auto world =
        loadWorld(fileWith("other.obj", "mtllib other.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl " +
                                            name + "\nf 1 2 3\n"));
    return writeWorld(*world) + messages(*world);
  };
  EXPECT_EQ(load("b").find("transparency"), std::string::npos) << load("b");
  EXPECT_NE(load("b").find("1 statements Tr 1 without a d: taken as opaque"), std::string::npos);
  EXPECT_NE(load("c").find("transparency 0.25"), std::string::npos) << load("c");
  EXPECT_NE(load("d").find("transparency 0.25"), std::string::npos) << load("d");
  EXPECT_NE(load("a # comment").find("diffuseColor 0.5 0 0"), std::string::npos);
  EXPECT_NE(load("b # comment").find("diffuseColor 0 0.5 0"), std::string::npos);
  EXPECT_NE(load("e # 2").find("transparency 1"), std::string::npos);
}

TEST(RareMeshes, StlTextWithLinesOfItsOwn) {
  const std::string facet = "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n"
                            " vertex 0 1 0\n end loop\nend facet\n";
  const auto world = loadWorldFromMemory(
      "solid a\ncolor 0.5 0.5 1\n" + facet + "x y\n" + facet + "end solid a\n", "a.stl");
  EXPECT_TRUE(holds(*world, "coordIndex [ 0 1 2 -1 0 1 2 -1 ]")) << writeWorld(*world);
  EXPECT_NE(messages(*world).find("2 lines are left out"), std::string::npos) << messages(*world);
  // A text of another format is not taken for STL, and a binary file that begins so is none.
  EXPECT_THROW(loadWorldFromMemory("solid ground\nand no facets\n", "a.wrl"), LoadError);
  std::string binary = "solid ";
  binary.resize(80, ' ');
  binary += std::string("\x01\0\0\0", 4) + std::string(50, '\0') + "tail";
  EXPECT_EQ(messages(*loadWorldFromMemory(binary, "a.stl")).find("lines"), std::string::npos);
}

TEST(RareMeshes, ABackslashContinuesEveryStatementOfObj) {
  fileWith("two lines.mtl", "newmtl red\nKd 0.5 0 0\n");
  for (const char* const end : {"\n", "\r\n"}) {
    std::string text =
        "mtllib \\\n two \\\nlines.mtl\nv 0 0 0\nv 1 \\\n 0 0\nv 0 1 0\ng \\\nplate\n"
        "# not here \\\nusemtl \\\n red\ncurv 0 \\\n 1 2\nf 1 \\\n 2 3 \\";
    for (size_t at = 0; (at = text.find('\n', at)) != text.npos; at += std::strlen(end))
      text.replace(at, 1, end);
    const auto world = loadWorld(fileWith("continued.obj", text));
    const std::string said = messages(*world);
    EXPECT_NE(said.find("1 statements of free-form"), std::string::npos) << said;
    EXPECT_EQ(world->diagnostics.warnings() + world->diagnostics.errors(), 1u) << said;
    EXPECT_TRUE(holds(*world, "diffuseColor 0.5 0 0")) << writeWorld(*world);
    EXPECT_TRUE(holds(*world, "DEF plate Shape")) << writeWorld(*world);
    EXPECT_TRUE(holds(*world, "coordIndex [ 0 1 2 -1 ]")) << writeWorld(*world);
  }
  // A library that is not there is reported in the line of its statement.
  const auto lost = loadWorld(fileWith("lost.obj", "# a\nmtllib \\\nno.mtl\n" + triangleObj));
  EXPECT_NE(messages(*lost).find("lost.obj:2:"), std::string::npos) << messages(*lost);
  EXPECT_NE(messages(*lost).find("no.mtl"), std::string::npos) << messages(*lost);
}

TEST(RareMeshes, StlTextMayStandInOneLine) {
  const std::string facet = " facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0"
                            " endloop endfacet";
  const std::string bad = " facet normal 0 0 1 outer loop vertex nan 0 0 vertex 1 0 0 vertex 0 1 0"
                          " endloop endfacet";
  for (const std::string& text :
       {"solid a facet\n" + facet + facet + " endsolid a facet\n",
        "solid a facet" + facet + facet + " endsolid a facet",
        "solid one solid" + facet + facet + " endsolid one solid solid two endsolid two\n",
        "SOLID\n FACET" + facet.substr(19) + facet + " END SOLID"}) {
    const auto world = loadWorldFromMemory(text, "a.stl");
    EXPECT_EQ(messages(*world), "") << text;
    EXPECT_TRUE(holds(*world, "coordIndex [ 0 1 2 -1 0 1 2 -1 ]")) << text << writeWorld(*world);
    // The content decides, too.
    EXPECT_TRUE(holds(*loadWorldFromMemory(text, "a"), "IndexedFaceSet")) << text;
  }
  const auto two = loadWorldFromMemory(
      "solid a" + facet + " endsolid a solid b" + facet + bad + " endsolid b", "a.stl");
  EXPECT_TRUE(holds(*two, "DEF a Shape") && holds(*two, "DEF b Shape")) << writeWorld(*two);
  EXPECT_NE(messages(*two).find("1 facets are left out"), std::string::npos) << messages(*two);
  EXPECT_EQ(messages(*two).find("lines are left out"), std::string::npos) << messages(*two);
}

TEST(RareMeshes, BytesBehindABinaryGltfFileAreLeftOut) {
  std::string json =
      gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"camera":0}],"cameras":[{"type":"perspective",)"
           R"("perspective":{"yfov":1,"znear":0.1}}])");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += char(value >> 8 * i & 255);
    return bytes;
  };
  const auto glb = [&](size_t length) {
    return "glTF" + word(2) + word(length) + word(json.size()) + "JSON" + json;
  };
  const size_t whole = 20 + json.size();
  EXPECT_EQ(messages(*loadWorldFromMemory(glb(whole), "a.glb")), "");
  for (const char* const rest : {"x", "trailing", "trailing bytes of another file"}) {
    const auto world = loadWorldFromMemory(glb(whole) + rest, "a.glb");
    EXPECT_TRUE(holds(*world, "Viewpoint")) << messages(*world);
    EXPECT_NE(messages(*world).find(std::to_string(std::strlen(rest)) +
                                    " bytes behind the binary glTF file are left out"),
              std::string::npos)
        << messages(*world);
    EXPECT_EQ(messages(*world).find("error"), std::string::npos) << messages(*world);
  }
  // A length that stops within the file's chunks, or that is none, loses nothing.
  for (const size_t length : {size_t(0), size_t(13), whole - 4})
    EXPECT_TRUE(holds(*loadWorldFromMemory(glb(length), "a.glb"), "Viewpoint")) << length;
}

TEST(RareMeshes, PlyHeadersOfOtherPrograms) {
  const std::string data = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string head = "ply\nformat ascii 1.0\nmade by x\nelement vertex 3\nproperty float x\n"
                           "property float y\nproperty float z\nelement face 1\n"
                           "property list uchar int vertex_indices\nend_header\n";
  const auto unknown = loadWorldFromMemory(head + data, "a.ply");
  EXPECT_TRUE(holds(*unknown, "coordIndex [ 0 1 2 -1 ]")) << writeWorld(*unknown);
  EXPECT_NE(messages(*unknown).find("1 lines of the PLY header are passed over"),
            std::string::npos);
  std::string plain = head;
  plain.erase(plain.find("made by x\n"), 10);
  const auto marked = loadWorldFromMemory(plain + "\xef\xbb\xbf" + data, "a.ply");
  EXPECT_EQ(messages(*marked), "");
  EXPECT_TRUE(holds(*marked, "coordIndex [ 0 1 2 -1 ]")) << writeWorld(*marked);
  // The first byte of the data is that of a line end, but lines end with CR here.
  for (char& c : plain)
    if (c == '\n') c = '\r';
  plain.replace(plain.find("ascii"), 5, "binary_little_endian");
  const float numbers[9] = {0.53926146f, 0, 0, 1, 0, 0, 0, 1, 0}; // 0x3f0a0d0a
  std::string bytes(reinterpret_cast<const char*>(numbers), sizeof numbers);
  ASSERT_EQ(bytes[0], '\n');
  bytes += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  const auto binary = loadWorldFromMemory(plain + bytes, "a.ply");
  EXPECT_EQ(messages(*binary), "");
  EXPECT_TRUE(holds(*binary, "coordIndex [ 0 1 2 -1 ]")) << writeWorld(*binary);
}

TEST(RareMeshes, AMaterialLibraryIsReadOnce) {
  const auto world = loadWorld(
      fileWith("twice.obj", "mtllib none.mtl\nmtllib none.mtl\nmtllib none.mtl\n" + triangleObj));
  const std::string text = messages(*world);
  const size_t first = text.find("materials are not read");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("materials are not read", first + 1), std::string::npos) << text;
}

TEST(RareMeshes, LongListsOfGltfTakeLinearTime) {
  constexpr int count = 300'000; // nodes, each within the one before
  const std::string nodes = listOf(count, [](int i) {
    return i + 1 < count ? R"({"children":[)" + std::to_string(i + 1) + "]}" : std::string("{}");
  });
  const auto start = std::chrono::steady_clock::now();
  const auto world =
      loadWorldFromMemory(gltf(R"("scenes":[{"nodes":[0]}],"nodes":)" + nodes), "a.gltf");
  EXPECT_NE(messages(*world).find("limit nesting"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(RareMeshes, NodesOfGltfThatHoldThemselvesAreRefused) {
  const auto world = loadWorldFromMemory(
      gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[2]},)"
           R"({"children":[0,1,2]}])"),
      "a.gltf");
  const std::string text = messages(*world);
  for (const char* node : {"node 0 has", "node 1 has", "node 2 has"})
    EXPECT_NE(text.find(node), std::string::npos) << text;
}

TEST(RareMeshes, ArraysThatAreUsedManyTimesAreBounded) {
  LoadOptions options;
  options.limits.arrayElements = 100'000;
  const std::string primitives =
      listOf(100, [](int) { return R"({"attributes":{"POSITION":0},"mode":0})"; });
  const std::string text =
      gltf(R"("accessors":[{"componentType":5126,"type":"VEC3","count":30000}],)"
           R"("nodes":[{"mesh":0}],"meshes":[{"primitives":)" +
           primitives + "}]");
  const auto world = loadWorldFromMemory(text, "a.gltf", options);
  EXPECT_NE(messages(*world).find("100 times the bytes of the file"), std::string::npos)
      << messages(*world);
}

TEST(RareMeshes, XmlInWindows1252) {
  const auto world =
      loadWorldFromMemory("<?xml version=\"1.0\" encoding=\"windows-1252\"?><X3D version=\"3.3\">"
                          "<Scene><WorldInfo title=\"\x93\xe9\x80\x94\"/></Scene></X3D>",
                          "a.x3d");
  EXPECT_EQ(messages(*world), "");
  EXPECT_TRUE(holds(*world, "\u201c\u00e9\u20ac\u201d")) << writeWorld(*world);
}

TEST(RareMeshes, EntitiesInOtherFilesAreReported) {
  const auto world =
      loadWorldFromMemory("<!DOCTYPE X3D [<!ENTITY e SYSTEM \"other.xml\">]><X3D version=\"3.3\">"
                          "<Scene>&e;<Group DEF=\"g\"/></Scene></X3D>",
                          "a.x3d");
  EXPECT_NE(messages(*world).find("an entity in the file 'other.xml' is left out"),
            std::string::npos)
      << messages(*world);
  EXPECT_TRUE(holds(*world, "DEF g Group"));
}

// A triangle of zeros with a material.
std::string withMaterial(const std::string& material) {
  return gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
      "buffers":[{"byteLength":36,"uri":"data:;base64,)" +
              std::string(48, 'A') + R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],
      "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
      "images":[{"uri":"a.png"}],"textures":[{"source":0}],"materials":[)" +
              material + "]");
}

// Without a reflection at its boundary a surface is a Material without highlights.
TEST(RareMeshes, GltfMattSurfaces) {
  const std::string head = R"({"pbrMetallicRoughness":{"metallicFactor":0,
      "baseColorTexture":{"index":0}},"extensions":{)";
  for (const char* matt : {R"("KHR_materials_specular":{"specularFactor":0})",
                           R"("KHR_materials_specular":{"specularColorFactor":[0,0,0]})",
                           R"("KHR_materials_ior":{"ior":1})"}) {
    const auto world = loadWorldFromMemory(withMaterial(head + matt + "}}"), "a.gltf");
    EXPECT_TRUE(holds(*world, "material Material {")) << matt << writeWorld(*world);
    EXPECT_TRUE(holds(*world, "diffuseTexture")) << matt;
    EXPECT_EQ(messages(*world).find("KHR_"), std::string::npos) << messages(*world);
  }
  for (const char* shiny : {R"("KHR_materials_specular":{"specularFactor":0.5})",
                            R"("KHR_materials_specular":{"specularColorFactor":[0,0,1]})",
                            R"("KHR_materials_specular":{"specularFactor":null})",
                            R"("KHR_materials_ior":{"ior":0})"}) {
    const auto world = loadWorldFromMemory(withMaterial(head + shiny + "}}"), "a.gltf");
    EXPECT_TRUE(holds(*world, "material PhysicalMaterial {")) << shiny << writeWorld(*world);
    EXPECT_NE(messages(*world).find("KHR_"), std::string::npos) << shiny;
  }
  // A metal reflects by its own colour.
  const auto metal = loadWorldFromMemory(
      withMaterial(R"({"extensions":{"KHR_materials_specular":{"specularFactor":0}}})"), "a.gltf");
  EXPECT_TRUE(holds(*metal, "material PhysicalMaterial {")) << writeWorld(*metal);
}

TEST(RareMeshes, GltfClearBodies) {
  const auto read = [](const std::string& roughness, const std::string& volume) {
    return loadWorldFromMemory(
        withMaterial(R"({"pbrMetallicRoughness":{"roughnessFactor":)" + roughness +
                     R"(},"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},
        "KHR_materials_ior":{"ior":1.25},"KHR_materials_dispersion":{"dispersion":0.5},
        "KHR_materials_volume":{)" +
                     volume + "}}}"),
        "a.gltf");
  };
  const auto glass =
      read("0", R"("thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[1,0.5,0])");
  EXPECT_TRUE(holds(*glass, "name \"Glass\"")) << writeWorld(*glass);
  EXPECT_TRUE(holds(*glass, "\"1f index 1.25\"")) << writeWorld(*glass);
  EXPECT_TRUE(holds(*glass, "\"1f abbe 40\"")) << writeWorld(*glass);
  EXPECT_TRUE(holds(*glass, "absorption 0 0.3465")) << writeWorld(*glass); // ln 2 / 2
  EXPECT_EQ(messages(*glass).find("KHR_"), std::string::npos) << messages(*glass);
  const auto ground = read("0.5", R"("thicknessFactor":1,"attenuationDistance":0)");
  EXPECT_TRUE(holds(*ground, "name \"RoughGlass\"")) << writeWorld(*ground);
  EXPECT_TRUE(holds(*ground, "\"1f roughness 0.25\"")) << writeWorld(*ground);
  // A wall without thickness does not refract: it stays opaque, with a message.
  const auto wall = read("0", R"("thicknessFactor":0)");
  EXPECT_TRUE(holds(*wall, "material PhysicalMaterial {")) << writeWorld(*wall);
  EXPECT_NE(messages(*wall).find("KHR_materials_transmission"), std::string::npos);
}

} // namespace
