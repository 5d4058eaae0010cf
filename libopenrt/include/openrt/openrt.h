/* openrt.h: the OpenRT application programming interface (C99).
 *
 * A ray tracing API in OpenGL's manner. One context holds one scene; a context is current per
 * thread. Objects, instances, shaders, textures and lights are named by non-zero ids and persist
 * until they are deleted. Edits gather in the pending scene; rtSwapBuffers and rtRender commit all
 * of them at once.
 *
 * Conventions
 *  - right-handed coordinates, column-major 4x4 matrices acting on column vectors, angles in
 * degrees, colours linear;
 *  - arrays handed over are copied before the call returns;
 *  - a call that fails changes nothing and records an error (see rtGetError); calls that return an
 * id then return 0;
 *  - thread tag of every function below: [app], any thread on which the context is current, one
 * thread at a time.
 */
#ifndef OPENRT_OPENRT_H
#define OPENRT_OPENRT_H

#include <stddef.h>
#include <stdint.h>

#define OPENRT_VERSION_MAJOR 0
#define OPENRT_VERSION_MINOR 1
#define OPENRT_VERSION_PATCH 0

#if defined(_WIN32)
#define RT_API __declspec(dllexport)
#else
#define RT_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef uint32_t
    RTid; /* names an object, instance, shader class, shader, texture or light; 0 is none */
typedef uint32_t RTenum; /* one of the enumerations below */
typedef struct RTcontext_* RTcontext;

/* Errors
 * ------------------------------------------------------------------------------------------------------------
 */

enum {
  RT_NO_ERROR = 0,
  RT_INVALID_ENUM = 0x0500,
  RT_INVALID_VALUE =
      0x0501, /* NaN, infinite, negative where positive is needed, index out of range */
  RT_INVALID_OPERATION =
      0x0502, /* not allowed in this state: unbalanced brackets, no context, wrong kind */
  RT_STACK_OVERFLOW = 0x0503,
  RT_STACK_UNDERFLOW = 0x0504,
  RT_OUT_OF_MEMORY = 0x0505,
  RT_INVALID_ID =
      0x0510, /* an id that was never made, was deleted, or names another kind of thing */
  RT_INVALID_PARAMETER =
      0x0511, /* a shader parameter that its class does not declare, or of another type */
  RT_PLUGIN_ERROR = 0x0512, /* a shader library missing, unreadable or of another ABI */
  RT_IO_ERROR = 0x0513,     /* a recording that cannot be written */
  RT_CLUSTER_ERROR =
      0x0514 /* backend=cluster: too few workers (require=N), no usable address or key */
};

typedef void (*RTerrorCallback)(RTenum error, const char* message, void* user);
typedef void (*RTlogCallback)(int level, const char* message,
                              void* user); /* level: 0 debug, 1 info, 2 warning, 3 error */

/* Returns the first error since the last call and clears it. Works without a context (errors of
 * rtNewContext). */
RT_API RTenum rtGetError(void);
/* The text of the error that the last rtGetError returned. Owned by the library, valid until the
 * next rt call of this thread. */
RT_API const char* rtGetErrorMessage(void);
/* Called at once on every error of the current context. NULL removes it. */
RT_API void rtErrorCallback(RTerrorCallback callback, void* user);
/* Receives the library's messages; without one the library is silent. */
RT_API void rtLogCallback(RTlogCallback callback, void* user);

/* Life
 * --------------------------------------------------------------------------------------------------------------
 */

