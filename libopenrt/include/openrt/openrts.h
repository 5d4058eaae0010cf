/* openrts.h: OpenRTS, the shader SDK of OpenRT (C99, needs nothing but itself; C++ authors see openrts.hpp).
 *
 * A plug-in is a shared library that exports one constant, `rtsPlugin`, and links against nothing of OpenRT: what it needs
 * of the host comes as a table of functions. A plug-in has classes: surface shaders, lights, cameras, environments. Every
 * function works on a batch of n points or rays. Arrays are structures of arrays, aligned to 64 bytes and readable and
 * writable up to n rounded up to RTS_LANES, so a loop may run over whole vectors; the values of the padding are harmless
 * copies of lane n-1 on input and ignored on output.
 *
 * Spaces: "render space" has the world's axes and units; its origin is near the camera. Lights and environments also see
 * their local space, the frame of the matrix at rtUseLight / rtUseEnvironment.
 *
 * Thread tag of every class function: [render], called concurrently on different batches. They must be pure functions of
 * their arguments: same input, same bytes.
 */
#ifndef OPENRT_OPENRTS_H
#define OPENRT_OPENRTS_H

#include <stddef.h>
#include <stdint.h>

#define RTS_MAGIC 0x5352544fu /* "OTRS" */
#define RTS_ABI_MAJOR 1       /* a host refuses another major number */
#define RTS_ABI_MINOR 1       /* grows with every field appended; a host accepts minors up to its own */
#define RTS_LANES 16

