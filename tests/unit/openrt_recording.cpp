// openrt_recording.cpp: recordings are read back as written, and any other content of a file is
// refused with the position of the fault. The faults are put into a good recording, whose checksums
// are then corrected where they would hide the fault. Longer than 500 lines because the tests share
// one format of edits.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>

#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

#include "backend/record/format.h"
#include "backend/record/reader.h"
#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;
namespace fs = std::filesystem;
using Bytes = std::vector<uint8_t>;

std::unique_ptr<RecordingReader>
readerOf(const Bytes& bytes, const ShaderRegistry* shaders = nullptr, RecordingLimits limits = {}) {
  std::FILE* file = std::tmpfile();
  if (!bytes.empty()) std::fwrite(bytes.data(), 1, bytes.size(), file);
  std::rewind(file);
  return std::make_unique<RecordingReader>(file, "recording", shaders, limits);
}

// Returns the message with which a recording is refused; empty if it is accepted.
std::string refusal(const Bytes& bytes, const ShaderRegistry* shaders = nullptr,
                    RecordingLimits limits = {}) {
  try {
    const auto reader = readerOf(bytes, shaders, limits);
    while (reader->next()) {}
  } catch (const BadRecording& e) { return e.what(); }
  return {};
}

void append(Bytes& bytes, const void* data, size_t size) {
  const auto* p = static_cast<const uint8_t*>(data);
  bytes.insert(bytes.end(), p, p + size);
}

Bytes header() {
  recording::FileHeader h{};
  std::memcpy(h.magic, recording::magic, sizeof(h.magic));
  h.version = recording::version;
  Bytes bytes;
  append(bytes, &h, sizeof(h));
  return bytes;
}

void appendArray(Bytes& bytes, uint64_t id, const void* data, size_t size) {
  Bytes packed(ZSTD_compressBound(size));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), data, size, 1));
  const recording::ChunkHeader h{recording::ChunkKind::Array, 0, id, size, packed.size(),
                                 XXH3_64bits(data, size)};
  append(bytes, &h, sizeof(h));
  append(bytes, packed.data(), packed.size());
}

void appendEdits(Bytes& bytes, const edit::EditsT& edits) {
  flatbuffers::FlatBufferBuilder builder;
  edit::FinishEditsBuffer(builder, edit::Edits::Pack(builder, &edits));
  const recording::ChunkHeader h{recording::ChunkKind::Edits,
                                 0,
                                 0,
                                 builder.GetSize(),
                                 builder.GetSize(),
                                 XXH3_64bits(builder.GetBufferPointer(), builder.GetSize())};
  append(bytes, &h, sizeof(h));
  append(bytes, builder.GetBufferPointer(), builder.GetSize());
}

std::unique_ptr<edit::Matrix> identity() {
  const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return std::make_unique<edit::Matrix>(flatbuffers::span<const double, 16>(m));
}

template <class T> T& add(edit::EditsT& edits, T edit) {
  edits.edits.push_back(std::make_unique<edit::EditT>());
  edits.edits.back()->any.Set(std::move(edit));
  return *static_cast<T*>(edits.edits.back()->any.value);
}

// One triangle in an object, an instance of it, a texture, a light, a frame.
struct Example {
  float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  uint32_t indices[3] = {0, 1, 2};
  uint8_t texels[4] = {1, 2, 3, 4};
  std::optional<std::vector<float>> extra; // array 4
  edit::EditsT edits;
  edit::TextureT& texture;
  edit::ShaderClassT& surfaceClass;
  edit::ShaderT& surface;
  edit::ParameterT& parameter;
  edit::ObjectT& object;
  edit::GeometryT& geometry;
  edit::InstanceT& instance;
  edit::FrameSettingsT& frame;

