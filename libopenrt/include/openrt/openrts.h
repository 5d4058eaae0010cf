/* openrts.h: OpenRTS, the shader SDK of OpenRT (C99, needs nothing but itself; C++ authors see
 * openrts.hpp).
 *
 * A plug-in is a shared library that exports one constant, `rtsPlugin`, and links against nothing
 * of OpenRT: what it needs of the host comes as a table of functions. A plug-in has classes:
 * surface shaders, lights, cameras, environments, transports. Every function works on a batch of n
 * points or rays. Arrays are structures of arrays, aligned to 64 bytes and readable and writable up
 * to n rounded up to RTS_LANES, so a loop may run over whole vectors; the values of the padding are
 * harmless copies of lane n-1 on input and ignored on output.
 *
 * Spaces: "render space" has the world's axes and units; its origin is near the camera. Lights and
 * environments also see their local space, the frame of the matrix at rtUseLight /
 * rtUseEnvironment.
 *
 * Thread tag of every class function: [render], called concurrently on different batches. They must
 * be pure functions of their arguments: same input, same bytes.
 */
#ifndef OPENRT_OPENRTS_H
#define OPENRT_OPENRTS_H

#include <stddef.h>
#include <stdint.h>

#define RTS_MAGIC 0x5352544fu /* "OTRS" */
#define RTS_ABI_MAJOR 1       /* a host refuses another major number */
#define RTS_ABI_MINOR 2 /* grows with every field appended; a host accepts minors up to its own */
#define RTS_LANES 16