/* Makes a context and makes it current. config: blank-separated key=value pairs, or NULL.
 *   backend=local|null|record|cluster
 *                               who renders (default local); debug:NAME: the same, and misuse is
 * explained to rtLogCallback threads=N                   render threads; 0 (default): as many as
 * the process may use file=PATH                   the recording to write (backend=record); a value
 * with blanks stands in "double quotes" record=PATH                 a recording written while
 * another backend renders; openrt-replay makes the same bytes of it shaderpath=DIR[:DIR...] where
 * shader libraries are looked up, before $OPENRT_SHADER_PATH and the installed folder With
 * backend=cluster, openrt-workers on other machines render, too; pictures are the same bytes
 * whoever does, and whoever joins, is slow or lost meanwhile. Beside these: workers=HOST[:PORT],...
 * workers to call (port 7447 where none is said; HOST:PORT=PUBLICKEY where theirs is another key);
 *                               @FILE: those that a file lists, one a line
 *   listen=ADDRESS[:PORT]       where workers call in (openrt-worker --connect)
 *   key=FILE                    the key file (openrt-worker --new-key FILE); needed for addresses
 * other than loopback allow=FILE                  public keys that are let in beside one's own, one
 * a line local=N                     threads of this process that render, too; 0: none as long as a
 * worker lives; default: threads=N split=auto|tiles|samples|frames  what the work is cut into
 * (default auto) require=N                   a frame waits while there are fewer than N workers,
 * and fails with RT_CLUSTER_ERROR after 10 seconds; default 0: this process finishes alone, and
 * says so in the log tolerant=1                  workers of another instruction set or version are
 * taken; last bits may differ then Returns NULL on failure. Delete it with rtDeleteContext. */
RT_API RTcontext rtNewContext(const char* config);
/* Makes a context current on this thread; NULL makes none current. */
RT_API void rtMakeCurrent(RTcontext context);
RT_API RTcontext rtGetCurrent(void);
/* Ends a context and its frame in flight; frees all in it. NULL is allowed. RT_IO_ERROR: the
 * recording is not whole. */
RT_API void rtDeleteContext(RTcontext context);
/* Make and end a default context. Options of the form --rt-KEY=VALUE are taken out of argv into its
 * configuration. */
RT_API void rtInit(int* argc, char** argv);
RT_API void rtExit(void);

/* Primitives: inside rtBeginObject ... rtEndObject
 * ------------------------------------------------------------------ */

/* GL's numbers */
enum {
  RT_POINTS = 0x0000,
  RT_LINES = 0x0001,
  RT_LINE_STRIP = 0x0003,
  RT_TRIANGLES = 0x0004,
  RT_TRIANGLE_STRIP = 0x0005,
  RT_TRIANGLE_FAN = 0x0006,
  RT_QUADS = 0x0007,
  RT_QUAD_STRIP = 0x0008,
  RT_POLYGON = 0x0009 /* convex */
};

/* rtBegin opens, rtEnd closes a list of vertices of one mode. Normal, texture coordinate, colour,
 * shader, name and the matrix are latched: the shader, the name and the matrix at rtBegin, the
 * others at each vertex. An object begins without normals, texture coordinates and colours:
 * vertices have those that were set since rtBeginObject; a normal of 0 0 0 stands for the face's
 * own. Positions in double keep their precision wherever they lie (up to 1e38). Degenerate
 * primitives are dropped and counted (RTstats.degenerate). */
RT_API void rtBegin(RTenum mode);
RT_API void rtEnd(void);
RT_API void rtVertex2f(float x, float y);
RT_API void rtVertex3f(float x, float y, float z);
RT_API void rtVertex3fv(const float* v);
RT_API void rtVertex3d(double x, double y, double z);
RT_API void rtVertex3dv(const double* v);
RT_API void rtNormal3f(float x, float y, float z);
RT_API void rtNormal3fv(const float* v);
RT_API void rtTexCoord2f(float s, float t);
RT_API void rtTexCoord2fv(const float* v);
RT_API void rtColor3f(float r, float g, float b);
RT_API void rtColor3fv(const float* v);
RT_API void rtColor4f(float r, float g, float b, float a);
RT_API void rtColor4fv(const float* v);

/* Width of lines and diameter of points in pixels as seen by the camera (default 1, range > 0).
 * Latched at rtBegin. */
RT_API void rtLineWidth(float pixels);
RT_API void rtPointSize(float pixels);

enum {
  RT_CULL_FACE =
      0x0B44, /* back faces are not there, for rays of any kind but shadow rays (default off) */
  RT_CW_FRONT = 0x0B46 /* clockwise vertices face the viewer (default off: counter-clockwise) */
};
/* Latched at rtBegin and by arrays and analytic shapes. */
RT_API void rtEnable(RTenum capability);
RT_API void rtDisable(RTenum capability);

/* A number given to the following primitives; the id channel and ray queries report it (as GL's
 * selection names). Default 0. Latched by instances too: a primitive whose own name is 0 has the
 * name of the innermost instance that has one. */