  Example()
      : texture(add(edits, edit::TextureT())), surfaceClass(add(edits, edit::ShaderClassT())),
        surface(add(edits, edit::ShaderT())), parameter(add(edits, edit::ParameterT())),
        object(add(edits, edit::ObjectT())), geometry(makeGeometry(object)),
        instance(add(edits, edit::InstanceT())), frame(add(edits, edit::FrameSettingsT())) {
    texture.id = 1;
    texture.components = 1;
    texture.width = texture.height = 2;
    texture.texels = 3;
    surfaceClass.id = 2;
    surfaceClass.name = "Everything";
    surfaceClass.library = "everything";
    surface.id = 3;
    surface.shaderClass = 2;
    parameter.shader = 3;
    parameter.index = 1;
    parameter.floats = {0.5f};
    object.id = 4;
    instance.id = 5;
    instance.object = 4;
    instance.matrix = identity();
    frame.width = frame.height = 4;
    frame.channels = RT_RGBA;
    frame.samples = 1;
    edits.render = true;
  }
  static edit::GeometryT& makeGeometry(edit::ObjectT& object) {
    auto g = std::make_unique<edit::GeometryT>();
    g->matrix = identity();
    g->points = 1;
    g->indices = 2;
    g->width = 1;
    g->shader = 3;
    object.geometries.push_back(std::move(g));
    return *object.geometries.back();
  }
  Bytes file() const {
    Bytes bytes = header();
    appendArray(bytes, 1, points, sizeof(points));
    appendArray(bytes, 2, indices, sizeof(indices));
    appendArray(bytes, 3, texels, sizeof(texels));
    if (extra) appendArray(bytes, 4, extra->data(), extra->size() * sizeof(float));
    appendEdits(bytes, edits);
    return bytes;
  }
};

class Recording : public testing::Test {
 protected:
  const ShaderRegistry shaders{{std::string(OPENRT_TEST_PLUGINS)}};
  // Returns the reader's message about the example after a change.
  std::string after(const std::function<void(Example&)>& change) {
    Example example;
    change(example);
    return refusal(example.file(), &shaders);
  }
};

TEST_F(Recording, AGoodOneIsRead) {
  EXPECT_EQ(refusal(Example().file(), &shaders), "");
  EXPECT_EQ(refusal(Example().file()), "");
  EXPECT_EQ(refusal(header()), "");
}

TEST_F(Recording, WhatTheApiWroteIsReadBackTheSame) {
  const std::string plugins = OPENRT_TEST_PLUGINS;
  const fs::path path =
      fs::temp_directory_path() / ("openrt recording " + std::to_string(::getpid()));
  const RTcontext context =
      rtNewContext(("backend=record file=\"" + path.string() + "\" shaderpath=" + plugins).c_str());
  ASSERT_NE(context, nullptr) << rtGetErrorMessage();
  std::vector<float> points(30000);
  for (size_t i = 0; i < points.size(); i++) points[i] = float((i * 7919) % 1000) / 7;
  rtBindShader(rtNewShader(rtNewShaderClass("Everything", "everything")));
  rtParameterString(rtParameterHandle("text"), "some text");
  const RTid object = rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  rtDrawArrays(RT_TRIANGLES, 0, points.size() / 3);
  rtEndObject();
  const RTid instance = rtInstantiateObject(object);
  rtFrameBuffer(8, 8, RT_RGBA | RT_DEPTH);
  rtRender();
  float pixels[256];
  rtReadPixels(RT_RGBA, pixels, 256); // nothing is rendered: zeros
  EXPECT_EQ(pixels[5], 0.0f);
  rtInstanceVisible(instance, 0);
  rtSwapBuffers();
  rtDeleteContext(context);
  EXPECT_RT_ERROR(RT_NO_ERROR);

  const auto reader = openRecording(path.string(), &shaders);
  const auto first = reader->next();
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->edits.render);
  EXPECT_EQ(edits<edit::ParameterT>(*first).at(0)->text, "some text");
  EXPECT_EQ(contents<float>(*first, edits<edit::ObjectT>(*first).at(0)->geometries.at(0)->points),
            points);
  const auto second = reader->next();
  ASSERT_TRUE(second);
  ASSERT_EQ(second->edits.edits.size(), 1u);
  EXPECT_FALSE(edits<edit::InstanceT>(*second).at(0)->visible);
  EXPECT_EQ(reader->next(), nullptr);
  fs::remove(path);
}

TEST_F(Recording, AFullDiskIsAnIoError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(rtNewContext("backend=record file=/dev/full"), nullptr);
  EXPECT_RT_ERROR(RT_IO_ERROR);
}

