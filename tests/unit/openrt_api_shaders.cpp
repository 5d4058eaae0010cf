// openrt_api_shaders.cpp: Tests shader classes, parameters, roles and textures, with the plug-ins
// of tests/abi.
#include <cfloat>
#include <cmath>

#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

class Shaders : public ApiTest {
 protected:
  RTid make(const char* name) { return rtNewShader(rtNewShaderClass(name, "everything")); }
  RTid bind(const char* name = "Everything") {
    const RTid shader = make(name);
    rtBindShader(shader);
    return shader;
  }
};

TEST_F(Shaders, ClassesAreFoundByNameAndLibrary) {
  const RTid id = rtNewShaderClass("Everything", "everything");
  EXPECT_NE(id, 0u);
  EXPECT_EQ(rtNewShaderClass("Everything", "everything"), id);
  RTenum kind = 0;
  int count = 0;
  rtGetShaderClass(id, &kind, &count);
  EXPECT_EQ(kind, RTenum(RT_SURFACE));
  EXPECT_EQ(count, 10);
  rtGetShaderClass(rtNewShaderClass("Lamp", "everything"), &kind, nullptr);
  EXPECT_EQ(kind, RTenum(RT_LIGHT));
  const Commit& c = commit();
  ASSERT_EQ(edits<edit::ShaderClassT>(c).size(), 2u);
  EXPECT_EQ(edits<edit::ShaderClassT>(c)[0]->name, "Everything");
  EXPECT_EQ(edits<edit::ShaderClassT>(c)[0]->library, "everything");
}

TEST_F(Shaders, MissingOnesAreErrors) {
  EXPECT_FAILS(RT_PLUGIN_ERROR, rtNewShaderClass("Everything", "absent"));
  EXPECT_NE(std::string(rtGetErrorMessage()).find("absent"), std::string::npos);
  EXPECT_FAILS(RT_PLUGIN_ERROR, rtNewShaderClass("Absent", "everything"));
  EXPECT_FAILS(RT_PLUGIN_ERROR, rtNewShaderClass("Example", "newer_minor"));
  EXPECT_FAILS(RT_PLUGIN_ERROR, rtNewShaderClass("Everything", "../plugins/everything"));
  EXPECT_FAILS(RT_PLUGIN_ERROR, rtNewShaderClass("NoSuchStockClass", nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtNewShaderClass(nullptr, nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtNewShaderClass("", "everything"));
  EXPECT_FAILS(RT_INVALID_ID, rtNewShader(0));
  EXPECT_FAILS(RT_INVALID_ID, rtGetShaderClass(77, nullptr, nullptr));
}

TEST_F(Shaders, ParametersDescribeThemselves) {
  const RTid id = rtNewShaderClass("Everything", "everything");
  RTparameterInfo info;
  rtGetParameterInfo(id, 1, &info);
  EXPECT_STREQ(info.name, "strength");
  EXPECT_EQ(info.type, RTenum(RT_PARAM_FLOAT));
  EXPECT_EQ(info.defaultValue[0], 0.5f);
  EXPECT_EQ(info.minimum, 0.0f);
  EXPECT_EQ(info.maximum, 1.0f);
  EXPECT_STREQ(info.text, "a fraction");
  rtGetParameterInfo(id, 8, &info);
  EXPECT_EQ(info.minimum, -FLT_MAX);
  EXPECT_EQ(info.maximum, FLT_MAX);
  EXPECT_STREQ(info.text, "");
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtGetParameterInfo(id, 10, &info));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtGetParameterInfo(id, -1, &info));
  EXPECT_FAILS(RT_INVALID_VALUE, rtGetParameterInfo(id, 0, nullptr));
}