RT_API void rtLoadName(uint32_t name);

/* An exact sphere of the given radius (> 0) about the current origin. Texture coordinates run as on
 * VRML's Sphere: s from the back (-z) counter-clockwise seen from above, t from the bottom to the
 * top. */
RT_API void rtSphere(float radius);

/* Arrays: the bulk path
 * ---------------------------------------------------------------------------------------------- */

enum { RT_FLOAT = 0x1406, RT_DOUBLE = 0x140A, RT_UNSIGNED_BYTE = 0x1401, RT_UNSIGNED_INT = 0x1405 };

/* Source of an attribute for rtDrawArrays and rtDrawElements. size: components (vertex 3; normal 3;
 * texture 2; colour 3 or 4); type: RT_FLOAT, for vertices also RT_DOUBLE; stride: bytes between
 * elements, 0 for tightly packed; NULL turns the array off. The pointer is read by the draw calls
 * and must stay valid until the last of them. */
RT_API void rtVertexPointer(int size, RTenum type, size_t stride, const void* pointer);
RT_API void rtNormalPointer(RTenum type, size_t stride, const void* pointer);
RT_API void rtTexCoordPointer(int size, RTenum type, size_t stride, const void* pointer);
RT_API void rtColorPointer(int size, RTenum type, size_t stride, const void* pointer);
/* Draw count vertices from element first on. */
RT_API void rtDrawArrays(RTenum mode, size_t first, size_t count);
/* Draw count vertices by 32-bit indices. vertexCount: elements in the arrays; an index beyond it is
 * RT_INVALID_VALUE. */
RT_API void rtDrawElements(RTenum mode, size_t count, const uint32_t* indices, size_t vertexCount);

/* Matrices: composed in double
 * ---------------------------------------------------------------------------------------- */

/* The stack holds 4096 matrices; an object's definition has one of its own. Matrices are affine:
 * bottom row 0 0 0 1. */
RT_API void rtPushMatrix(void);
RT_API void rtPopMatrix(void);
RT_API void rtLoadIdentity(void);
RT_API void rtLoadMatrixf(const float m[16]);
RT_API void rtLoadMatrixd(const double m[16]);
RT_API void rtMultMatrixf(const float m[16]);
RT_API void rtMultMatrixd(const double m[16]);
RT_API void rtTranslatef(float x, float y, float z);
RT_API void rtTranslated(double x, double y, double z);
RT_API void rtRotatef(float degrees, float x, float y, float z);
RT_API void rtRotated(double degrees, double x, double y, double z);
RT_API void rtScalef(float x, float y, float z);
RT_API void rtScaled(double x, double y, double z);
RT_API void rtGetMatrixd(double m[16]);

/* Objects and instances
 * -----------------------------------------------------------------------------------------------
 */

/* Writes count fresh object ids, empty objects. */
RT_API void rtGenObjects(size_t count, RTid* ids);
/* Opens the definition of an object (a new one if id is 0) and returns its id. The matrix stack
 * starts at the identity. Redefining replaces it in every instance. Definitions do not nest;
 * objects instantiate each other. */
RT_API RTid rtBeginObject(RTid id);
RT_API void rtEndObject(void);
/* Instances of it vanish with it. */
RT_API void rtDeleteObject(RTid object);

/* Places an object under the current matrix: in the scene, or in the object being defined. An
 * object that would contain itself is RT_INVALID_OPERATION. A singular matrix is allowed and draws
 * nothing. Returns the instance's id. */
RT_API RTid rtInstantiateObject(RTid object);
RT_API void rtDeleteInstance(RTid instance);
RT_API void rtInstanceMatrix(RTid instance, const double m[16]);
RT_API void rtInstanceVisible(RTid instance, int visible);
/* The shader used for everything below this instance instead of its own; 0 removes the override. */
RT_API void rtInstanceShader(RTid instance, RTid shader);
/* What to expect of an instance's matrix and visibility, or of an object's definition. RT_STATIC
 * (default): it stays as it is; changing it may cost as much as building the scene. RT_DYNAMIC: it
 * changes often; a change costs only that instance or that object and the top level, rays a little
 * more. The first rtInstanceMatrix, rtInstanceVisible or redefinition of something that has been
 * rendered makes it dynamic by itself. Pictures differ in the last bits between the two, by nothing
 * else. */