TEST_F(Recording, EveryTruncationIsNoticed) {
  const Bytes whole = Example().file();
  for (size_t size = 0; size < whole.size(); size++) {
    if (size == sizeof(recording::FileHeader)) continue; // a recording without frames
    const std::string text =
        refusal(Bytes(whole.begin(), whole.begin() + ptrdiff_t(size)), &shaders);
    EXPECT_NE(text.find("the file ends in the middle"), text.npos) << size << ": " << text;
  }
}

// zstd frames have bits without meaning. A change that is not refused must at least be read as it
// was written.
TEST_F(Recording, NoFlippedBitChangesWhatIsRead) {
  const Example example;
  const Bytes whole = example.file();
  int harmless = 0;
  for (size_t i = 0; i < 8 * whole.size(); i++) {
    Bytes damaged = whole;
    damaged[i / 8] ^= uint8_t(1u << (i % 8));
    if (const std::string text = refusal(damaged, &shaders); !text.empty()) continue;
    harmless++;
    const auto commit = readerOf(damaged, &shaders)->next();
    EXPECT_EQ(contents<float>(*commit, 1), std::vector<float>(example.points, example.points + 9))
        << "bit " << i;
    EXPECT_EQ(contents<uint32_t>(*commit, 2),
              std::vector<uint32_t>(example.indices, example.indices + 3))
        << "bit " << i;
    EXPECT_EQ(contents<uint8_t>(*commit, 3),
              std::vector<uint8_t>(example.texels, example.texels + 4))
        << "bit " << i;
  }
  EXPECT_LE(harmless, 12); // a few in the zstd frame of each array
}

TEST_F(Recording, LimitsHold) {
  const Bytes whole = Example().file();
  EXPECT_NE(refusal(whole, &shaders, {.arrayBytes = 35}).find("an array of 36 bytes"),
            std::string::npos);
  EXPECT_NE(refusal(whole, &shaders, {.totalBytes = 50}).find("more than 50 bytes"),
            std::string::npos);
  EXPECT_NE(refusal(whole, &shaders, {.editBytes = 50}).find("edits of"), std::string::npos);
  EXPECT_NE(refusal(whole, &shaders, {.commits = 0}).find("more than 0 commits"),
            std::string::npos);
}

// A small file that claims a terabyte must not cause an allocation of a terabyte.
TEST_F(Recording, ClaimedSizesAreNotBelieved) {
  Bytes bytes = header();
  recording::ChunkHeader h{recording::ChunkKind::Array, 0, 1, uint64_t(1) << 40, 64, 0};
  append(bytes, &h, sizeof(h));
  bytes.resize(bytes.size() + 64);
  EXPECT_NE(
      refusal(bytes, nullptr, {.arrayBytes = uint64_t(1) << 41, .totalBytes = uint64_t(1) << 42})
          .find("an array of"),
      std::string::npos);
  bytes = header();
  h = {recording::ChunkKind::Edits, 0, 0, uint64_t(1) << 29, uint64_t(1) << 29, 0};
  append(bytes, &h, sizeof(h));
  EXPECT_NE(refusal(bytes).find("ends in the middle"), std::string::npos);
}

TEST_F(Recording, AnArrayShorterThanItsClaim) {
  Bytes bytes = header(), packed(100);
  const uint8_t data[8] = {};
  packed.resize(ZSTD_compress(packed.data(), packed.size(), data, sizeof(data), 1));
  const recording::ChunkHeader h{recording::ChunkKind::Array, 0, 1, 16, packed.size(),
                                 XXH3_64bits(data, 8)};
  append(bytes, &h, sizeof(h));
  append(bytes, packed.data(), packed.size());
  EXPECT_NE(refusal(bytes).find("shorter than it claims"), std::string::npos);
}