TEST_F(Shaders, EveryTypeOfParameterIsSent) {
  const RTid shader = bind();
  RTid texture = 0;
  rtGenTextures(1, &texture);
  const float m[16] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16},
              list[3] = {1, 0.5f, -1};
  rtParameter1i(rtParameterHandle("count"), 7);
  rtParameter1f(rtParameterHandle("strength"), 0.25f);
  rtParameter2f(rtParameterHandle("pair"), 8, 9);
  rtParameter3f(rtParameterHandle("triple"), 7, 8, 9);
  rtParameter4f(rtParameterHandle("quad"), 6, 7, 8, 9);
  rtParameter3f(rtParameterHandle("color"), 1, 0, 1);
  rtParameter16f(rtParameterHandle("matrix"), m);
  rtParameterfv(rtParameterHandle("list"), 3, list);
  rtParameterString(rtParameterHandle("text"), "h\xc3\xa9llo");
  rtParameterTexture(rtParameterHandle("texture"), texture);
  const auto found = edits<edit::ParameterT>(commit());
  ASSERT_EQ(found.size(), 10u);
  for (uint32_t i = 0; i < 10; i++) EXPECT_TRUE(found[i]->shader == shader && found[i]->index == i);
  EXPECT_EQ(found[0]->integer, 7);
  EXPECT_EQ(found[2]->floats, (std::vector<float>{8, 9}));
  EXPECT_EQ(found[6]->floats, std::vector<float>(m, m + 16));
  EXPECT_EQ(found[7]->floats, std::vector<float>(list, list + 3));
  EXPECT_EQ(found[8]->text, "h\xc3\xa9llo");
  EXPECT_EQ(found[9]->texture, texture);
}

TEST_F(Shaders, OnlyWhatChangedIsSent) {
  bind();
  commit();
  for (int i = 0; i <= 10; i++) rtParameter1i(0, i);
  const Commit& c = commit();
  ASSERT_EQ(c.edits.edits.size(), 1u);
  EXPECT_EQ(edits<edit::ParameterT>(c).at(0)->integer, 10);
}

TEST_F(Shaders, BadParametersAreErrorsAndChangeNothing) {
  EXPECT_FAILS(RT_INVALID_OPERATION, rtParameter1f(1, 0)); // no shader is bound
  EXPECT_FAILS(RT_INVALID_OPERATION, rtParameterHandle("strength"));
  bind();
  commit();
  const float bad[16] = {NAN}, list[2] = {0, 1.5f};
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameterHandle("colour"));
  EXPECT_EQ(rtParameterHandle("absent"), -1);
  EXPECT_RT_ERROR(RT_INVALID_PARAMETER);
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameterHandle(nullptr));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter1f(-1, 0));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter1f(10, 0));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter1f(0, 0)); // the parameter is an int
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter1i(1, 0)); // the parameter is a float
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter2f(3, 0, 0));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter3f(2, 0, 0, 0));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter4f(5, 0, 0, 0, 0));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameter16f(7, bad));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameterfv(6, 2, list));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameterString(9, "x"));
  EXPECT_FAILS(RT_INVALID_PARAMETER, rtParameterTexture(8, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter1i(0, 11));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter1i(0, -1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter1f(1, 1.01f));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter1f(1, NAN));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter3f(5, 0, 0, -0.1f));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter2f(2, 0, INFINITY));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter16f(6, bad));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameter16f(6, nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameterfv(7, 2, list));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameterfv(7, 2, nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameterfv(7, size_t(1) << 30, list));
  EXPECT_FAILS(RT_INVALID_VALUE, rtParameterString(8, nullptr));
  EXPECT_FAILS(RT_INVALID_ID, rtParameterTexture(9, 4711));
  EXPECT_FAILS(RT_INVALID_ID, rtBindShader(4711));
  EXPECT_TRUE(commit().edits.edits.empty());
}

TEST_F(Shaders, AParameterHandleFitsAllShadersOfAClass) {
  bind();
  const int handle = rtParameterHandle("strength");
  bind();
  EXPECT_EQ(rtParameterHandle("strength"), handle);
}

TEST_F(Shaders, PrimitivesLatchTheBoundSurfaceShader) {
  const RTid shader = bind();
  rtBeginObject(0);
  rtSphere(1);
  rtBindShader(0);
  rtSphere(1);
  rtBindShader(make("Lamp"));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtSphere(1));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtBegin(RT_POINTS));
  rtEndObject();
  const auto objects = edits<edit::ObjectT>(commit());
  ASSERT_EQ(objects.at(0)->geometries.size(), 2u);
  EXPECT_EQ(objects[0]->geometries[0]->shader, shader);
  EXPECT_EQ(objects[0]->geometries[1]->shader, 0u);
}

