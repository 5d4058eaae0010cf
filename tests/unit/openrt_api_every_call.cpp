// openrt_api_every_call.cpp: calls every function of openrt.h in every state and with every kind of
// argument in which it must fail. Each call must set the right error code, name the function in the
// message, and change nothing. The tables are compared with the header: a function missing from
// them fails the test. Longer than 500 lines because it has one test for each call of the API.
#include <cfloat>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <regex>
#include <set>

#include "scene/transports.h"
#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

constexpr float nan = NAN, inf = INFINITY;
constexpr RTid foreign = 4711;

struct World {
  RTid object = 0, instance = 0, surfaceClass = 0, surface = 0, varying = 0, lamp = 0, eye = 0,
       sky = 0, texture = 0, light = 0;
  RTcontext context = nullptr;
  int number = -1, list = -1, text = -1, image = -1, count = -1, whole = -1, color = -1;
};

const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const double singular[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
const double notFinite[16] = {1, 0, 0, 0, 0, NAN, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const double projective[16] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const float identityF[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const float notFiniteF[16] = {1, 0, 0, 0, 0, NAN, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const float three[4] = {1, 2, 3, 4}, badThree[4] = {1, nan, 3, 4};
const float colour[4] = {0, 0.5f, 1, 1};
const double threeD[3] = {1, 2, 3}, badThreeD[3] = {1, HUGE_VAL, 3};
const double ball[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1}, badBall[10] = {1, NAN},
             below[3] = {-1, -1, -1}, above[3] = {1, 1, 1};
const uint32_t indices[3] = {0, 1, 2};

using Call = std::function<void(World&)>;
struct Named {
  const char* name;
  Call call;
};
#define CALL(function, ...)                                                                        \
  {                                                                                                \
#function, [](World & w) { (void)w, function(__VA_ARGS__); }                                   \
  }

RTid ids[2];
float floats[64];
double doubles[3];
int kind;
RTparameterInfo info;
RThit hit;
RThitd hitd;
RTrayd rayd{{0, 0, 1}, 0, {0, 0, -1}, 1};
RTray ray{{0, 0, 1}, 0, {0, 0, -1}, 1};
uint8_t bytes[4];
uint32_t number;
const size_t places[2] = {0, 1}, fallingPlaces[2] = {1, 0};
RTclosest closest;
double matrix[16];
RTstats statistics;
RTworker worker;

// Calls with valid arguments. Without a context all of them fail.
const Named needContext[] = {
    CALL(rtErrorCallback, nullptr, nullptr),
    CALL(rtLogCallback, nullptr, nullptr),
    CALL(rtBegin, RT_TRIANGLES),
    CALL(rtEnd),
    CALL(rtVertex2f, 0, 0),
    CALL(rtVertex3f, 0, 0, 0),
    CALL(rtVertex3fv, three),
    CALL(rtVertex3d, 0, 0, 0),
    CALL(rtVertex3dv, threeD),
    CALL(rtNormal3f, 0, 0, 1),
    CALL(rtNormal3fv, three),
    CALL(rtTexCoord2f, 0, 0),
    CALL(rtTexCoord2fv, three),
    CALL(rtColor3f, 0, 0, 0),
    CALL(rtColor3fv, three),
    CALL(rtColor4f, 0, 0, 0, 1),
    CALL(rtColor4fv, three),
    CALL(rtTexGen, RT_TEX_GEN_NORMAL),
    CALL(rtFogCoordf, .5f),
    CALL(rtLineStipple, 2, uint16_t(0xff)),
    CALL(rtLineWidth, 1),
    CALL(rtPointSize, 1),
    CALL(rtEnable, RT_CULL_FACE),
    CALL(rtDisable, RT_CULL_FACE),
    CALL(rtLoadName, 1),
    CALL(rtSphere, 1),
    CALL(rtQuadric, ball, below, above),
    CALL(rtCylinder, 1, -1, 1),
    CALL(rtCone, 1, 0, -1, 1),
    CALL(rtAsphere, .1, 0, 0, nullptr, 0, 1),
    CALL(rtVertexPointer, 3, RT_FLOAT, 0, three),
    CALL(rtNormalPointer, RT_FLOAT, 0, three),
    CALL(rtTexCoordPointer, 2, RT_FLOAT, 0, three),
    CALL(rtColorPointer, 3, RT_FLOAT, 0, three),
    CALL(rtFogCoordPointer, RT_FLOAT, 0, nullptr),
    CALL(rtDrawArrays, RT_TRIANGLES, 0, 3),
    CALL(rtDrawElements, RT_TRIANGLES, 3, indices, 3),
    CALL(rtPushMatrix),
    CALL(rtPopMatrix),
    CALL(rtLoadIdentity),
    CALL(rtLoadMatrixf, identityF),
    CALL(rtLoadMatrixd, identity),
    CALL(rtMultMatrixf, identityF),
    CALL(rtMultMatrixd, identity),
    CALL(rtTranslatef, 0, 0, 0),
    CALL(rtTranslated, 0, 0, 0),
    CALL(rtRotatef, 0, 0, 0, 1),
    CALL(rtRotated, 0, 0, 0, 1),
    CALL(rtScalef, 1, 1, 1),
    CALL(rtScaled, 1, 1, 1),
    CALL(rtGetMatrixd, matrix),
    CALL(rtGenObjects, 1, ids),
    CALL(rtBeginObject, 0),
    CALL(rtEndObject),
    CALL(rtDeleteObject, w.object),
    CALL(rtInstantiateObject, w.object),
    CALL(rtDeleteInstance, w.instance),
    CALL(rtInstanceMatrix, w.instance, identity),
    CALL(rtInstanceVisible, w.instance, 1),
    CALL(rtInstanceShader, w.instance, 0),
    CALL(rtInstanceFog, w.instance, 0),
    CALL(rtInstanceHint, w.instance, RT_STATIC),
    CALL(rtObjectHint, w.object, RT_STATIC),
    CALL(rtInstanceUserData, w.instance, 1),
    CALL(rtNewShaderClass, "Everything", "everything"),
    CALL(rtNewShader, w.surfaceClass),
    CALL(rtBindShader, 0),
    CALL(rtDeleteShader, w.surface),
    CALL(rtParameterHandle, "strength"),
    CALL(rtParameter1i, 0, 1),
    CALL(rtParameter1f, 1, 0),
    CALL(rtParameter2f, 2, 0, 0),
    CALL(rtParameter3f, 3, 0, 0, 0),
    CALL(rtParameter4f, 4, 0, 0, 0, 0),
    CALL(rtParameter16f, 6, identityF),
    CALL(rtParameterfv, 7, 0, nullptr),
    CALL(rtParameterString, 8, ""),
    CALL(rtParameterTexture, 9, 0),
    CALL(rtParameterPointer, 2, 0, three),
    CALL(rtReloadShaders),
    CALL(rtGetShaderClass, w.surfaceClass, nullptr, &kind),
    CALL(rtGetParameterInfo, w.surfaceClass, 0, &info),
    CALL(rtUseLight, w.lamp),
    CALL(rtLightMatrix, w.light, identity),
    CALL(rtLightScope, w.light, 0),
    CALL(rtRemoveLight, w.light),
    CALL(rtUseCamera, w.eye),
    CALL(rtUseEnvironment, w.sky),
    CALL(rtUseTransport, 0),
    CALL(rtDefaultShader, 0),
    CALL(rtLookAt, 0, 0, 1, 0, 0, 0, 0, 1, 0),
    CALL(rtPerspective, 40),
    CALL(rtOrtho, 1),
    CALL(rtGenTextures, 1, ids),
    CALL(rtDeleteTexture, w.texture),
    CALL(rtBindTexture, 0),
    CALL(rtTexImage2D, 1, 1, 1, RT_UNSIGNED_BYTE, bytes),
    CALL(rtTexImage3D, 1, 1, 1, 1, RT_UNSIGNED_BYTE, bytes),
    CALL(rtTexParameteri, RT_TEXTURE_SRGB, 1),
    CALL(rtTexParameterfv, RT_TEXTURE_BORDER_COLOR, colour),
    CALL(rtFrameBuffer, 4, 4, RT_RGBA),
    CALL(rtScissor, 0, 0, 2, 2),
    CALL(rtUniteNames, nullptr, 0),
    CALL(rtQuality, RT_SEED, 1),
    CALL(rtQualityf, RT_TARGET_ERROR, 0),
    CALL(rtSwapBuffers),
    CALL(rtFinishFrame),
    CALL(rtRender),
    CALL(rtReadPixels, RT_RGBA, floats, 64),
    CALL(rtGetStats, &statistics),
    CALL(rtPick, 0, 0, &hit),
    CALL(rtCastRays, 1, &ray, &hit),
    CALL(rtOccludedRays, 1, &ray, bytes),
    CALL(rtCountHits, 1, &ray, &number),
    CALL(rtListHits, 1, &ray, places, &hit),
    CALL(rtCastRaysd, 1, &rayd, &hitd),
    CALL(rtOccludedRaysd, 1, &rayd, bytes),
    CALL(rtCountHitsd, 1, &rayd, &number),
    CALL(rtListHitsd, 1, &rayd, places, &hitd),
    CALL(rtClosestPoints, 1, floats, 1, &closest),
    CALL(rtClosestPointsd, 1, doubles, 1, &hitd),
};
// Functions that need no context.
const char* const anywhere[] = {"rtGetError",
                                "rtGetErrorMessage",
                                "rtNewContext",
                                "rtMakeCurrent",
                                "rtGetCurrent",
                                "rtDeleteContext",
                                "rtInit",
                                "rtExit",
                                "rtCancel",
                                "rtProgress",
                                "rtSnapshot",
                                "rtGetWorkers",
                                "rtRunningShader",
                                "rtGetQualityInfo",
                                "rtGetTransportInfo",
                                "rtGetChannelInfo",
                                "rtIsQualityAllowed"};

enum State { Outside, Definition, List };
struct Wrong {
  const char* name;
  RTenum code;
  State state;
  Call call;
};
#define WRONG(code, state, function, ...)                                                          \
  {                                                                                                \
#function, code, state, [](World & w) { (void)w, function(__VA_ARGS__); }                      \
  }
#define VALUE RT_INVALID_VALUE
#define OPERATION RT_INVALID_OPERATION
#define ID RT_INVALID_ID
#define ENUM RT_INVALID_ENUM
#define PARAMETER RT_INVALID_PARAMETER

// Calls that must fail. The surface shader of the class Everything is bound, also in definitions;
// in lists a shader of the class Varying is bound.
const Wrong wrong[] = {
    // Definitions and lists that are not open, or are open.
    WRONG(OPERATION, Outside, rtBegin, RT_TRIANGLES), WRONG(ENUM, Definition, rtBegin, 99),
    WRONG(OPERATION, List, rtBegin, RT_TRIANGLES), WRONG(OPERATION, Outside, rtEnd),
    WRONG(OPERATION, Definition, rtEnd), WRONG(OPERATION, Outside, rtEndObject),
    WRONG(OPERATION, List, rtEndObject), WRONG(OPERATION, Definition, rtBeginObject, 0),
    WRONG(OPERATION, List, rtBeginObject, 0), WRONG(ID, Outside, rtBeginObject, foreign),
    WRONG(ID, Outside, rtBeginObject, w.texture), WRONG(OPERATION, Definition, rtRender),
    WRONG(OPERATION, Definition, rtSwapBuffers), WRONG(OPERATION, List, rtRender),
    WRONG(OPERATION, List, rtSwapBuffers),
    // Vertices and their attributes.
    WRONG(OPERATION, Outside, rtVertex2f, 0, 0), WRONG(OPERATION, Definition, rtVertex2f, 0, 0),
    WRONG(VALUE, List, rtVertex2f, nan, 0), WRONG(OPERATION, Definition, rtVertex3f, 0, 0, 0),
    WRONG(VALUE, List, rtVertex3f, 0, inf, 0), WRONG(VALUE, List, rtVertex3fv, nullptr),
    WRONG(VALUE, List, rtVertex3fv, badThree), WRONG(OPERATION, Definition, rtVertex3fv, three),
    WRONG(VALUE, List, rtVertex3d, 0, 0, 1e39), WRONG(OPERATION, Definition, rtVertex3d, 0, 0, 0),
    WRONG(VALUE, List, rtVertex3dv, nullptr), WRONG(VALUE, List, rtVertex3dv, badThreeD),
    WRONG(OPERATION, Definition, rtVertex3dv, threeD), WRONG(VALUE, Outside, rtNormal3f, nan, 0, 0),
    WRONG(VALUE, Outside, rtNormal3fv, nullptr), WRONG(VALUE, List, rtNormal3fv, badThree),
    WRONG(VALUE, Outside, rtTexCoord2f, 0, inf), WRONG(VALUE, Outside, rtTexCoord2fv, nullptr),
    WRONG(VALUE, List, rtTexCoord2fv, badThree), WRONG(VALUE, Outside, rtColor3f, 0, 0, nan),
    WRONG(VALUE, Outside, rtColor3fv, nullptr), WRONG(VALUE, List, rtColor3fv, badThree),
    WRONG(VALUE, Outside, rtColor4f, 0, 0, 0, nan), WRONG(VALUE, Outside, rtColor4fv, nullptr),
    WRONG(VALUE, List, rtColor4fv, badThree), WRONG(VALUE, Outside, rtLineWidth, 0),
    WRONG(VALUE, Outside, rtLineWidth, nan), WRONG(VALUE, Outside, rtPointSize, -1),
    WRONG(VALUE, Outside, rtPointSize, inf), WRONG(VALUE, Outside, rtLineStipple, 0, uint16_t(1)),
    WRONG(VALUE, Outside, rtLineStipple, 257, uint16_t(1)),
    WRONG(ENUM, Outside, rtTexGen, RT_TEX_GEN_SPHERE_REFLECTION + 1),
    WRONG(VALUE, Outside, rtFogCoordf, nan), WRONG(ENUM, Outside, rtEnable, 1),
    WRONG(ENUM, Outside, rtDisable, 1), WRONG(OPERATION, Outside, rtSphere, 1),
    WRONG(OPERATION, List, rtSphere, 1), WRONG(VALUE, Definition, rtSphere, 0),
    WRONG(VALUE, Definition, rtSphere, nan),
    WRONG(OPERATION, Outside, rtQuadric, ball, below, above),
    WRONG(OPERATION, List, rtQuadric, ball, below, above),
    WRONG(VALUE, Definition, rtQuadric, nullptr, below, above),
    WRONG(VALUE, Definition, rtQuadric, badBall, below, above),
    WRONG(VALUE, Definition, rtQuadric, ball, above, below),
    WRONG(OPERATION, Outside, rtCylinder, 1, -1, 1), WRONG(OPERATION, List, rtCylinder, 1, -1, 1),
    WRONG(VALUE, Definition, rtCylinder, 0, -1, 1), WRONG(VALUE, Definition, rtCylinder, 1, 1, 1),
    WRONG(OPERATION, Outside, rtCone, 1, 0, -1, 1), WRONG(OPERATION, List, rtCone, 1, 0, -1, 1),
    WRONG(VALUE, Definition, rtCone, 0, 0, -1, 1), WRONG(VALUE, Definition, rtCone, -1, 1, -1, 1),
    WRONG(OPERATION, Outside, rtAsphere, .1, 0, 0, nullptr, 0, 1),
    WRONG(OPERATION, List, rtAsphere, .1, 0, 0, nullptr, 0, 1),
    WRONG(VALUE, Definition, rtAsphere, nan, 0, 0, nullptr, 0, 1),
    WRONG(VALUE, Definition, rtAsphere, .1, 0, 1, nullptr, 0, 1),
    WRONG(VALUE, Definition, rtAsphere, .1, 0, 9, below, 0, 1),
    WRONG(VALUE, Definition, rtAsphere, 2, 0, 0, nullptr, 0, 1), // beyond the edge
    // Arrays.
    WRONG(VALUE, Outside, rtVertexPointer, 2, RT_FLOAT, 0, three),
    WRONG(ENUM, Outside, rtVertexPointer, 3, RT_UNSIGNED_BYTE, 0, three),
    WRONG(VALUE, Outside, rtVertexPointer, 3, RT_FLOAT, 8, three),
    WRONG(ENUM, Outside, rtNormalPointer, RT_DOUBLE, 0, three),
    WRONG(VALUE, Outside, rtNormalPointer, RT_FLOAT, 11, three),
    WRONG(VALUE, Outside, rtTexCoordPointer, 3, RT_FLOAT, 0, three),
    WRONG(ENUM, Outside, rtTexCoordPointer, 2, 0, 0, three),
    WRONG(VALUE, Outside, rtColorPointer, 5, RT_FLOAT, 0, three),
    WRONG(ENUM, Outside, rtColorPointer, 4, RT_DOUBLE, 0, three),
    WRONG(ENUM, Outside, rtFogCoordPointer, RT_DOUBLE, 0, three),
    WRONG(VALUE, Outside, rtFogCoordPointer, RT_FLOAT, 3, three),
    WRONG(OPERATION, Outside, rtDrawArrays, RT_TRIANGLES, 0, 3),
    WRONG(OPERATION, List, rtDrawArrays, RT_TRIANGLES, 0, 3),
    WRONG(OPERATION, Definition, rtDrawArrays, RT_TRIANGLES, 0, 3), // no array
    WRONG(ENUM, Definition, rtDrawArrays, 77, 0, 3),
    WRONG(VALUE, Definition, rtDrawArrays, RT_TRIANGLES, 0, SIZE_MAX),
    WRONG(OPERATION, Outside, rtDrawElements, RT_TRIANGLES, 3, indices, 3),
    WRONG(VALUE, Definition, rtDrawElements, RT_TRIANGLES, 3, nullptr, 3),
    WRONG(OPERATION, Definition, rtDrawElements, RT_TRIANGLES, 3, indices, 3),
    // Matrices.
    WRONG(RT_STACK_UNDERFLOW, Outside, rtPopMatrix),
    WRONG(RT_STACK_UNDERFLOW, Definition, rtPopMatrix),
    WRONG(VALUE, Outside, rtLoadMatrixf, nullptr), WRONG(VALUE, Outside, rtLoadMatrixf, notFiniteF),
    WRONG(VALUE, Outside, rtLoadMatrixd, nullptr), WRONG(VALUE, Outside, rtLoadMatrixd, projective),
    WRONG(VALUE, Outside, rtMultMatrixf, nullptr), WRONG(VALUE, Outside, rtMultMatrixf, notFiniteF),
    WRONG(VALUE, Outside, rtMultMatrixd, nullptr), WRONG(VALUE, Outside, rtMultMatrixd, notFinite),
    WRONG(VALUE, Outside, rtTranslatef, nan, 0, 0),
    WRONG(VALUE, Outside, rtTranslated, 0, HUGE_VAL, 0),
    WRONG(VALUE, Outside, rtRotatef, nan, 0, 0, 1), WRONG(VALUE, Outside, rtRotated, 10, 0, 0, 0),
    WRONG(VALUE, Outside, rtScalef, 1, inf, 1), WRONG(VALUE, Outside, rtScaled, 1, 1, double(nan)),
    WRONG(VALUE, Outside, rtGetMatrixd, nullptr),
    WRONG(VALUE, Outside, rtLookAt, 0, 0, 0, 0, 0, 0, 0, 1, 0),
    WRONG(VALUE, Outside, rtLookAt, 0, 0, 1, 0, 0, 0, 0, 0, 1),
    WRONG(VALUE, Outside, rtLookAt, double(nan), 0, 1, 0, 0, 0, 0, 1, 0),
    // Objects and instances.
    WRONG(VALUE, Outside, rtGenObjects, 1, nullptr), WRONG(ID, Outside, rtDeleteObject, 0),
    WRONG(ID, Outside, rtDeleteObject, foreign), WRONG(ID, Outside, rtDeleteObject, w.instance),
    WRONG(ID, Outside, rtInstantiateObject, 0), WRONG(ID, Outside, rtInstantiateObject, w.surface),
    WRONG(OPERATION, List, rtInstantiateObject, w.object), WRONG(ID, Outside, rtDeleteInstance, 0),
    WRONG(ID, Outside, rtDeleteInstance, w.object),
    WRONG(ID, Outside, rtInstanceMatrix, foreign, identity),
    WRONG(VALUE, Outside, rtInstanceMatrix, w.instance, nullptr),
    WRONG(VALUE, Outside, rtInstanceMatrix, w.instance, notFinite),
    WRONG(VALUE, Outside, rtInstanceMatrix, w.instance, projective),
    WRONG(ID, Outside, rtInstanceVisible, foreign, 0),
    WRONG(ID, Outside, rtInstanceShader, foreign, 0),
    WRONG(ID, Outside, rtInstanceShader, w.instance, foreign),
    WRONG(OPERATION, Outside, rtInstanceShader, w.instance, w.lamp),
    WRONG(ID, Outside, rtInstanceFog, foreign, 0),
    WRONG(ID, Outside, rtInstanceFog, w.instance, foreign),
    WRONG(OPERATION, Outside, rtInstanceFog, w.instance, w.lamp),
    WRONG(ID, Outside, rtInstanceHint, foreign, RT_DYNAMIC),
    WRONG(ENUM, Outside, rtInstanceHint, w.instance, 0),
    WRONG(ID, Outside, rtObjectHint, foreign, RT_DYNAMIC),
    WRONG(ENUM, Outside, rtObjectHint, w.object, 0),
    WRONG(ID, Outside, rtInstanceUserData, foreign, 0),
    // Shaders.
    WRONG(VALUE, Outside, rtNewShaderClass, nullptr, nullptr),
    WRONG(VALUE, Outside, rtNewShaderClass, "", nullptr),
    WRONG(RT_PLUGIN_ERROR, Outside, rtNewShaderClass, "Nothing", "everything"),
    WRONG(RT_PLUGIN_ERROR, Outside, rtNewShaderClass, "Nothing", "no_such_library"),
    WRONG(RT_PLUGIN_ERROR, Outside, rtNewShaderClass, "Everything", "../everything"),
    WRONG(ID, Outside, rtNewShader, foreign), WRONG(ID, Outside, rtNewShader, w.surface),
    WRONG(ID, Outside, rtBindShader, foreign), WRONG(ID, Outside, rtDeleteShader, 0),
    WRONG(ID, Outside, rtDeleteShader, w.surfaceClass),
    WRONG(PARAMETER, Outside, rtParameterHandle, "nothing"),
    WRONG(VALUE, Outside, rtParameterHandle, nullptr), WRONG(VALUE, Outside, rtParameterHandle, ""),
    WRONG(PARAMETER, Outside, rtParameter1i, -1, 0),
    WRONG(PARAMETER, Outside, rtParameter1i, w.number, 0), // a parameter of another type
    WRONG(VALUE, Outside, rtParameter1i, w.count, 11),
    WRONG(PARAMETER, Outside, rtParameter1f, 1000, 0),
    WRONG(VALUE, Outside, rtParameter1f, w.number, 2),
    WRONG(VALUE, Outside, rtParameter1f, w.number, nan),
    WRONG(PARAMETER, Outside, rtParameter2f, w.number, 0, 0),
    WRONG(VALUE, Outside, rtParameter2f, 2, nan, 0),
    WRONG(PARAMETER, Outside, rtParameter3f, w.number, 0, 0, 0),
    WRONG(VALUE, Outside, rtParameter3f, 3, 0, 0, inf),
    WRONG(PARAMETER, Outside, rtParameter4f, w.number, 0, 0, 0, 0),
    WRONG(VALUE, Outside, rtParameter4f, 4, 0, nan, 0, 0),
    WRONG(PARAMETER, Outside, rtParameter16f, w.number, identityF),
    WRONG(VALUE, Outside, rtParameter16f, 6, nullptr),
    WRONG(VALUE, Outside, rtParameter16f, 6, notFiniteF),
    WRONG(PARAMETER, Outside, rtParameterfv, w.number, 1, three),
    WRONG(VALUE, Outside, rtParameterfv, w.list, 1, nullptr),
    WRONG(VALUE, Outside, rtParameterfv, w.list, SIZE_MAX, three),
    WRONG(VALUE, Outside, rtParameterfv, w.list, 4, three), // a value out of its range
    WRONG(PARAMETER, Outside, rtParameterString, w.number, ""),
    WRONG(VALUE, Outside, rtParameterString, w.text, nullptr),
    WRONG(PARAMETER, Outside, rtParameterTexture, w.number, 0),
    WRONG(ID, Outside, rtParameterTexture, w.image, foreign),
    WRONG(ID, Outside, rtParameterTexture, w.image, w.object),
    WRONG(VALUE, List, rtParameter3f, w.color, 2, 0, 0),
    WRONG(VALUE, List, rtParameter3f, w.color, nan, 0, 0),
    WRONG(PARAMETER, List, rtParameter2f, w.color, 0, 0),
    WRONG(OPERATION, List, rtParameter1f, w.whole, 0), // belongs to the whole shader
    WRONG(OPERATION, List, rtParameter1i, 0, 0), WRONG(PARAMETER, List, rtParameter1f, 99, 0),
    // Belongs to the whole shader.
    WRONG(OPERATION, Outside, rtParameterPointer, w.number, 0, three),
    WRONG(PARAMETER, Outside, rtParameterPointer, -1, 0, three),
    WRONG(PARAMETER, Outside, rtParameterPointer, w.count, 0, three),
    WRONG(OPERATION, List, rtParameterPointer, w.color, 0, three),
    WRONG(OPERATION, Definition, rtReloadShaders),
    WRONG(ID, Outside, rtGetShaderClass, foreign, nullptr, nullptr),
    WRONG(ID, Outside, rtGetParameterInfo, foreign, 0, &info),
    WRONG(PARAMETER, Outside, rtGetParameterInfo, w.surfaceClass, 10, &info),
    WRONG(VALUE, Outside, rtGetParameterInfo, w.surfaceClass, 0, nullptr),
    // Roles.
    WRONG(ID, Outside, rtUseLight, 0), WRONG(OPERATION, Outside, rtUseLight, w.surface),
    WRONG(OPERATION, Definition, rtUseLight, w.lamp),
    WRONG(ID, Outside, rtLightMatrix, foreign, identity),
    WRONG(VALUE, Outside, rtLightMatrix, w.light, nullptr),
    WRONG(VALUE, Outside, rtLightMatrix, w.light, notFinite),
    WRONG(ID, Outside, rtLightScope, foreign, 0),
    WRONG(ID, Outside, rtLightScope, w.light, foreign), WRONG(ID, Outside, rtRemoveLight, 0),
    WRONG(ID, Outside, rtRemoveLight, w.instance),
    WRONG(OPERATION, Outside, rtUseCamera, w.surface), WRONG(ID, Outside, rtUseCamera, foreign),
    WRONG(OPERATION, Definition, rtUseCamera, w.eye),
    WRONG(OPERATION, Outside, rtUseEnvironment, w.surface),
    WRONG(OPERATION, Definition, rtUseEnvironment, w.sky),
    WRONG(OPERATION, Outside, rtUseTransport, w.surface),
    WRONG(ID, Outside, rtUseTransport, foreign), WRONG(OPERATION, Outside, rtDefaultShader, w.lamp),
    WRONG(ID, Outside, rtDefaultShader, foreign), WRONG(VALUE, Outside, rtPerspective, 0),
    WRONG(VALUE, Outside, rtPerspective, 180), WRONG(OPERATION, Definition, rtPerspective, 40),
    WRONG(VALUE, Outside, rtOrtho, -1), WRONG(VALUE, Outside, rtOrtho, double(inf)),
    WRONG(OPERATION, Definition, rtOrtho, 1),
    // Textures; none is bound.
    WRONG(VALUE, Outside, rtGenTextures, 1, nullptr), WRONG(ID, Outside, rtDeleteTexture, 0),
    WRONG(ID, Outside, rtDeleteTexture, w.object), WRONG(ID, Outside, rtBindTexture, foreign),
    WRONG(OPERATION, Outside, rtTexImage2D, 1, 1, 1, RT_UNSIGNED_BYTE, bytes),
    WRONG(OPERATION, Outside, rtTexImage3D, 1, 1, 1, 1, RT_UNSIGNED_BYTE, bytes),
    WRONG(OPERATION, Outside, rtTexParameteri, RT_TEXTURE_SRGB, 1),
    WRONG(OPERATION, Outside, rtTexParameterfv, RT_TEXTURE_BORDER_COLOR, colour),
    // Frames and queries.
    WRONG(VALUE, Outside, rtFrameBuffer, 0, 1, RT_RGBA),
    WRONG(VALUE, Outside, rtScissor, -1, 0, 1, 1), WRONG(VALUE, Outside, rtUniteNames, nullptr, 1),
    WRONG(VALUE, Outside, rtFrameBuffer, 65537, 1, RT_RGBA),
    WRONG(VALUE, Outside, rtFrameBuffer, 65536, 65536, RT_RGBA),
    WRONG(VALUE, Outside, rtFrameBuffer, 1, 1, 0),
    WRONG(VALUE, Outside, rtFrameBuffer, 1, 1, 1u << 31), WRONG(ENUM, Outside, rtQuality, 0, 0),
    WRONG(ENUM, Outside, rtQuality, RT_CLAMP, 0),
    WRONG(VALUE, Outside, rtQuality, RT_SAMPLES_PER_PIXEL, 0),
    WRONG(VALUE, Outside, rtQuality, RT_MAX_DEPTH, -1),
    WRONG(VALUE, Outside, rtQuality, RT_SHADOWS, 2),
    WRONG(VALUE, Outside, rtQuality, RT_TRANSPORT, int(std::size(transports))),
    WRONG(VALUE, Outside, rtQuality, RT_REPLICATES, 1025),
    WRONG(VALUE, Outside, rtQuality, RT_PROGRESSIVE, 2),
    WRONG(VALUE, Outside, rtQuality, RT_FRAMES_IN_FLIGHT, 0),
    WRONG(VALUE, Outside, rtQuality, RT_FRAMES_IN_FLIGHT, 65),
    WRONG(VALUE, Outside, rtQuality, RT_TILE_SIZE, 3),
    WRONG(VALUE, Outside, rtQuality, RT_TILE_SIZE, 129),
    WRONG(VALUE, Outside, rtQuality, RT_FOLLOW_IMAGES, 2),
    WRONG(ENUM, Outside, rtQualityf, RT_SEED, 0),
    WRONG(VALUE, Outside, rtQualityf, RT_TARGET_ERROR, 1.5),
    WRONG(VALUE, Outside, rtQualityf, RT_PATIENCE, -1),
    WRONG(VALUE, Outside, rtQualityf, RT_TIME_LIMIT, -1),
    WRONG(VALUE, Outside, rtQualityf, RT_ENERGY_CUT, double(nan)),
    WRONG(VALUE, Outside, rtQualityf, RT_CLAMP, double(inf)),
    WRONG(ENUM, Outside, rtReadPixels, 3, floats, 64),
    WRONG(OPERATION, Outside, rtReadPixels, RT_DEPTH, floats, 64),
    WRONG(VALUE, Outside, rtReadPixels, RT_RGBA, nullptr, 64),
    WRONG(VALUE, Outside, rtReadPixels, RT_RGBA, floats, 31),
    WRONG(VALUE, Outside, rtGetStats, nullptr),
    WRONG(VALUE, Outside, rtGetStats, (statistics.size = 0, &statistics)),
    WRONG(VALUE, Outside, rtPick, double(nan), 0, &hit),
    WRONG(VALUE, Outside, rtPick, 0, 0, nullptr),
    WRONG(VALUE, Outside, rtCastRays, 1, nullptr, &hit),
    WRONG(VALUE, Outside, rtCastRays, 1, &ray, nullptr),
    WRONG(VALUE, Outside, rtOccludedRays, 1, &ray, nullptr),
    WRONG(VALUE, Outside, rtCountHits, 1, &ray, nullptr),
    WRONG(VALUE, Outside, rtListHits, 1, &ray, nullptr, &hit),
    WRONG(VALUE, Outside, rtCastRaysd, 1, nullptr, &hitd),
    WRONG(VALUE, Outside, rtCastRaysd, 1, &rayd, nullptr),
    WRONG(VALUE, Outside, rtOccludedRaysd, 1, &rayd, nullptr),
    WRONG(VALUE, Outside, rtCountHitsd, 1, &rayd, nullptr),
    WRONG(VALUE, Outside, rtListHitsd, 1, &rayd, nullptr, &hitd),
    WRONG(VALUE, Outside, rtListHitsd, 1, &rayd, fallingPlaces, &hitd),
    WRONG(VALUE, Outside, rtClosestPoints, 1, floats, 0, &closest),
    WRONG(VALUE, Outside, rtClosestPointsd, 1, doubles, 0, &hitd),
    // Contexts.
    WRONG(VALUE, Outside, rtNewContext, "nonsense"),
    WRONG(VALUE, Outside, rtNewContext, "backend=debug:nothing"),
    WRONG(VALUE, Outside, rtMakeCurrent, reinterpret_cast<RTcontext>(&ids)),
    WRONG(VALUE, Outside, rtDeleteContext, reinterpret_cast<RTcontext>(&ids)),
    WRONG(VALUE, Outside, rtCancel, nullptr),
    WRONG(VALUE, Outside, rtProgress, reinterpret_cast<RTcontext>(&ids)),
    WRONG(VALUE, Outside, rtSnapshot, nullptr, RT_RGBA, floats, 64),
    WRONG(VALUE, Outside, rtGetWorkers, nullptr, nullptr, 0),
    WRONG(VALUE, Outside, rtGetWorkers, rtGetCurrent(), nullptr, 1),
    WRONG(VALUE, Outside, rtGetWorkers, rtGetCurrent(), (worker.size = 0, &worker), 1),
    WRONG(VALUE, Outside, rtSnapshot, w.context, RT_RGBA, nullptr, 64),
    WRONG(OPERATION, Outside, rtExit), // without rtInit
};
// Functions that fail only without a context, or never.
const char* const infallible[] = {"rtErrorCallback",    "rtLogCallback",      "rtLoadName",
                                  "rtPushMatrix",       "rtLoadIdentity",     "rtGetError",
                                  "rtGetCurrent",       "rtGetErrorMessage",  "rtInit",
                                  "rtRunningShader",    "rtFinishFrame",      "rtGetQualityInfo",
                                  "rtIsQualityAllowed", "rtGetTransportInfo", "rtGetChannelInfo"};

class EveryCall : public ApiTest {
 protected:
  void SetUp() override {
    ApiTest::SetUp();
    w.context = handle;
    w.object = triangleObject();
    w.instance = rtInstantiateObject(w.object);
    const auto make = [](const char* name, const char* library) {
      return rtNewShader(rtNewShaderClass(name, library));
    };
    w.surfaceClass = rtNewShaderClass("Everything", "everything");
    w.lamp = make("Lamp", "everything");
    w.eye = make("Eye", "everything");
    w.sky = make("Sky", "everything");
    w.varying = make("Varying", "varying");
    w.surface = make("Everything", "everything");
    w.light = rtUseLight(w.lamp);
    rtUseCamera(w.eye);
    rtGenTextures(1, &w.texture);
    rtBindShader(w.varying);
    w.whole = rtParameterHandle("whole");
    w.color = rtParameterHandle("color");
    rtBindShader(w.surface);
    w.count = rtParameterHandle("count");
    w.number = rtParameterHandle("strength");
    w.list = rtParameterHandle("list");
    w.text = rtParameterHandle("text");
    w.image = rtParameterHandle("texture");
    commit();
  }
  World w;
};

TEST_F(EveryCall, FailsWithoutAContext) {
  rtMakeCurrent(nullptr);
  for (const Named& each : needContext) {
    each.call(w);
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_OPERATION)) << each.name;
    EXPECT_EQ(std::string(rtGetErrorMessage()),
              std::string(each.name) + ": no context is current on this thread");
  }
  rtMakeCurrent(handle);
  EXPECT_TRUE(commit().edits.edits.empty());
}

TEST_F(EveryCall, WrongArgumentsAndStatesAreErrorsThatChangeNothing) {
  for (size_t i = 0; i < std::size(wrong); i++) {
    const Wrong& each = wrong[i];
    SCOPED_TRACE(std::string(each.name) + ", line " + std::to_string(i) + " of the table");
    RTid object = 0;
    if (each.state != Outside) object = rtBeginObject(0);
    if (each.state == List) {
      rtBindShader(w.varying);
      rtBegin(RT_TRIANGLES);
      rtVertex3f(0, 0, 0);
    }
    std::vector<double> before = currentMatrix();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    each.call(w);
    const RTenum code = rtGetError();
    const std::string text = rtGetErrorMessage();
    EXPECT_EQ(code, each.code) << text;
    EXPECT_TRUE(text.starts_with(std::string(each.name) + ": ") &&
                text.size() > std::string(each.name).size() + 4)
        << text;
    EXPECT_EQ(rtGetCurrent(), handle);
    EXPECT_EQ(currentMatrix(), before);
    if (each.state == List) {
      rtVertex3f(1, 0, 0);
      rtVertex3f(0, 1, 0);
      rtEnd();
      rtBindShader(w.surface);
    }
    if (each.state != Outside) {
      rtEndObject();
      const Commit& c = commit(); // the definition as it would be without the call
      const auto& geometries = edits<edit::ObjectT>(c).at(0)->geometries;
      EXPECT_EQ(geometries.size(), each.state == List ? 1u : 0u);
      for (const auto& g : geometries) {
        EXPECT_EQ(contents<float>(c, g->points), (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
        EXPECT_TRUE(g->normals == 0 && g->texCoords == 0 && g->colors == 0 &&
                    g->parameters.empty());
      }
      rtDeleteObject(object);
    }
    const Commit& after = commit();
    EXPECT_EQ(after.edits.edits.size(), each.state == Outside ? 0u : 1u); // only the deletion
  }
}

TEST_F(EveryCall, TheFirstErrorSticksAndTheCallbackHearsAll) {
  std::vector<std::string> heard;
  rtErrorCallback(
      [](RTenum, const char* text, void* user) {
        static_cast<std::vector<std::string>*>(user)->emplace_back(text);
      },
      &heard);
  rtEnd();
  rtDeleteObject(foreign);
  rtNewShader(foreign);
  EXPECT_EQ(heard.size(), 3u);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_OPERATION));
  EXPECT_EQ(std::string(rtGetErrorMessage()), heard.at(0));
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  rtErrorCallback(nullptr, nullptr);
}

// Tests run in the root of the repository.
TEST(EveryCallTables, HoldEveryFunctionOfTheHeader) {
  std::string header;
  for (const char* part : {"context", "geometry", "shader", "frame", "worker", "query"}) {
    std::ifstream file(std::string("libopenrt/include/openrt/") + part + ".h");
    ASSERT_TRUE(file) << part << ".h: not in the repository's root";
    header.append(std::istreambuf_iterator<char>(file), {});
  }
  std::set<std::string> declared, listed(std::begin(anywhere), std::end(anywhere)),
      failing(std::begin(infallible), std::end(infallible));
  const std::regex declaration("RT_API [^;(]*\\b(rt[A-Z]\\w*)\\(");
  for (std::sregex_iterator it(header.begin(), header.end(), declaration), end; it != end; ++it)
    declared.insert((*it)[1]);
  for (const Named& each : needContext)
    EXPECT_TRUE(listed.insert(each.name).second) << each.name << " is listed twice";
  for (const Wrong& each : wrong) failing.insert(each.name);
  EXPECT_GT(declared.size(), 100u);
  EXPECT_EQ(listed, declared);
  EXPECT_EQ(failing, declared);
}

} // namespace