// Many edits that refer to one table of the buffer: small in the file, unbounded once unpacked.
TEST_F(Recording, SharedTablesAreRefused) {
  flatbuffers::FlatBufferBuilder builder;
  const std::vector<float> floats(10000, 1.0f);
  const auto parameter = edit::CreateParameterDirect(builder, 3, 7, &floats);
  const auto entry = edit::CreateEdit(builder, edit::Any::Parameter, parameter.Union());
  const std::vector<flatbuffers::Offset<edit::Edit>> many(1000, entry);
  edit::FinishEditsBuffer(builder, edit::CreateEditsDirect(builder, &many, false));
  Bytes bytes = header();
  const recording::ChunkHeader h{recording::ChunkKind::Edits,
                                 0,
                                 0,
                                 builder.GetSize(),
                                 builder.GetSize(),
                                 XXH3_64bits(builder.GetBufferPointer(), builder.GetSize())};
  append(bytes, &h, sizeof(h));
  append(bytes, builder.GetBufferPointer(), builder.GetSize());
  EXPECT_NE(refusal(bytes).find("share their parts"), std::string::npos);
}

struct Fault {
  const char* name;
  void (*change)(Example&);
  const char* reason;
};
class Faults : public Recording, public testing::WithParamInterface<Fault> {};

TEST_P(Faults, AreRefused) {
  const std::string text = after(GetParam().change);
  EXPECT_NE(text.find(GetParam().reason), text.npos) << text;
}