#ifdef __cplusplus
extern "C" {
#endif

typedef struct RtsHost RtsHost;
typedef struct RtsBatch RtsBatch; /* the host's side of one batch; passed back to host functions */
typedef uint32_t RtsTexture;      /* 0: none */

/* Parameters: a class declares a C struct; the host fills one per shader ------------------------------------------------ */

/* C type in the parameter struct */
typedef enum RtsType {
  RTS_INT = 1,                  /* int32_t */
  RTS_FLOAT,                    /* float */
  RTS_VEC2,                     /* float[2] */
  RTS_VEC3,                     /* float[3] */
  RTS_VEC4,                     /* float[4] */
  RTS_COLOR,                    /* float[3], linear */
  RTS_MATRIX,                   /* float[16], column-major */
  RTS_FLOATS,                   /* RtsFloats */
  RTS_STRING,                   /* const char*, never NULL */
  RTS_TEXTURE,                  /* RtsTexture */
  RTS_TYPE_32_BITS = 0x7fffffff /* no type: fixes the size of the enumeration */
} RtsType;

typedef struct RtsFloats {
  const float* data;
  uint32_t count;
} RtsFloats;

typedef struct RtsParam {
  const char* name;
  RtsType type;
  uint32_t offset;        /* in the parameter struct */
  float defaultValue[16]; /* numbers; lists, strings and textures start empty */
  float minimum, maximum; /* inclusive; both 0: no range */
  const char* text;       /* one line for people: meaning and unit */
} RtsParam;

/* Batches ------------------------------------------------------------------------------------------------------------------ */

/* RtsHits.flags */
enum {
  RTS_HIT_BACK = 1,     /* the ray meets the side that the geometric normal, before it was turned, faces away from */
  RTS_HIT_COLOR = 2,    /* the geometry has colours; `color` holds the interpolated one (else 1 1 1 1) */
  RTS_HIT_TEXCOORD = 4, /* the geometry has texture coordinates (else uv is 0) */
  RTS_HIT_LINE = 8      /* a line or a point rather than a surface */
};

typedef struct RtsHits {
  uint32_t count;
  const float* position[3];  /* render space */
  const float* direction[3]; /* unit, of the ray, towards the surface */
  const float* geometric[3]; /* unit geometric normal, turned towards the ray's origin */
  const float* normal[3];    /* unit shading normal, on the same side as the geometric one */
  const float* uv[2];
  const float* color[4]; /* rgba */
  const float* distance; /* along the path from the camera */
  const uint32_t* flags;
  const void* const* params; /* the shader's parameter struct, by lane */
  const float* segment;      /* since 1.1: along the ray that met the surface */
} RtsHits;

/* What a surface shader answers. All arrays are zero on entry. */
typedef struct RtsShading {
  float* radiance[3];     /* leaving towards the ray's origin, already weighted by opacity */
  float* transmission[3]; /* fraction of what lies straight behind that is let through, 0..1 */
  float* albedo[3];       /* surface colour for the albedo channel, or NULL where nobody asks */
} RtsShading;

/* Lobes (since 1.1): a surface as a sum of ways in which it answers light. The engine's transport asks lights, follows mirror
 * images and samples directions; the shader only describes. Weights are linear, 0 .. 1; reflectances of one hit should add up to
 * at most 1. */
typedef enum RtsLobeKind {
  RTS_LOBE_DIFFUSE = 1, /* Lambert; weight: albedo */
  RTS_LOBE_REFLECTION,  /* perfect mirror; weight: reflectance for this direction (Fresnel included) */
  RTS_LOBE_DIELECTRIC,  /* smooth boundary of a clear medium: Fresnel reflection and refraction, unpolarised; weight: their tint;
                           parameter[0]: index of refraction on the ray's side over that behind */
  RTS_LOBE_TRANSPARENT, /* straight through; weight: transmittance */
  RTS_LOBE_COUNT,
  RTS_LOBE_32_BITS = 0x7fffffff
} RtsLobeKind;

/* A lobe of every hit of a batch. Where the weight is 0 the hit has no such lobe. Made by RtsHost.lobe: weights 0, the normal
 * that of the hits, parameters 0; a shader writes what differs. */
typedef struct RtsLobe {
  RtsLobeKind kind;
  float* weight[3];
  float* normal[3]; /* unit, on the side of the hit's geometric normal */
  float* parameter[2];
} RtsLobe;

/* What a surface shader that answers in lobes says beside them. All arrays are zero on entry. */
typedef struct RtsSurface {
  float* emission[3]; /* radiance of its own towards the ray's origin */
  float* albedo[3];   /* surface colour for the albedo channel, or NULL where nobody asks */
} RtsSurface;

/* Light arriving at the points of a batch from one light. */
typedef struct RtsIllumination {
  /* Of a light's function: vector to the light in its local space, any length; to a surface shader: unit, render space. */
  float* toLight[3];
  /* Radiance scale of the direct part: light colour x intensity x attenuation x cone; 0 where it does not reach. */
  float* color[3];
  float* ambient[3]; /* the same for the ambient part */
  int directional;   /* set by the light: toLight has no end point (shadow rays run to infinity) */
} RtsIllumination;

/* Of a camera; render space comes later: these are in the camera's local space */
typedef struct RtsRays {
  float* origin[3];
  float* direction[3]; /* unit */
} RtsRays;

/* Classes -------------------------------------------------------------------------------------------------------------------- */

typedef enum RtsKind {
  RTS_SURFACE = 1,
  RTS_LIGHT = 2,
  RTS_CAMERA = 3,
  RTS_ENVIRONMENT = 4,
  RTS_KIND_32_BITS = 0x7fffffff /* no kind: fixes the size of the enumeration */
} RtsKind;

/* Answered by RtsClass.traits for one set of parameters */
enum {
  RTS_TRANSPARENT = 1, /* surface: transmission may be above 0; shadow rays then ask `transmit` */
  RTS_UNLIT = 2,       /* surface: never asks for lights */
  RTS_NO_SHADOW = 4,   /* light: casts no shadows */
  RTS_EMISSIVE = 8     /* surface that answers in lobes: emission may be above 0 */
};

typedef struct RtsClass {
  uint32_t size; /* sizeof(RtsClass) of the plug-in's header; absent functions are NULL */
  RtsKind kind;
  const char* name;
  const char* text;
  uint32_t paramSize;
  uint32_t paramCount;
  const RtsParam* params;
  /* RTS_* traits of a shader with these parameters; NULL: none. Called at commit. */
  uint32_t (*traits)(const RtsHost* host, const void* params);
  /* surface: fills out for every hit. */
  void (*shade)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out);
  /* surface: only the transmission, for shadow rays; hits carry position, direction, uv, color, flags, params. NULL: opaque. */
  void (*transmit)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, float* const transmission[3]);
  /* light: fills out for n points given in the light's local space. */
  void (*illuminate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n, const float* const local[3],
                     RtsIllumination* out);
  /* camera: rays for n points of the picture; x, y in pixels from the top left corner, size = width, height. */
  void (*generate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n, const float* const xy[2],
                   const float size[2], RtsRays* out);
  /* environment: radiance (rgb) and opacity (a) seen in n local-space directions (unit). NULL: black, opacity 0. */
  void (*miss)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n, const float* const direction[3],
               float* const rgba[4]);
  /* environment: fog between the camera and hits at n local-space vectors from the eye: writes the fog colour and the
   * fraction (0..1) of surface radiance that arrives. NULL: clear air. */
  void (*attenuate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n, const float* const fromEye[3],
                    float* const color[3], float* fraction);
  /* surface, since 1.1: describes every hit by lobes (RtsHost.lobe) and emission. A class has this or `shade`; of both, this. */
  void (*surface)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out);
} RtsClass;