enum { RT_STATIC = 0x88E4, RT_DYNAMIC = 0x88E8 };
RT_API void rtInstanceHint(RTid instance, RTenum hint);
/* Holds from the object's next definition on. */
RT_API void rtObjectHint(RTid object, RTenum hint);
/* Reported by ray queries for hits below this instance (the innermost that is set); default 0. */
RT_API void rtInstanceUserData(RTid instance, uint64_t data);

/* Shaders
 * ----------------------------------------------------------------------------------------------------------------
 */

/* A class of the stock shaders (library NULL) or of a plug-in: a bare name, found in the configured
 * shader folders. */
RT_API RTid rtNewShaderClass(const char* name, const char* library);
/* An instance of a class with parameters of its own, at their defaults. */
RT_API RTid rtNewShader(RTid shaderClass);
/* Latched by the primitives that follow, and the target of rtParameter*. 0: the default surface
 * shader. */
RT_API void rtBindShader(RTid shader);
/* Geometry bound to it falls back to the default surface shader, overrides by it end, its lights go
 * out, and a camera, environment or default made of it is removed, all with the next commit. */
RT_API void rtDeleteShader(RTid shader);
/* Handle of a parameter of the bound shader's class, valid for every shader of the class. -1: no
 * such parameter. */
RT_API int rtParameterHandle(const char* name);
RT_API void rtParameter1i(int handle, int value);
RT_API void rtParameter1f(int handle, float x);
RT_API void rtParameter2f(int handle, float x, float y);
RT_API void rtParameter3f(int handle, float x, float y, float z);
RT_API void rtParameter4f(int handle, float x, float y, float z, float w);
RT_API void rtParameter16f(int handle, const float m[16]);
/* count floats for a parameter of type RT_PARAM_FLOATS (a list). */
RT_API void rtParameterfv(int handle, size_t count, const float* values);
RT_API void rtParameterString(int handle, const char* utf8);
RT_API void rtParameterTexture(int handle, RTid texture);
/* Parameters that a class declares per triangle or per vertex (RTparameterInfo.frequency): between
 * rtBegin and rtEnd the calls above set the value for the triangles or vertices that follow, of
 * this object alone; the latched shader's class is meant. Until the first such call, and outside,
 * the shader's own value holds; a triangle has that of the vertex that completes it. For arrays:
 * values by vertex (RT_PER_TRIANGLE: by triangle of the call) for rtDrawArrays and rtDrawElements
 * while a shader of the class of the bound one is bound; stride in bytes, 0 for tightly packed;
 * NULL turns it off. */
RT_API void rtParameterPointer(int handle, size_t stride, const float* pointer);
/* Loads the libraries of shader classes anew whose files have changed; returns how many. Shaders
 * keep the parameters whose names and types are still declared. A library that does not load, or
 * lost a class in use, is RT_PLUGIN_ERROR and stays as it was. */
RT_API int rtReloadShaders(void);
/* "CLASS of LIBRARY" whose function runs on this thread at this moment, or NULL: for handlers of
 * crashes. Async-signal-safe. */
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
typedef struct RTparameterInfo {
  const char* name; /* owned by the library, valid as long as the class; empty: gone since the
                       library was loaded anew */
  RTenum type;      /* RT_PARAM_* */
  float defaultValue[16];
  float minimum, maximum; /* inclusive; -FLT_MAX and FLT_MAX where there is none */
  const char* text;
  RTenum frequency; /* RT_PER_*: how often its value may change */
} RTparameterInfo;
/* Kind (RT_SURFACE ...) and number of parameters of a class; either pointer may be NULL. */
RT_API void rtGetShaderClass(RTid shaderClass, RTenum* kind, int* parameters);
RT_API void rtGetParameterInfo(RTid shaderClass, int handle, RTparameterInfo* info);

/* Roles: the current matrix at the call is the role's local-to-world matrix
 * ------------------------------------------- */

/* Turns a light shader on and returns the light's id. */
RT_API RTid rtUseLight(RTid shader);
RT_API void rtLightMatrix(RTid light, const double m[16]);
/* The light shines only on what lies below this instance, on nothing once that is deleted; 0: on
 * everything (default). */