const float notANumber = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Recording, Faults,
    testing::Values(
        Fault{"IndexBeyondPoints", [](Example& e) { e.indices[1] = 3; },
              "an index is beyond the points"},
        Fault{"PointNotFinite", [](Example& e) { e.points[4] = notANumber; },
              "a point is not finite"},
        Fault{"IndicesAsNormals", [](Example& e) { e.geometry.normals = 2; },
              "the normals have a wrong size"},
        Fault{"TexelsAsPoints", [](Example& e) { e.geometry.points = 3; },
              "the points have a wrong size"},
        Fault{"TexelsAsIndices", [](Example& e) { e.geometry.indices = 3; },
              "the indices have a wrong size"},
        Fault{"UnknownArray", [](Example& e) { e.geometry.points = 77; }, "did not arrive"},
        Fault{"NoPoints", [](Example& e) { e.geometry.points = 0; }, "a geometry has no vertices"},
        Fault{"UnknownPrimitive", [](Example& e) { e.geometry.primitive = edit::Primitive(9); },
              "unknown primitive"},
        Fault{"SphereWithPoints",
              [](Example& e) { e.geometry.primitive = edit::Primitive::Sphere; },
              "a sphere has vertices"},
        Fault{"QuadricWithoutNumbers",
              [](Example& e) { e.geometry.primitive = edit::Primitive::Quadric; },
              "ten coefficients"},
        Fault{"AsphereWithPoints",
              [](Example& e) {
                e.geometry.primitive = edit::Primitive::Asphere;
                e.geometry.surface = {0, 0, 0, 1};
              },
              "an analytic surface has vertices"},
        Fault{"AsphereBeyondItsEdge",
              [](Example& e) {
                e.geometry.primitive = edit::Primitive::Asphere;
                e.geometry.points = e.geometry.indices = 0;
                e.geometry.surface = {1, 0, 0, 2};
              },
              "beyond its edge"},
        Fault{"TrianglesWithNumbers", [](Example& e) { e.geometry.surface = {1}; },
              "has numbers of an analytic surface"},
        Fault{"NoWidth", [](Example& e) { e.geometry.width = 0; }, "a width is not positive"},
        Fault{"NoMatrix", [](Example& e) { e.geometry.matrix.reset(); }, "a matrix is missing"},
        Fault{"MatrixOfZeros",
              [](Example& e) { e.instance.matrix = std::make_unique<edit::Matrix>(); },
              "not affine"},
        Fault{"UnknownShader", [](Example& e) { e.geometry.shader = 44; }, "unknown id 44"},
        Fault{"TextureAsShader", [](Example& e) { e.geometry.shader = 1; }, "unknown id 1"},
        Fault{"LightAsSurface", [](Example& e) { e.surfaceClass.name = "Lamp"; },
              "a parameter is not in its class"},
        Fault{"CameraAsSurface",
              [](Example& e) {
                e.surfaceClass.name = "Eye";
                e.parameter.index = 0;
                e.parameter.shader = 99;
              },
              "unknown id 99"},
        Fault{"UnknownClass", [](Example& e) { e.surfaceClass.name = "Absent"; },
              "has no class \"Absent\""},
        Fault{"PathAsLibrary", [](Example& e) { e.surfaceClass.library = "../x"; },
              "only a bare name"},
        Fault{"ParameterRange", [](Example& e) { e.parameter.floats = {2}; }, "is outside"},
        Fault{"ParameterCount",
              [](Example& e) {
                e.parameter.floats = {0, 0};
              },
              "a wrong number of values"},
        Fault{"ParameterIndex", [](Example& e) { e.parameter.index = 10; }, "is not in its class"},
        Fault{"IdTwice", [](Example& e) { e.object.id = 3; }, "names two kinds"},
        Fault{"NoId", [](Example& e) { e.object.id = 0; }, "an edit has no id"},
        Fault{"InstanceOfNothing", [](Example& e) { e.instance.object = 6; }, "unknown id 6"},
        Fault{"ObjectInItself", [](Example& e) { e.instance.parent = 4; },
              "an object contains itself"},
        Fault{"TextureSize", [](Example& e) { e.texture.width = 3; },
              "the texels have a wrong size"},
        Fault{"TextureHuge", [](Example& e) { e.texture.width = e.texture.height = 65536; },
              "impossible size"},
        Fault{"TextureWrap", [](Example& e) { e.texture.wrapS = edit::Wrap(5); }, "unknown wrap"},
        Fault{"TextureWrapR", [](Example& e) { e.texture.wrapR = edit::Wrap(5); }, "unknown wrap"},
        Fault{"TextureNoDepth", [](Example& e) { e.texture.depth = 0; }, "impossible size"},
        Fault{"TextureManyTexels", [](Example& e) { e.texture.depth = 1u << 30; },
              "impossible size"},
        Fault{"TextureDepth", [](Example& e) { e.texture.depth = 2; }, "wrong size"},
        Fault{"TextureBorder",
              [](Example& e) {
                e.texture.border = {0, 0, 0};
              },
              "needs four numbers"},
        Fault{"TextureBorderRange",
              [](Example& e) {
                e.texture.border = {0, 0, 0, 1.5f};
              },
              "out of range"},
        Fault{"TextureBorderNumber",
              [](Example& e) {
                e.texture.border = {0, NAN, 0, 0};
              },
              "out of range"},
        Fault{"FrameSize", [](Example& e) { e.frame.width = 70000; },
              "a frame has an impossible size"},
        Fault{"FrameChannels", [](Example& e) { e.frame.channels = 1 << 20; }, "unknown channels"},
        Fault{"FrameSamples", [](Example& e) { e.frame.samples = 0; }, "impossible samples"},
        Fault{"DeletedUnknown", [](Example& e) { add(e.edits, edit::DeleteLightT()).id = 5; },
              "unknown id 5"},
        Fault{"DeletedInUse", [](Example& e) { add(e.edits, edit::DeleteObjectT()).id = 4; },
              "deleted before its instances"},
        Fault{"UsedAfterDeletion",
              [](Example& e) {
                add(e.edits, edit::DeleteTextureT()).id = 1;
                add(e.edits, edit::TextureT(e.texture));
              },
              "was deleted before"},
        Fault{"LightWithoutShader",
              [](Example& e) {
                edit::LightT light;
                light.id = 8;
                light.matrix = identity();
                add(e.edits, std::move(light));
              },
              "unknown id 0"},
        Fault{"SurfaceAsLight",
              [](Example& e) {
                edit::LightT light;
                light.id = 8;
                light.shader = 3;
                light.matrix = identity();
                add(e.edits, std::move(light));
              },
              "a role that its kind does not allow"},
        Fault{"SurfaceAsCamera",
              [](Example& e) {
                edit::CameraT camera;
                camera.shader = 3;
                camera.matrix = identity();
                add(e.edits, std::move(camera));
              },
              "a role that its kind does not allow"},
        Fault{"EmptyEdit",
              [](Example& e) { e.edits.edits.push_back(std::make_unique<edit::EditT>()); },
              "an empty edit"}),
    [](const auto& info) { return std::string(info.param.name); });