TEST_F(Shaders, RolesTakeTheirKindOnly) {
  const RTid surface = make("Plain"), lamp = make("Lamp"), eye = make("Eye"), sky = make("Sky");
  EXPECT_FAILS(RT_INVALID_OPERATION, rtUseLight(surface));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtUseCamera(lamp));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtUseEnvironment(eye));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtDefaultShader(sky));
  EXPECT_FAILS(RT_INVALID_ID, rtUseLight(0));
  EXPECT_FAILS(RT_INVALID_ID, rtUseCamera(4711));
  rtTranslated(1, 2, 3);
  const RTid light = rtUseLight(lamp);
  rtUseCamera(eye);
  rtUseEnvironment(sky);
  rtDefaultShader(surface);
  const Commit& c = commit();
  EXPECT_EQ(edits<edit::LightT>(c).at(0)->id, light);
  EXPECT_EQ(matrixOf(*edits<edit::LightT>(c)[0]->matrix)[12], 1.0);
  EXPECT_EQ(edits<edit::CameraT>(c).at(0)->shader, eye);
  EXPECT_EQ(matrixOf(*edits<edit::CameraT>(c)[0]->matrix)[13], 2.0);
  EXPECT_EQ(edits<edit::EnvironmentT>(c).at(0)->shader, sky);
  EXPECT_EQ(edits<edit::DefaultShaderT>(c).at(0)->shader, surface);
}

TEST_F(Shaders, RolesBelongOutsideDefinitions) {
  const RTid lamp = make("Lamp"), eye = make("Eye"), sky = make("Sky");
  rtBeginObject(0);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtUseLight(lamp));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtUseCamera(eye));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtUseEnvironment(sky));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtPerspective(40));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtOrtho(2));
  rtEndObject();
}

TEST_F(Shaders, LightsMoveAndAreScoped) {
  const RTid light = rtUseLight(make("Lamp")), instance = rtInstantiateObject(triangleObject());
  const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1};
  rtLightMatrix(light, m);
  rtLightScope(light, instance);
  EXPECT_FAILS(RT_INVALID_ID, rtLightScope(light, light));
  EXPECT_FAILS(RT_INVALID_ID, rtLightScope(instance, 0));
  EXPECT_FAILS(RT_INVALID_ID, rtLightMatrix(4711, m));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLightMatrix(light, nullptr));
  const auto found = edits<edit::LightT>(commit());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]->scope, instance);
  EXPECT_EQ(matrixOf(*found[0]->matrix)[13], 5.0);
  rtRemoveLight(light);
  EXPECT_FAILS(RT_INVALID_ID, rtRemoveLight(light));
  EXPECT_EQ(edits<edit::DeleteLightT>(commit()).size(), 1u);
}