#ifdef __cplusplus
extern "C" {
#endif

typedef struct RtsHost RtsHost;
typedef struct RtsBatch RtsBatch; /* the host's side of one batch; passed back to host functions */
typedef uint32_t RtsTexture;      /* 0: none */

/* Parameters: a class declares a C struct; the host fills one per shader
 * ------------------------------------------------ */

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

/* Batches
 * ------------------------------------------------------------------------------------------------------------------
 */

/* RtsHits.flags */
enum {
  RTS_HIT_BACK = 1, /* the ray meets the side that the geometric normal, before it was turned, faces
                       away from */
  RTS_HIT_COLOR =
      2, /* the geometry has colours; `color` holds the interpolated one (else 1 1 1 1) */
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

/* Lobes (since 1.1): a surface as a sum of ways in which it answers light. The engine's transport
 * asks lights, follows mirror images and samples directions; the shader only describes. Weights are
 * linear, 0 .. 1; reflectances of one hit should add up to at most 1. The transports direct and
 * whitted answer lights by every lobe that scatters (all but REFLECTION, DIELECTRIC and
 * TRANSPARENT) and follow none of these; path tracing samples them. */
typedef enum RtsLobeKind {
  RTS_LOBE_DIFFUSE = 1, /* Lambert; weight: albedo */
  RTS_LOBE_REFLECTION,  /* perfect mirror; weight: reflectance for this direction (Fresnel included)
                         */
  RTS_LOBE_DIELECTRIC,  /* smooth boundary of a clear medium: Fresnel reflection and refraction,
                           unpolarised; weight: their tint;  parameter[0]: index of refraction on the
                           ray's side over that behind. Where the class has a  `medium` the engine
                           knows the indices on both sides by itself and leaves the parameter alone
                         */
  RTS_LOBE_TRANSPARENT, /* straight through; weight: transmittance */
  /* Since 1.2. Microfacets after B. Walter et al., "Microfacet Models for Refraction through Rough
   * Surfaces", EGSR 2007 (GGX, Smith shadowing); alpha 0 .. 1 is the width of the distribution of
   * slopes, below 1e-4 taken as 1e-4. */
  RTS_LOBE_GLOSSY, /* reflection; weight: reflectance of a facet; parameter[0]: alpha; parameter[1]:
                      index of refraction on the ray's side over that behind, whose Fresnel
                      reflectance multiplies, or 0: none does */
  RTS_LOBE_ROUGH_DIELECTRIC, /* boundary of a clear medium: reflection and refraction at facets;
                                weight: their tint; parameter[0]: as of DIELECTRIC; parameter[1]:
                                alpha */
  RTS_LOBE_CUSTOM,           /* functions of the plug-in (RtsHost.customLobe) */
  RTS_LOBE_COUNT,
  RTS_LOBE_32_BITS = 0x7fffffff
} RtsLobeKind;

/* A lobe of every hit of a batch. Where the weight is 0 the hit has no such lobe. Made by
 * RtsHost.lobe: weights 0, the normal that of the hits, parameters 0; a shader writes what differs.
 */
#define RTS_MAX_LOBE_FLOATS 16
typedef struct RtsLobeFunctions RtsLobeFunctions;
typedef struct RtsLobe {
  RtsLobeKind kind;
  float* weight[3];
  float* normal[3]; /* unit, on the side of the hit's geometric normal */
  float* parameter[2];
  /* since 1.2, of RTS_LOBE_CUSTOM */
  const RtsLobeFunctions* functions;
  float* data[RTS_MAX_LOBE_FLOATS]; /* as many as were asked for, one value a hit, 0 at first */
} RtsLobe;

/* A lobe of a plug-in's own (since 1.2): n pairs of a hit of the batch (hit[i] is its number) and a
 * direction. `value` is the response per radiance times the cosine at the lobe's normal, without
 * the lobe's weight; `density` is that of `sample` by solid angle, 0 for directions that it never
 * gives. Answers for hits where the lobe's weight is 0 are not used. Directions are unit, away from
 * the surface; towards the eye it is minus hits->direction. A lobe must be reciprocal unless it
 * transmits, and reflect at most what it gets. Nothing is padded to RTS_LANES here. */
struct RtsLobeFunctions {
  uint32_t size;      /* sizeof(RtsLobeFunctions) */
  uint32_t transmits; /* 1: directions to the other side of the surface may have a value */
  void (*evaluate)(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                   const float* const direction[3], float* const value[3], float* density);
  /* For points of the unit square: a direction, `value` divided by its density, and the density.
   * Density 0: none. */
  void (*sample)(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                 const float* const square[2], float* const direction[3], float* const quotient[3],
                 float* density);
};

/* What a surface shader that answers in lobes says beside them. All arrays are zero on entry. */
typedef struct RtsSurface {
  float* emission[3]; /* radiance of its own towards the ray's origin */
  float* albedo[3];   /* surface colour for the albedo channel, or NULL where nobody asks */
} RtsSurface;

/* Light arriving at the points of a batch from one light. */
typedef struct RtsIllumination {
  /* Of a light's function: vector to the light in its local space, any length; to a surface shader:
   * unit, render space. */
  float* toLight[3];
  /* Radiance scale of the direct part: light colour x intensity x attenuation x cone; 0 where it
   * does not reach. */
  float* color[3];
  float* ambient[3]; /* the same for the ambient part */
  int directional;   /* set by the light: toLight has no end point (shadow rays run to infinity) */
} RtsIllumination;

/* Of a camera; render space comes later: these are in the camera's local space */
typedef struct RtsRays {
  float* origin[3];
  float* direction[3]; /* unit */
} RtsRays;

/* Since 1.2. The inside of a body whose surface has the shader, by colour: what differs by colour
 * is dispersion. Bodies may overlap: where they do, the one of the highest priority is there (C.
 * Schmidt, B. Budge, "Simple Nested Dielectrics in Ray Traced Images", JGT 7(2), 2002). Boundaries
 * of others within it are not seen. Faces point outwards. */
typedef struct RtsMedium {
  float index[3];      /* of refraction, > 0 */
  float absorption[3]; /* per unit of length in the world: exp(-absorption x length) is left */
  int32_t priority;
} RtsMedium;

/* Since 1.2. Where a light is and how strong, in its local space: to choose among many, and to
 * follow light from its source. */
typedef struct RtsExtent {
  int32_t parallel; /* 1: light falls along `direction` everywhere; else it comes from `position` */
  float position[3];
  float direction[3]; /* unit; axis of the cone that gets light */
  float cosine;       /* of the cone's half angle; -1: all directions */
  float power;  /* mean over the colours of the flux; parallel: of the irradiance. Only a guess */
  float radius; /* nothing is lit beyond; infinite without */
} RtsExtent;

/* Since 1.2. Where points are in the picture. */
typedef struct RtsProjection {
  float* xy[2];    /* pixels from the top left corner */
  float* toEye[3]; /* vector from the point to the place on the lens, or, for parallel views, a unit
                      vector towards the eye */
  float* weight; /* pixels covered per unit of area, at the point, of a surface that faces the eye;
                    0: not in the picture */
  int parallel;  /* set by the camera */
} RtsProjection;

/* Since 1.2. Rays that a shader sends: from hits of its batch, or from anywhere. */
typedef struct RtsRequest {
  uint32_t count;
  const uint32_t*
      hit; /* number of the hit that each ray belongs to (of a transport: of the camera ray) */
  const float* origin[3]; /* render space; origin[0] NULL: from the hits, lifted off the surface to
                             the side of the direction */
  const float* direction[3]; /* unit */
  const float* length;       /* where it ends; NULL: nowhere */
} RtsRequest;

/* What rays meet first. Arrays may be NULL where nobody asks. */
typedef struct RtsFound {
  float* distance;     /* infinite: nothing */
  float* position[3];  /* render space */
  float* geometric[3]; /* unit, turned towards the ray's origin */
  float* normal[3];    /* shading normal, unit */
  uint32_t* name;      /* rtLoadName */
} RtsFound;

/* Classes
 * --------------------------------------------------------------------------------------------------------------------
 */

typedef enum RtsKind {
  RTS_SURFACE = 1,
  RTS_LIGHT = 2,
  RTS_CAMERA = 3,
  RTS_ENVIRONMENT = 4,
  RTS_TRANSPORT = 5,            /* since 1.2 */
  RTS_KIND_32_BITS = 0x7fffffff /* no kind: fixes the size of the enumeration */
} RtsKind;

/* Answered by RtsClass.traits for one set of parameters */
enum {
  RTS_TRANSPARENT = 1, /* surface: transmission may be above 0; shadow rays then ask `transmit` */
  RTS_UNLIT = 2,       /* surface: never asks for lights */
  RTS_NO_SHADOW = 4,   /* light: casts no shadows */
  RTS_EMISSIVE = 8,    /* surface that answers in lobes: emission may be above 0 */
  /* since 1.2; from these the automatic transport is chosen */
  RTS_SPECULAR =
      16, /* surface: may have lobes REFLECTION or DIELECTRIC. Assumed of classes made for 1.1 */
  RTS_GLOSSY = 32, /* surface: may have lobes that scatter, other than DIFFUSE */
  RTS_GLOBAL = 64, /* surface: asks for the light of other surfaces: path tracing */
  /* Hosts that do not know these take them as not set. */
  RTS_NO_SCATTER = 128, /* surface: has no lobes but REFLECTION, DIELECTRIC and TRANSPARENT */
  RTS_BACKDROP = 256    /* environment: a picture that does not light surfaces that answer by
                           themselves (`shade`) */
};

/* Since 1.2: what may set a parameter's value; whatever it is, functions find it in the parameter
 * struct of the hit. */
enum {
  RTS_PER_SHADER = 0,
  RTS_PER_TRIANGLE = 1,
  RTS_PER_VERTEX = 2 /* interpolated; numbers other than RTS_INT only */
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
  /* surface: only the transmission, for shadow rays; hits carry position, direction, uv, color,
   * flags, params. NULL: opaque. */
  void (*transmit)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                   float* const transmission[3]);
  /* light: fills out for n points given in the light's local space. */
  void (*illuminate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                     const float* const local[3], RtsIllumination* out);
  /* camera: rays for n points of the picture; x, y in pixels from the top left corner, size =
   * width, height. */
  void (*generate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                   const float* const xy[2], const float size[2], RtsRays* out);
  /* environment: radiance (rgb) and opacity (a) seen in n local-space directions (unit). NULL:
   * black, opacity 0. */
  void (*miss)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
               const float* const direction[3], float* const rgba[4]);
  /* environment: fog between the camera and hits at n local-space vectors from the eye: writes the
   * fog colour and the fraction (0..1) of surface radiance that arrives. NULL: clear air. */
  void (*attenuate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                    const float* const fromEye[3], float* const color[3], float* fraction);
  /* surface, since 1.1: describes every hit by lobes (RtsHost.lobe) and emission. Of a class that
   * has both this and `shade` (since 1.2), path tracing asks this and the other transports ask
   * `shade`. */
  void (*surface)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out);
  /* The rest since 1.2, all optional. */
  /* RTS_PER_* by parameter: how often its value may change; NULL: all are RTS_PER_SHADER. */
  const uint8_t* frequency;
  /* Called once for each new set of parameter values, before any other function sees it, and when
   * it goes. Both may change parts of the struct that are no parameters (they are zero before
   * `prepare`): tables made from parameters. `prepare` returns NULL, or a message for people
   * (static, or kept in the struct): it is logged, a surface is then drawn by the default surface
   * shader, and a light, camera, environment or transport is not there. */
  const char* (*prepare)(const RtsHost* host, void* params);
  void (*release)(const RtsHost* host, void* params);
  /* surface: 1 and the inside of the body, 0: it has none. Called at commit. */
  int (*medium)(const RtsHost* host, const void* params, RtsMedium* out);
  /* light: 1 and its extent, 0: unknown. Called at commit. */
  int (*extent)(const RtsHost* host, const void* params, RtsExtent* out);
  /* camera: the inverse of `generate` for n points in the camera's local space. lens: a point of
   * the unit square for each. */
  void (*project)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                  const float* const local[3], const float* const lens[2], const float size[2],
                  RtsProjection* out);
  /* transport: radiance (rgb) and alpha of n camera rays, through RtsHost.trace, findHit, occluded
   * and random. */
  void (*radiance)(const RtsHost* host, RtsBatch* batch, const void* params, const RtsRequest* rays,
                   float* const rgba[4]);
} RtsClass;