// Geometry parameters: the colours of Varying are its points, which lie within 0 .. 1.
void giveParameter(Example& e, uint32_t index = 2, bool perVertex = true, uint64_t values = 1) {
  e.surfaceClass.name = "Varying";
  e.surfaceClass.library = "varying";
  auto own = std::make_unique<edit::GeometryParameterT>();
  own->index = index;
  own->perVertex = perVertex;
  own->values = values;
  e.geometry.parameters.push_back(std::move(own));
}

TEST_F(Recording, ParametersOfGeometryAreChecked) {
  struct {
    const char* what;
    const char* complaint;
    std::function<void(Example&)> change;
  } const cases[] = {
      {"good by vertex", "", [](Example& e) { giveParameter(e); }},
      {"good by triangle", "",
       [](Example& e) {
         giveParameter(e, 5, false, 4);
         e.extra = {1, 2, 3};
       }},
      {"no such parameter", "a parameter is not in its class",
       [](Example& e) { giveParameter(e, 99); }},
      {"another frequency", "frequency is not that of its class",
       [](Example& e) { giveParameter(e, 2, false); }},
      {"of the whole shader", "frequency is not that of its class",
       [](Example& e) { giveParameter(e, 1); }},
      {"no values", "a parameter has no values", [](Example& e) { giveParameter(e, 2, true, 0); }},
      {"an array that is not there", "did not arrive",
       [](Example& e) { giveParameter(e, 2, true, 77); }},
      {"too few", "have a wrong size", [](Example& e) { giveParameter(e, 2, true, 2); }},
      {"too many", "have a wrong size", [](Example& e) { giveParameter(e, 3); }},
      {"one float too many", "have a wrong size",
       [](Example& e) {
         giveParameter(e, 5, false, 4);
         e.extra = {1, 2, 3, 4};
       }},
      {"nothing in it", "have a wrong size",
       [](Example& e) {
         giveParameter(e, 5, false, 4);
         e.extra.emplace();
       }},
      {"out of range", "is outside",
       [](Example& e) {
         giveParameter(e);
         e.points[3] = 2;
       }},
      {"not finite", "not finite",
       [](Example& e) {
         giveParameter(e, 5, false, 4);
         e.extra = {1, std::numeric_limits<float>::infinity(), 3};
       }},
      {"twice", "twice",
       [](Example& e) {
         giveParameter(e);
         giveParameter(e);
       }},
      {"of no shader", "parameters but no shader",
       [](Example& e) {
         giveParameter(e);
         e.geometry.shader = 0;
       }},
      {"of a sphere", "a sphere has parameters",
       [](Example& e) {
         giveParameter(e);
         e.geometry.primitive = edit::Primitive::Sphere;
         e.geometry.points = e.geometry.indices = 0;
       }},
      {"of another class", "frequency is not that of its class",
       [](Example& e) {
         giveParameter(e);
         e.surfaceClass.name = "Everything";
         e.surfaceClass.library = "everything";
       }},
  };
  for (const auto& c : cases) {
    const std::string text = after(c.change);
    if (*c.complaint)
      EXPECT_NE(text.find(c.complaint), text.npos) << c.what << ": " << text;
    else
      EXPECT_EQ(text, "") << c.what;
  }
  Example unknown; // without class tables: only sizes and numbers are checked
  giveParameter(unknown);
  EXPECT_EQ(refusal(unknown.file()), "");
  unknown.geometry.parameters[0]->values = 2;
  EXPECT_EQ(refusal(unknown.file()), "");
  unknown.geometry.parameters[0]->values = 3;
  EXPECT_NE(refusal(unknown.file()).find("have a wrong size"), std::string::npos);
}

TEST_F(Recording, OtherFilesAreNamedAsSuch) {
  EXPECT_NE(refusal(Bytes(16, 'x')).find("not a recording"), std::string::npos);
  Bytes newer = header();
  newer[8] = 2;
  EXPECT_NE(refusal(newer).find("the recording has version 2; this program reads version 1"),
            std::string::npos);
  EXPECT_THROW(openRecording("/nonexistent/file", nullptr), BadRecording);
}

} // namespace