TEST_F(Shaders, StockCameras) {
  EXPECT_FAILS(RT_INVALID_VALUE, rtPerspective(0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtPerspective(180));
  EXPECT_FAILS(RT_INVALID_VALUE, rtPerspective(NAN));
  EXPECT_FAILS(RT_INVALID_VALUE, rtOrtho(0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtOrtho(INFINITY));
  rtPushMatrix();
  rtScaled(1, 0, 1);
  EXPECT_FAILS(RT_INVALID_VALUE, rtPerspective(40)); // singular matrix
  rtPopMatrix();
  rtPerspective(40);
  const Commit& first = commit();
  EXPECT_EQ(edits<edit::ShaderClassT>(first).at(0)->name, "PerspectiveCamera");
  EXPECT_EQ(edits<edit::ShaderClassT>(first)[0]->library, "");
  EXPECT_EQ(edits<edit::ParameterT>(first).at(0)->floats, (std::vector<float>{40}));
  const RTid shader = edits<edit::CameraT>(first).at(0)->shader;
  rtTranslated(0, 0, 5);
  rtPerspective(60);
  const Commit& second = commit(); // the same shader again
  EXPECT_TRUE(edits<edit::ShaderT>(second).empty());
  EXPECT_EQ(edits<edit::CameraT>(second).at(0)->shader, shader);
  rtOrtho(3);
  EXPECT_EQ(edits<edit::ShaderClassT>(commit()).at(0)->name, "OrthographicCamera");
  rtUseCamera(0);
  EXPECT_EQ(edits<edit::CameraT>(commit()).at(0)->shader, 0u);
}

TEST_F(Shaders, DeletingAShaderEndsItsRoles) {
  const RTid surface = bind("Plain"), lamp = make("Lamp"), eye = make("Eye");
  rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  const RTid instance = rtInstantiateObject(triangleObject());
  rtInstanceShader(instance, surface);
  const RTid light = rtUseLight(lamp);
  rtUseCamera(eye);
  rtDefaultShader(surface);
  commit();
  rtDeleteShader(surface);
  rtDeleteShader(lamp);
  rtDeleteShader(eye);
  EXPECT_FAILS(RT_INVALID_ID, rtBindShader(surface));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtParameterHandle("x")); // the deleted shader was bound
  EXPECT_FAILS(RT_INVALID_ID, rtRemoveLight(light));
  EXPECT_FAILS(RT_INVALID_ID, rtDeleteShader(surface));
  const Commit& c = commit();
  EXPECT_EQ(edits<edit::DeleteLightT>(c).size(), 1u);
  EXPECT_EQ(edits<edit::InstanceT>(c).at(0)->shader, 0u);
  EXPECT_EQ(edits<edit::CameraT>(c).at(0)->shader, 0u);
  EXPECT_EQ(edits<edit::DefaultShaderT>(c).at(0)->shader, 0u);
  EXPECT_EQ(edits<edit::DeleteShaderT>(c).size(), 3u);
}

TEST_F(Shaders, GeometryOfAShaderDeletedBeforeItsCommitHasTheDefault) {
  const RTid shader = bind("Plain");
  rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  rtDeleteShader(shader);
  EXPECT_EQ(edits<edit::ObjectT>(commit()).at(0)->geometries.at(0)->shader, 0u);
}

class Textures : public Shaders {
 protected:
  RTid bindTexture() {
    RTid id = 0;
    rtGenTextures(1, &id);
    rtBindTexture(id);
    return id;
  }
  const float half[4] = {0.5f, 0.5f, 0.5f, 0.5f};
  const unsigned char bytes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
};

TEST_F(Textures, ImageAndParametersMakeOneEdit) {
  const RTid texture = bindTexture();
  rtTexParameteri(RT_TEXTURE_WRAP_S, RT_CLAMP_TO_EDGE);
  EXPECT_TRUE(edits<edit::TextureT>(commit()).empty()); // no image yet
  rtTexImage2D(3, 1, 2, RT_UNSIGNED_BYTE, bytes + 4);
  rtTexImage2D(2, 4, 2, RT_UNSIGNED_BYTE, bytes);
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, RT_NEAREST);
  rtTexParameteri(RT_TEXTURE_SRGB, 1);
  const Commit& c = commit();
  ASSERT_EQ(edits<edit::TextureT>(c).size(), 1u);
  const edit::TextureT& t = *edits<edit::TextureT>(c)[0];
  EXPECT_EQ(t.id, texture);
  EXPECT_TRUE(t.components == 2 && t.width == 4 && t.height == 2 && !t.isFloat && t.nearest &&
              t.srgb);
  EXPECT_EQ(t.wrapS, edit::Wrap::Clamp);
  EXPECT_EQ(t.wrapT, edit::Wrap::Repeat);
  EXPECT_EQ(contents<unsigned char>(c, t.texels), std::vector<unsigned char>(bytes, bytes + 16));
  EXPECT_EQ(c.arrays.size(), 1u);
}

TEST_F(Textures, AParameterLaterDoesNotSendTheImageAgain) {
  bindTexture();
  rtTexImage2D(1, 4, 4, RT_UNSIGNED_BYTE, bytes);
  const ArrayId texels = edits<edit::TextureT>(commit()).at(0)->texels;
  rtTexParameteri(RT_TEXTURE_WRAP_T, RT_CLAMP_TO_EDGE);
  const Commit& c = commit();
  EXPECT_TRUE(c.arrays.empty());
  EXPECT_EQ(edits<edit::TextureT>(c).at(0)->texels, texels);
}