RT_API void rtLightScope(RTid light, RTid instance);
RT_API void rtRemoveLight(RTid light);
/* The one camera. Its local frame looks down -z with +y up. 0 removes it. */
RT_API void rtUseCamera(RTid shader);
/* What rays see that hit nothing, and the medium between the camera and what it sees. 0 removes it.
 */
RT_API void rtUseEnvironment(RTid shader);
/* Who follows light: a transport shader instead of RT_TRANSPORT; 0 removes it. */
RT_API void rtUseTransport(RTid shader);
/* Surface shader of geometry that has none; 0: the stock class VRML97 with its defaults. */
RT_API void rtDefaultShader(RTid shader);
/* Multiply the current matrix by the camera-to-world matrix of gluLookAt's arguments (for
 * rtUseCamera). */
RT_API void rtLookAt(double eyeX, double eyeY, double eyeZ, double atX, double atY, double atZ,
                     double upX, double upY, double upZ);
/* Use the stock perspective camera under the current matrix. Vertical field of view in degrees, 0 <
 * f < 180. */
RT_API void rtPerspective(double fovyDegrees);
/* Use the stock orthographic camera under the current matrix: height of the view in world units. */
RT_API void rtOrtho(double height);

/* Textures
 * -------------------------------------------------------------------------------------------------------------
 */

enum { RT_REPEAT = 0x2901, RT_CLAMP_TO_EDGE = 0x812F, RT_NEAREST = 0x2600, RT_LINEAR = 0x2601 };
enum {
  RT_TEXTURE_MAG_FILTER = 0x2800,
  RT_TEXTURE_WRAP_S = 0x2802,
  RT_TEXTURE_WRAP_T = 0x2803,
  RT_TEXTURE_SRGB = 0x8C40
};
RT_API void rtGenTextures(size_t count, RTid* ids);
RT_API void rtDeleteTexture(RTid texture);
RT_API void rtBindTexture(RTid texture);
/* The bound texture's image: components 1 (grey), 2 (grey, alpha), 3 (rgb) or 4 (rgba); type
 * RT_UNSIGNED_BYTE (0..255 for 0..1) or RT_FLOAT; rows from the bottom (t = 0) up, tightly packed.
 */
RT_API void rtTexImage2D(int components, int width, int height, RTenum type, const void* pixels);
/* RT_TEXTURE_WRAP_S/T: RT_REPEAT (default) or RT_CLAMP_TO_EDGE; RT_TEXTURE_MAG_FILTER: RT_LINEAR
 * (default) or RT_NEAREST; RT_TEXTURE_SRGB: 1 if bytes are sRGB-encoded (colours are decoded, alpha
 * is not), 0 (default) if linear. */
RT_API void rtTexParameteri(RTenum name, int value);

/* Frames
 * ------------------------------------------------------------------------------------------------------------------
 */