typedef struct RtsPlugin {
  uint32_t magic; /* RTS_MAGIC */
  uint16_t major, minor;
  uint32_t size; /* sizeof(RtsPlugin) */
  uint32_t classCount;
  const RtsClass* const* classes;
} RtsPlugin;

/* Host: what a shader may call ---------------------------------------------------------------------------------------- */

struct RtsHost {
  uint32_t size;
  uint16_t major, minor;
  /* Number of lights that shine on the batch. */
  uint32_t (*lights)(RtsBatch* batch);
  /* Light number i (0 <= i < lights) at the hits; the arrays of out are the host's, valid until the next call for this batch. */
  void (*illuminate)(RtsBatch* batch, uint32_t i, const RtsHits* hits, RtsIllumination* out);
  /* Visibility of light i from the hits: multiplies light->color by the colour let through by what lies between, for the
   * lanes whose wanted[lane] is not 0. Must follow illuminate(i). Does nothing where shadows are off. */
  void (*shadow)(RtsBatch* batch, uint32_t i, const RtsHits* hits, const uint8_t* wanted, RtsIllumination* light);
  /* Filtered texels (rgba; grey is replicated, missing alpha is 1) at n places. texture 0 gives 1 1 1 1. */
  void (*sample)(RtsBatch* batch, RtsTexture texture, uint32_t n, const float* const uv[2], float* const rgba[4]);
  /* Components 1..4 of a texture, 0 for texture 0. */
  uint32_t (*components)(const RtsHost* host, RtsTexture texture);
  /* n floats (rounded up to RTS_LANES), aligned, not initialised, freed when the batch function returns. Never NULL. */
  float* (*scratch)(RtsBatch* batch, uint32_t n);
  /* level 0 debug .. 3 error; the host limits how often the same text is passed on. */
  void (*log)(const RtsHost* host, int level, const char* utf8);
  /* Since 1.1: another lobe of the batch's hits, for `surface`. At most RTS_MAX_LOBES a batch, NULL beyond. Owned by the host. */
  RtsLobe* (*lobe)(RtsBatch* batch, RtsLobeKind kind);
};
#define RTS_MAX_LOBES 8

#if defined(_WIN32)
#define RTS_EXPORT __declspec(dllexport)
#else
#define RTS_EXPORT __attribute__((visibility("default")))
#endif
/* The one symbol of a plug-in:
 *   RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin), n, classes}; */
#define RTS_ENTRY_NAME "rtsPlugin"

#ifdef __cplusplus
}
#endif
#endif