TEST_F(Textures, WrapModesAndABorder) {
  bindTexture();
  const float border[4] = {0, 0.25f, 0.5f, 1}, nan[4] = {0, 0, NAN, 0}, low[4] = {-0.01f, 0, 0, 0},
              high[4] = {0, 0, 0, 1.01f};
  rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, border); // before there is an image
  rtTexParameteri(RT_TEXTURE_WRAP_S, RT_MIRRORED_REPEAT);
  rtTexParameteri(RT_TEXTURE_WRAP_T, RT_CLAMP_TO_BORDER);
  rtTexImage2D(1, 4, 4, RT_UNSIGNED_BYTE, bytes);
  {
    const Commit& c = commit();
    const edit::TextureT& t = *edits<edit::TextureT>(c).at(0);
    EXPECT_EQ(t.wrapS, edit::Wrap::Mirror);
    EXPECT_EQ(t.wrapT, edit::Wrap::Border);
    EXPECT_EQ(t.border, std::vector<float>(border, border + 4));
  }
  EXPECT_FAILS(RT_INVALID_ENUM, rtTexParameterfv(RT_TEXTURE_WRAP_S, border));
  EXPECT_FAILS(RT_INVALID_ENUM, rtTexParameteri(RT_TEXTURE_BORDER_COLOR, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, nullptr));
  for (const float* wrong : {nan, low, high})
    EXPECT_FAILS(RT_INVALID_VALUE, rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, wrong));
  EXPECT_TRUE(edits<edit::TextureT>(commit()).empty());
  rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, half);
  const Commit& c = commit();
  EXPECT_TRUE(c.arrays.empty()); // the image is not sent again
  EXPECT_EQ(edits<edit::TextureT>(c).at(0)->border, std::vector<float>(4, 0.5f));
}

TEST_F(Textures, FloatImages) {
  bindTexture();
  const float values[4] = {0.5f, 2, -1, 0};
  rtTexImage2D(4, 1, 1, RT_FLOAT, values);
  const Commit& c = commit();
  EXPECT_TRUE(edits<edit::TextureT>(c).at(0)->isFloat);
  EXPECT_EQ(contents<float>(c, edits<edit::TextureT>(c)[0]->texels),
            std::vector<float>(values, values + 4));
}

TEST_F(Textures, BadCallsAreErrors) {
  EXPECT_FAILS(RT_INVALID_OPERATION,
               rtTexImage2D(1, 1, 1, RT_UNSIGNED_BYTE, bytes)); // no texture is bound
  EXPECT_FAILS(RT_INVALID_OPERATION, rtTexParameteri(RT_TEXTURE_SRGB, 1));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, half));
  EXPECT_FAILS(RT_INVALID_ID, rtBindTexture(4711));
  EXPECT_FAILS(RT_INVALID_ID, rtDeleteTexture(0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtGenTextures(1, nullptr));
  const RTid texture = bindTexture();
  const float bad[1] = {NAN};
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(0, 1, 1, RT_UNSIGNED_BYTE, bytes));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(5, 1, 1, RT_UNSIGNED_BYTE, bytes));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(1, 0, 1, RT_UNSIGNED_BYTE, bytes));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(1, 1, -1, RT_UNSIGNED_BYTE, bytes));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(1, 65537, 1, RT_UNSIGNED_BYTE, bytes));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(1, 65536, 65536, RT_UNSIGNED_BYTE, bytes));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(1, 1, 1, RT_UNSIGNED_BYTE, nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexImage2D(1, 1, 1, RT_FLOAT, bad));
  EXPECT_FAILS(RT_INVALID_ENUM, rtTexImage2D(1, 1, 1, RT_DOUBLE, bytes));
  EXPECT_FAILS(RT_INVALID_ENUM, rtTexParameteri(0, 0));
  EXPECT_FAILS(RT_INVALID_ENUM, rtTexParameteri(RT_TEXTURE_WRAP_S, RT_LINEAR));
  EXPECT_FAILS(RT_INVALID_ENUM, rtTexParameteri(RT_TEXTURE_MAG_FILTER, RT_REPEAT));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexParameteri(RT_TEXTURE_SRGB, 2));
  EXPECT_TRUE(edits<edit::TextureT>(commit()).empty());
  rtTexImage2D(1, 1, 1, RT_UNSIGNED_BYTE, bytes);
  commit();
  rtDeleteTexture(texture);
  // The deleted texture was bound.
  EXPECT_FAILS(RT_INVALID_OPERATION, rtTexParameteri(RT_TEXTURE_SRGB, 1));
  EXPECT_EQ(edits<edit::DeleteTextureT>(commit()).size(), 1u);
}

} // namespace