/* Channels, or'ed; floats per pixel */
enum {
  RT_RGBA = 1,  /* 4: mean radiance, alpha (1 where the environment shows or a surface is opaque) */
  RT_DEPTH = 2, /* 1: distance along the view axis, infinite where nothing is hit; of the pixel's
                   first sample */
  RT_NORMAL =
      4, /* 3: mean world-space shading normal facing the camera, 0 0 0 where nothing is hit */
  RT_ALBEDO = 8,    /* 3: mean surface colour as the shader reports it */
  RT_POSITION = 16, /* 3: world-space position of the first sample's hit */
  RT_NAME = 32,     /* 1: name (rtLoadName) of the first sample's hit, 0 where nothing is hit */
  RT_SAMPLES = 64,  /* 1: samples taken */
  RT_VARIANCE =
      128, /* 3: sample variance of radiance (divide by the samples for the variance of the mean) */
  RT_ERROR = 256, /* 3: half-width of the 95 % interval of each colour, see below; infinite where
                     nothing is known */
  RT_TRUST = 512  /* 1: 1 where that interval can be trusted, else 0 */
};
enum {
  RT_SAMPLES_PER_PIXEL = 1, /* 1 .. 65536, default 16 */
  RT_MAX_DEPTH = 2,         /* surfaces a path may pass or bounce at, 0 .. 10000, default 25 */
  RT_SEED = 3,              /* default 0 */
  RT_SHADOWS = 4,           /* 1 (default) or 0 */
  RT_TRANSPORT = 5,         /* one of RT_TRANSPORT_* below, default RT_TRANSPORT_AUTO */
  RT_REPLICATES = 6, /* independent parts of a pixel's samples, 1 .. 1024; 0 (default): as below */
  RT_TARGET_ERROR = 7, /* rtQualityf: 0 .. 1, 0 (default): none */
  RT_TIME_LIMIT = 8,   /* rtQualityf: seconds, 0 .. 1e6, 0 (default): none */
  RT_ENERGY_CUT = 9, /* rtQualityf: whitted: branches that carry less of the camera ray end, 0 .. 1,
                        default 1/4096 */
  RT_CLAMP = 10,     /* rtQualityf: a sample's radiance is at most this by colour; 0 (default): no
                        limit. Biased: what is     clipped is counted in RTstats.clipped */
  RT_PROGRESSIVE =
      11, /* 0 (default) or 1: the whole picture early, then better and better, see below */
  RT_FRAMES_IN_FLIGHT = 12, /* backend=cluster: frames that rtSwapBuffers leaves unfinished, 1
                               (default) .. 64; takes effect at once, is no part of the picture */
  RT_TILE_SIZE = 13 /* edge of tiles in pixels, 4 .. 128; 0 (default): by size and samples. Errors
                       are judged by tile */
};
/* How light is followed from a surface whose shader answers in lobes (openrts.h). */
enum {
  RT_TRANSPORT_AUTO = 0,   /* what leaves out nothing that surfaces of lobes do with light;
                              RTstats.transport says which */
  RT_TRANSPORT_DIRECT = 1, /* light from the lights alone; no mirror images, nothing behind glass */
  RT_TRANSPORT_WHITTED = 2, /* and the whole tree of reflections and refractions; no randomness */
  RT_TRANSPORT_PATH = 3,    /* and light between diffuse surfaces: path tracing, noisy, unbiased */
  RT_TRANSPORT_LIGHT =
      4 /* path; what lamps send through mirrors and lenses to surfaces that the camera sees
           directly is followed from the lamps: caustics, also of lights without extent */
};
/* RTstats.transportLeavesOut: light that is not followed. Images: in mirrors; between: surfaces;
 * caustics: lamps, by mirrors. */
enum {
  RT_LEAVES_IMAGES = 1,
  RT_LEAVES_BETWEEN = 2,
  RT_LEAVES_EMITTERS = 4,
  RT_LEAVES_SKY = 8,
  RT_LEAVES_CAUSTICS = 16
};
/* Error bars. The mean over the pixel's area and over all paths lies, with a probability of 95 %
 * for each colour by itself, within RT_RGBA +- RT_ERROR. Where a transport takes no random decision
 * (direct, whitted) only the mean over the area is uncertain; what the depth limit and the whitted
 * transport's energy cut leave out is not counted.
 *
 * For that the samples are made in independent replicates, whose means are compared: with
 * RT_REPLICATES 0 one replicate, or 16 to 31 if RT_ERROR, RT_TRUST, a target error or a time limit
 * is asked for and there are at least 32 samples. A picture of replicates is not the same as one
 * without, and has more noise where neighbouring samples hardly differ. Without replicates RT_ERROR
 * is what independent samples would have (usually too large), and not trusted.
 *
 * RT_TRUST is 0 with fewer than 8 replicates; where random paths all found the same in 5x5 pixels,
 * as in the dark (RT_ERROR is then a bound: 3/N of the tile's largest sample); where few samples
 * carry the variance of 5x5 pixels, or bright ones are so rare that most have missed them; where
 * nothing is random and samples are equal, but not beside or at the border (a bound too).
 *
 * RT_TARGET_ERROR e: sample each part of the picture until the mean over its pixels of (RT_ERROR
 * summed over the colours) / (colours summed + 0.03), at most 1 a pixel, is about e, or
 * RT_SAMPLES_PER_PIXEL samples are taken. How many is decided by pilots that are not part of the
 * picture, a third of these samples and 32 at most: stopping does not bias it.
 *
 * RT_TIME_LIMIT s: rounds over the whole picture, each one replicate, until s seconds have gone by
 * since the frame was started or RT_SAMPLES_PER_PIXEL are taken. A round is not broken off, so the
 * limit is kept to about a thirtieth; at least one round is made. Such a picture depends on the
 * machine's speed; a recording of it is not replayed to the same bytes.
 *
 * RT_PROGRESSIVE 1: for those who look at a frame while it is made (rtSnapshot): rounds over the
 * whole picture, of one sample a pixel at first, then of more. When it is finished its bytes are
 * those of the same frame without; it takes a few per cent longer and 56 to 180 bytes a pixel by
 * channels, with those of the error about 320. With a time limit, which makes rounds of its own,
 * nothing changes, nor with fewer than 32 samples. */