typedef struct RtsPlugin {
  uint32_t magic; /* RTS_MAGIC */
  uint16_t major, minor;
  uint32_t size; /* sizeof(RtsPlugin) */
  uint32_t classCount;
  const RtsClass* const* classes;
} RtsPlugin;

/* Host: what a shader may call
 * ---------------------------------------------------------------------------------------- */

struct RtsHost {
  uint32_t size;
  uint16_t major, minor;
  /* Number of lights that shine on the batch. */
  uint32_t (*lights)(RtsBatch* batch);
  /* Light number i (0 <= i < lights) at the hits; the arrays of out are the host's, valid until the
   * next call for this batch. */
  void (*illuminate)(RtsBatch* batch, uint32_t i, const RtsHits* hits, RtsIllumination* out);
  /* Visibility of light i from the hits: multiplies light->color by the colour let through by what
   * lies between, for the lanes whose wanted[lane] is not 0 (2: it comes through the surface). Must
   * follow illuminate(i). Does nothing where shadows are off. */
  void (*shadow)(RtsBatch* batch, uint32_t i, const RtsHits* hits, const uint8_t* wanted,
                 RtsIllumination* light);
  /* Filtered texels (rgba; grey is replicated, missing alpha is 1) at n places. texture 0 gives 1 1
   * 1 1. */
  void (*sample)(RtsBatch* batch, RtsTexture texture, uint32_t n, const float* const uv[2],
                 float* const rgba[4]);
  /* Components 1..4 of a texture, 0 for texture 0. */
  uint32_t (*components)(const RtsHost* host, RtsTexture texture);
  /* n floats (rounded up to RTS_LANES), aligned, not initialised, freed when the batch function
   * returns. Never NULL. */
  float* (*scratch)(RtsBatch* batch, uint32_t n);
  /* level 0 debug .. 3 error; the host limits how often the same text is passed on. */
  void (*log)(const RtsHost* host, int level, const char* utf8);
  /* Since 1.1: another lobe of the batch's hits, for `surface`. At most RTS_MAX_LOBES a batch, NULL
   * beyond. Owned by the host. */
  RtsLobe* (*lobe)(RtsBatch* batch, RtsLobeKind kind);
  /* The rest since 1.2. */
  /* A lobe of the plug-in's own with a number of floats (at most RTS_MAX_LOBE_FLOATS) for each hit;
   * NULL as by `lobe`. */
  RtsLobe* (*customLobe)(RtsBatch* batch, const RtsLobeFunctions* functions, uint32_t floats);
  /* A point of the unit square for each hit (camera: each point), one sequence for each pair < 4:
   * well spread over the samples of a pixel, the same for the same picture. Using one turns the
   * pixel's value into an estimate. */
  void (*random)(RtsBatch* batch, uint32_t pair, float* const square[2]);
  /* Radiance (and, if rgba[3] is not NULL, alpha) that comes back along rays, shaded by the engine:
   * for `shade` and `radiance`. Nests as deep as the depth limit allows, at most 64 times; black
   * beyond. */
  void (*trace)(RtsBatch* batch, const RtsRequest* rays, float* const rgba[4]);
  void (*findHit)(RtsBatch* batch, const RtsRequest* rays, RtsFound* out);
  /* Colour that is let through between a ray's origin and its end: 0 where it is blocked. */
  void (*occluded)(RtsBatch* batch, const RtsRequest* rays, float* const transmission[3]);
  /* Of the hits: position and geometric normal (not unit) in the frame of the object
   * (rtBeginObject) that the surface belongs to: what rtInstantiateObject places. NULL pointers are
   * left out. */
  void (*local)(RtsBatch* batch, float* const position[3], float* const normal[3]);
  /* Change of position per unit of texture coordinate, render space; 0 without texture coordinates.
   */
  void (*derivatives)(RtsBatch* batch, float* const alongS[3], float* const alongT[3]);
  /* rtLoadName, outermost instance, triangle (as RThit); NULL pointers are left out. */
  void (*ids)(RtsBatch* batch, uint32_t* name, uint32_t* instance, uint32_t* primitive);
  /* Of the ray that met the surface: surfaces met before, and the share of the light that reaches
   * the camera. */
  void (*path)(RtsBatch* batch, uint32_t* depth, float* const throughput[3]);
  /* Bound of the positions' rounding error along the geometric normal. */
  void (*error)(RtsBatch* batch, float* error);
};
#define RTS_MAX_LOBES 8

#if defined(_WIN32)
#define RTS_EXPORT __declspec(dllexport)
#else
#define RTS_EXPORT __attribute__((visibility("default")))
#endif
/* The one symbol of a plug-in:
 *   RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR,
 * sizeof(RtsPlugin), n, classes}; */
#define RTS_ENTRY_NAME "rtsPlugin"

#ifdef __cplusplus
}
#endif
#endif
