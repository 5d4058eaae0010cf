/* shader.h: shaders, their parameters and roles, textures (OpenRT, C99). openrt.h states the
 * conventions. openrts.h is the SDK for those who write shaders.
 */
#ifndef OPENRT_SHADER_H
#define OPENRT_SHADER_H

#include "openrt/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Shaders -------------------------------------------------------------------------------------- */

/* Returns a shader class: a stock one (library NULL) or one of a plug-in library. library is a bare
 * name, which is looked up in the configured shader folders. [context-thread] */
RT_API RTid rtNewShaderClass(const char* name, const char* library);
/* Makes a shader of a class, with parameters of its own at their defaults. [context-thread] */
RT_API RTid rtNewShader(RTid shaderClass);
/* Binds a shader: the primitives that follow latch it, and rtParameter* sets its parameters. 0
 * binds the default surface shader. [context-thread] */
RT_API void rtBindShader(RTid shader);
/* Deletes a shader with the next commit. Geometry bound to it then has the default surface shader,
 * overrides by it end, its lights go out, and a camera, environment or default made of it is
 * removed. [context-thread] */
RT_API void rtDeleteShader(RTid shader);

/* Returns the handle of a parameter of the bound shader's class, which is valid for every shader of
 * the class; -1 if there is no such parameter. [context-thread] */
RT_API int rtParameterHandle(const char* name);
/* Set a parameter of the bound shader. rtParameterfv sets a list of count floats (a parameter of
 * type RT_PARAM_FLOATS).
 *
 * A class may declare parameters per triangle or per vertex (RTparameterInfo.frequency). Between
 * rtBegin and rtEnd these calls set such a parameter for the triangles or vertices of this object
 * that follow; handles then belong to the class of the latched shader. The shader's own value holds
 * until the first such call and outside of rtBegin ... rtEnd. A triangle takes the value of the
 * vertex that completes it. [context-thread] */
RT_API void rtParameter1i(int handle, int value);
RT_API void rtParameter1f(int handle, float x);
RT_API void rtParameter2f(int handle, float x, float y);
RT_API void rtParameter3f(int handle, float x, float y, float z);
RT_API void rtParameter4f(int handle, float x, float y, float z, float w);
RT_API void rtParameter16f(int handle, const float m[16]);
RT_API void rtParameterfv(int handle, size_t count, const float* values);
RT_API void rtParameterString(int handle, const char* utf8);
RT_API void rtParameterTexture(int handle, RTid texture);
/* Sets the values of a parameter per vertex (RT_PER_TRIANGLE: per triangle of the call) for
 * rtDrawArrays and rtDrawElements. They hold while a shader of the bound shader's class is bound.
 * stride is in bytes, 0 means tightly packed. NULL turns the array off. [context-thread] */
RT_API void rtParameterPointer(int handle, size_t stride, const float* pointer);
/* Loads libraries of shader classes again whose files have changed, and returns how many. Shaders
 * keep parameters whose names and types are still declared. A library that does not load, or that
 * has lost a class in use, is RT_PLUGIN_ERROR and stays as it was. [context-thread] */
RT_API int rtReloadShaders(void);
/* Returns "CLASS of LIBRARY" if a shader function runs on this thread at this moment, else NULL. It
 * serves handlers of crashes and is async-signal-safe. [any-thread] */
RT_API const char* rtRunningShader(void);

enum { RT_SURFACE = 1, RT_LIGHT = 2, RT_CAMERA = 3, RT_ENVIRONMENT = 4, RT_TRANSPORT_SHADER = 5 };
enum { RT_PER_SHADER = 0, RT_PER_TRIANGLE = 1, RT_PER_VERTEX = 2 };
enum {
  RT_PARAM_INT = 1,
  RT_PARAM_FLOAT,
  RT_PARAM_VEC2,
  RT_PARAM_VEC3,
  RT_PARAM_VEC4,
  RT_PARAM_COLOR,
  RT_PARAM_MATRIX,
  RT_PARAM_FLOATS,
  RT_PARAM_STRING,
  RT_PARAM_TEXTURE
};
/* A parameter of a class. The library owns the texts; they are valid as long as the class. */
typedef struct RTparameterInfo {
  const char* name; /* "" if a library that was loaded again no longer declares the parameter */
  RTenum type;      /* RT_PARAM_* */
  float defaultValue[16];
  float minimum, maximum; /* the range, inclusive; -FLT_MAX and FLT_MAX if it has no bound */
  const char* text;       /* a description for people */
  RTenum frequency;       /* RT_PER_*: whether it may differ between triangles or vertices */
} RTparameterInfo;
/* Writes the kind (RT_SURFACE ...) and the number of parameters of a class. Either pointer may be
 * NULL. [context-thread] */
RT_API void rtGetShaderClass(RTid shaderClass, RTenum* kind, int* parameters);
/* Writes what the class declares about a parameter. [context-thread] */
RT_API void rtGetParameterInfo(RTid shaderClass, int handle, RTparameterInfo* info);

/* Roles: the current matrix becomes the local-to-world matrix of the role ---------------------- */