/* Size in pixels (1 .. 65536 each, at most 2^28 in all) and channels of the following frames. */
RT_API void rtFrameBuffer(int width, int height, uint32_t channels);
RT_API void rtQuality(RTenum name, int value);
RT_API void rtQualityf(RTenum name, double value);
/* Commits the edits, waits for the frame in flight, makes it the one rtReadPixels reads and starts
 * the next. Like rtRender it needs a frame buffer and no definition open (else
 * RT_INVALID_OPERATION). With backend=cluster the next is started first, and waits for the oldest
 * only while there are more than RT_FRAMES_IN_FLIGHT; RTstats.frame tells which one was finished
 * last. */
RT_API void rtSwapBuffers(void);
/* Waits for the oldest frame in flight and makes it the one rtReadPixels reads. Returns 1, or 0
 * when none is in flight. */
RT_API int rtFinishFrame(void);
/* Commits, renders and waits; rtReadPixels then reads this frame. */
RT_API void rtRender(void);
/* Ends the frames in flight early: their pictures hold the tiles finished so far. May be called
 * from any thread. */
RT_API void rtCancel(RTcontext context);
/* Fraction done of the (oldest) frame in flight, 0 to 1. May be called from any thread. */
RT_API float rtProgress(RTcontext context);
/* Copies one channel of the (oldest) frame in flight as far as it is finished into out, laid out as
 * by rtReadPixels; tiles that are not finished are 0 (RT_DEPTH: infinite); of a frame in rounds,
 * what each tile has by now. Returns 1, or 0 if no frame with this channel and at most count floats
 * is in flight. May be called from any thread. */
RT_API int rtSnapshot(RTcontext context, RTenum channel, float* out, size_t count);
/* Copies one channel of the finished frame into out: width*height*components floats, first row at
 * the top. count: floats that out has room for. */
RT_API void rtReadPixels(RTenum channel, float* out, size_t count);

typedef struct RTstats {
  size_t size; /* set it to sizeof(RTstats) before the call */
  uint64_t triangles, uniqueTriangles, objects, instances, lights, textures;
  uint64_t degenerate;        /* primitives dropped */
  uint64_t rejectedRays;      /* rays that were not finite */
  uint64_t rejectedInstances; /* instances with a matrix that is singular or out of range */
  uint64_t cameraRays, shadowRays, secondaryRays;
  double commitSeconds, buildSeconds, renderSeconds;
  uint64_t bvhBytes;
  uint64_t objectBuilds;   /* acceleration structures of objects (or of merged static ones) built
                              since the context was made */
  uint64_t topLevelBuilds; /* times the top level over them was built or refitted */
  uint32_t threads;
  char isa[16];
  char kernel[32]; /* e.g. "Embree 3.13.5" */
  /* Error of the picture as a whole. Of a pixel it is (errors of the colours summed) / (colours
   * summed + 0.03), at most 1. */
  double errorMean;         /* about the mean over the pixels of what they are off by */
  double errorMeanInterval; /* that mean lies in errorMean +- this with 95 %; what rests on what:
                               docs/accuracy.md */
  double
      errorHalfWidth; /* mean over the pixels of RT_ERROR; what RT_TARGET_ERROR is compared with */
  double errorP99;    /* 99 % of the pixels have a smaller RT_ERROR */
  double errorLevel;  /* 0.95 */
  uint64_t errorPixels;     /* pixels that these numbers are about: those finished; 0 without
                               RT_VARIANCE or RT_ERROR */
  uint64_t errorTrusted;    /* of them with RT_TRUST 1 */
  char errorMethod[48];     /* "replicated nets, Student's t", "sample variance", "" */
  RTenum transport;         /* RT_TRANSPORT_* that made the last frame */
  char transportReason[96]; /* why, for people */
  /* What is left out, mean over the pixels of the sum over the colours: no error bar covers it. */
  double cutByDepth; /* throughput of paths that the depth limit ended: times the radiance beyond it
                        is the loss */
  double cutByEnergy;       /* the same of branches that RT_ENERGY_CUT ended */
  double clipped;           /* radiance that RT_CLAMP has taken away */
  uint64_t unreachedLights; /* lights without extent whose way by mirrors or glass only
                               RT_TRANSPORT_LIGHT follows; there 0 */
  uint64_t shaderFaults;    /* hits at which a shader answered with NaN or infinity; taken as 0, the
                               log names the class */
  uint64_t wrongHits; /* times single precision would find a sliver (decision 41) that a ray misses
                         in double; not taken */
  uint64_t frame;     /* number of the finished frame, counted from 1; 0: none yet */
  /* backend=cluster, since the context was made; else 0. Tiles: jobs, parts of tiles too. */
  uint32_t workers;                 /* that are there now, this process not counted */
  uint64_t tilesRemote, tilesLocal; /* done by workers; by this process */
  uint64_t reissued,
      duplicates; /* handed out again: late, or their worker was lost; results that came too late */
  uint64_t bytesSent, bytesReceived;
  uint32_t transportLeavesOut; /* RT_LEAVES_*, or'ed: light of the scene that the transport does not
                                  follow */
  double errorUnmet; /* radiance that may be missing, with 95 %: paths meet it by chance, and few
                        have; docs/accuracy.md */
} RTstats;
RT_API void rtGetStats(RTstats* stats);

/* A worker of backend=cluster, since it joined. */
typedef struct RTworker {
  size_t size;   /* of the first one of an array: set it to sizeof(RTworker) before the call */
  char name[64]; /* its host and address, for people; "here": this process */
  uint32_t threads;
  int alive;                         /* 0: it has left, or was refused */
  uint64_t jobs;                     /* done */
  uint64_t late;                     /* results that came when somebody else had done the job */
  uint64_t lost;                     /* jobs taken away because it left */
  uint64_t bytesSent, bytesReceived; /* to it, from it */
  uint64_t rays;
  double busySeconds; /* of all its threads */
  double latency;     /* seconds a job is under way beyond the work, smoothed */
} RTworker;
/* Writes at most count workers, those that left too, and returns how many there are. workers may be
 * NULL if count is 0. May be called from any thread. */
RT_API size_t rtGetWorkers(RTcontext context, RTworker* workers, size_t count);

/* Queries on the last committed scene
 * ---------------------------------------------------------------------------------- */

typedef struct RTray {
  float origin[3];
  float tnear;
  float direction[3];
  float tfar;
} RTray;
typedef struct RThit {
  float t;         /* along direction as given; infinity: nothing hit */
  float u, v;      /* barycentrics */
  float normal[3]; /* unit geometric normal, not turned towards the ray */
  RTid instance;   /* outermost, 0 where nothing is hit */
  uint32_t name;   /* rtLoadName */
  uint32_t
      primitive; /* triangle, segment or point of its draw call, or of the run of rtBegin ... rtEnd
                    lists with one state that it belongs to; degenerate ones do not count */
  uint64_t userData;
} RThit;
/* What the camera sees at x, y (pixels from the top left corner of the frame buffer), through the
 * middle of its lens. hit as by rtCastRays, t in world units from the camera ray's origin. Returns
 * 1, or 0 where nothing is hit (t is infinite). Needs a frame buffer and a camera (else
 * RT_INVALID_OPERATION). */
RT_API int rtPick(double x, double y, RThit* hit);
/* Nearest hits of count rays. A ray that is not finite hits nothing and is counted. Rays are in
 * world coordinates. */
RT_API void rtCastRays(size_t count, const RTray* rays, RThit* hits);
/* occluded[i] = 1 if anything lies between tnear and tfar. */
RT_API void rtOccludedRays(size_t count, const RTray* rays, uint8_t* occluded);

#ifdef __cplusplus
}
#endif
#endif