/* Turns a light shader on and returns the light's id. [context-thread] */
RT_API RTid rtUseLight(RTid shader);
/* Moves a light. [context-thread] */
RT_API void rtLightMatrix(RTid light, const double m[16]);
/* Restricts a light to what lies below an instance. It lights nothing after the instance has been
 * deleted. 0 (default): it lights everything. [context-thread] */
RT_API void rtLightScope(RTid light, RTid instance);
/* Turns a light off and deletes it. [context-thread] */
RT_API void rtRemoveLight(RTid light);
/* Sets the one camera. It looks along -z of its local frame, with +y up. 0 removes it.
 * [context-thread] */
RT_API void rtUseCamera(RTid shader);
/* Sets the environment: what rays see that hit nothing, and the medium that the camera is in. 0
 * removes it. [context-thread] */
RT_API void rtUseEnvironment(RTid shader);
/* Sets a transport shader, which follows light instead of RT_TRANSPORT; 0 removes it.
 * [context-thread] */
RT_API void rtUseTransport(RTid shader);
/* Sets the surface shader of geometry that has none. 0: the stock class VRML97 with its defaults.
 * [context-thread] */
RT_API void rtDefaultShader(RTid shader);
/* Multiplies the current matrix by the camera-to-world matrix of gluLookAt's arguments, for
 * rtUseCamera. [context-thread] */
RT_API void rtLookAt(double eyeX, double eyeY, double eyeZ, double atX, double atY, double atZ,
                     double upX, double upY, double upZ);
/* Uses the stock perspective camera under the current matrix. The vertical field of view is in
 * degrees, 0 < f < 180. [context-thread] */
RT_API void rtPerspective(double fovyDegrees);
/* Uses the stock orthographic camera under the current matrix. height is the height of the view in
 * world units. [context-thread] */
RT_API void rtOrtho(double height);

/* Textures ------------------------------------------------------------------------------------- */

enum {
  RT_REPEAT = 0x2901,
  RT_MIRRORED_REPEAT = 0x8370,
  RT_CLAMP_TO_EDGE = 0x812F,
  RT_CLAMP_TO_BORDER = 0x812D,
  RT_NEAREST = 0x2600,
  RT_LINEAR = 0x2601
};
enum {
  RT_TEXTURE_MAG_FILTER = 0x2800,
  RT_TEXTURE_WRAP_S = 0x2802,
  RT_TEXTURE_WRAP_T = 0x2803,
  RT_TEXTURE_WRAP_R = 0x8072,
  RT_TEXTURE_SRGB = 0x8C40,
  RT_TEXTURE_BORDER_COLOR = 0x1004
};
/* Make count textures and write their ids, delete one, and bind one for the calls below.
 * [context-thread] */
RT_API void rtGenTextures(size_t count, RTid* ids);
RT_API void rtDeleteTexture(RTid texture);
RT_API void rtBindTexture(RTid texture);
/* Sets the image of the bound texture. [context-thread]
 *  - components: 1 (grey), 2 (grey, alpha), 3 (rgb) or 4 (rgba).
 *  - type: RT_UNSIGNED_BYTE (0 .. 255 stands for 0 .. 1) or RT_FLOAT.
 *  - pixels: rows from the bottom (t = 0) up, tightly packed. */
RT_API void rtTexImage2D(int components, int width, int height, RTenum type, const void* pixels);
/* Sets the image of the bound texture to a volume: depth slices, each as rtTexImage2D has it, from
 * r = 0 on. A side has 1 to 65536 texels, and all together are at most 2^28. Surfaces of the
 * classes X3DMaterial and Physical look it up at (s, t, r), the shader's function sampleVolume of
 * openrts.h; everything else sees the first slice. [context-thread] */
RT_API void rtTexImage3D(int components, int width, int height, int depth, RTenum type,
                         const void* pixels);
/* Sets a property of the bound texture. [context-thread]
 *  - RT_TEXTURE_WRAP_S, RT_TEXTURE_WRAP_T, RT_TEXTURE_WRAP_R: RT_REPEAT (default),
 * RT_MIRRORED_REPEAT (every other copy is mirrored), RT_CLAMP_TO_EDGE (the edge goes on) or
 * RT_CLAMP_TO_BORDER (beyond the edges is the border).
 *  - RT_TEXTURE_MAG_FILTER: RT_LINEAR (default) or RT_NEAREST.
 *  - RT_TEXTURE_SRGB: 1 if bytes are sRGB-encoded (colours are decoded, alpha is not); 0 (default)
 *    if they are linear. */
RT_API void rtTexParameteri(RTenum name, int value);
/* Sets a property of the bound texture that is a colour. [context-thread]
 *  - RT_TEXTURE_BORDER_COLOR: linear rgba of 0 to 1, which RT_CLAMP_TO_BORDER shows; default
 *    0 0 0 0. The red of the border of a grey texture counts; without alpha the border is
 *    opaque. */
RT_API void rtTexParameterfv(RTenum name, const float rgba[4]);

#ifdef __cplusplus
}
#endif
#endif
