/* openrts.h: OpenRTS, the shader SDK of OpenRT. Needs a C99 compiler and no other header of OpenRT;
 * C++ authors use openrts.hpp.
 *
 * A plug-in is a shared library that exports one constant, `rtsPlugin`. It does not link against
 * OpenRT: the host passes it a table of functions (RtsHost). A plug-in contains classes: surface
 * shaders, lights, cameras, environments and transports. A shader is an instance of a class with
 * its own parameter values.
 *
 * Every batch function works on n points or rays. Arrays are structures of arrays. They are aligned
 * to 64 bytes and readable and writable up to n rounded up to RTS_LANES, so a loop may run over
 * whole vectors. Padding lanes hold harmless copies of lane n-1 on input and are ignored on output.
 *
 * Spaces: "render space" has the world's axes and units; its origin is near the camera. Cameras,
 * lights and environments also have a local space: the frame of the matrix at rtUseCamera,
 * rtUseLight or rtUseEnvironment. Colours are linear RGB.
 *
 * Threads: the functions of a class must be pure: the same input gives the same bytes.
 *   [render]  Batch functions (those with an RtsBatch) are called concurrently on different
 *             batches. `generate`, `illuminate` and `miss` are also called on the committing
 *             thread, between frames.
 *   [commit]  traits, prepare, medium and extent are called on the committing thread, before any
 *             frame uses the parameter values.
 * Host functions may be called only from a function of a class, on the thread that runs it.
 */
#ifndef OPENRT_OPENRTS_H
#define OPENRT_OPENRTS_H

#include <stddef.h>
#include <stdint.h>

#define RTS_MAGIC 0x5352544fu /* "OTRS" */
#define RTS_ABI_MAJOR 1       /* a host refuses another major number */
#define RTS_ABI_MINOR 3 /* grows with every field appended; a host accepts minors up to its own */
#define RTS_LANES 16

#ifdef __cplusplus
extern "C" {
#endif

typedef struct RtsHost RtsHost;
typedef struct RtsBatch RtsBatch; /* the host's state of one batch; passed back to host functions */
typedef uint32_t RtsTexture;      /* handle; 0: no texture */

/* Parameters --------------------------------------------------------------------------------------
 * A class declares a C struct; the host fills one struct for each shader. */

/* The C type of a parameter in the struct. */
typedef enum RtsType {
  RTS_INT = 1,                  /* int32_t */
  RTS_FLOAT,                    /* float */
  RTS_VEC2,                     /* float[2] */
  RTS_VEC3,                     /* float[3] */
  RTS_VEC4,                     /* float[4] */
  RTS_COLOR,                    /* float[3], linear RGB */
  RTS_MATRIX,                   /* float[16], column-major */
  RTS_FLOATS,                   /* RtsFloats */
  RTS_STRING,                   /* const char*, never NULL */
  RTS_TEXTURE,                  /* RtsTexture */
  RTS_TYPE_32_BITS = 0x7fffffff /* not a type: fixes the size of the enumeration */
} RtsType;

/* A list of numbers. Owned by the host; valid as long as the parameter struct. */
typedef struct RtsFloats {
  const float* data;
  uint32_t count;
} RtsFloats;

typedef struct RtsParam {
  const char* name; /* unique in the class */
  RtsType type;
  uint32_t offset;        /* bytes from the start of the parameter struct */
  float defaultValue[16]; /* for numbers; lists, strings and textures start empty */
  float minimum, maximum; /* inclusive range of every component; both 0: no range */
  const char* text;       /* one line for the user: meaning and unit */
} RtsParam;

/* Batches -------------------------------------------------------------------------------------- */

/* Bits of RtsHits.flags */
enum {
  /* The ray hits the back: the side that the geometric normal pointed away from before it was
   * turned. */
  RTS_HIT_BACK = 1,
  RTS_HIT_COLOR = 2,    /* the geometry has colours; `color` is interpolated (else 1 1 1 1) */
  RTS_HIT_TEXCOORD = 4, /* the geometry has texture coordinates (else uv is 0) */
  RTS_HIT_LINE = 8,     /* the hit is on a line or a point, not on a surface */
  /* The geometry has RT_CULL_FACE: the rays of paths pass its back, and only shadow rays to lights
   * without a surface hit it. */
  RTS_HIT_ONE_SIDED = 16
};

/* The hits of a batch: all have the same class, but not always the same parameter values. */
typedef struct RtsHits {
  uint32_t count;
  const float* position[3];  /* render space */
  const float* direction[3]; /* ray direction, unit, towards the surface */
  const float* geometric[3]; /* unit geometric normal, turned towards the ray's origin */
  const float* normal[3];    /* unit shading normal, on the same side as the geometric one */
  const float* uv[2];        /* texture coordinates */
  const float* color[4];     /* rgba of the geometry */
  const float* distance;     /* path length from the camera */
  const uint32_t* flags;     /* RTS_HIT_* */
  const void* const* params; /* the shader's parameter struct, for each lane */
  const float* segment;      /* length of the last ray of the path */
} RtsHits;

/* The result of `shade`. All arrays are zero on entry. */
typedef struct RtsShading {
  float* radiance[3];     /* leaving towards the ray's origin, already multiplied by opacity */
  float* transmission[3]; /* 0..1, fraction let through of the radiance straight behind the hit */
  float* albedo[3];       /* surface colour for the albedo channel; NULL where it is not rendered */
} RtsShading;

/* Lobes are the terms of a surface's BSDF. The shader only describes them; the engine's
 * transport computes direct light, follows mirror directions and samples the lobes. Weights are
 * linear, 0..1; the reflectances of one hit should add up to at most 1. The transports direct and
 * whitted evaluate direct light for every lobe that scatters (all except REFLECTION, DIELECTRIC and
 * TRANSPARENT) and spawn no rays from these lobes; path tracing samples them. */
typedef enum RtsLobeKind {
  RTS_LOBE_DIFFUSE = 1, /* Lambertian; weight: albedo */
  /* Perfect mirror; weight: reflectance for this direction, including Fresnel. */
  RTS_LOBE_REFLECTION,
  /* Smooth boundary of a clear medium: unpolarised Fresnel reflection and refraction. Weight: tint
   * of both. parameter[0]: relative index of refraction, the ray's side over the far side. If the
   * class has `medium`, the engine knows both indices and ignores the parameter. */
  RTS_LOBE_DIELECTRIC,
  RTS_LOBE_TRANSPARENT, /* passes straight through; weight: transmittance */
  /* The rough lobes are microfacet models after B. Walter et al., "Microfacet Models for
   * Refraction through Rough Surfaces", EGSR 2007 (GGX, Smith shadowing). alpha, 0..1, is the width
   * of the distribution of slopes; values below 1e-4 count as 1e-4. */
  /* Rough reflection. Weight: reflectance of a facet. parameter[0]: alpha. parameter[1]: relative
   * index of refraction (ray's side over far side), whose Fresnel reflectance multiplies the
   * weight; 0: no Fresnel factor. */
  RTS_LOBE_GLOSSY,
  /* Rough boundary of a clear medium: reflection and refraction at facets. Weight: tint of both.
   * parameter[0]: relative index as for DIELECTRIC; parameter[1]: alpha. */
  RTS_LOBE_ROUGH_DIELECTRIC,
  RTS_LOBE_CUSTOM, /* functions of the plug-in (RtsHost.customLobe) */
  RTS_LOBE_COUNT,
  RTS_LOBE_32_BITS = 0x7fffffff
} RtsLobeKind;

/* One lobe for every hit of a batch, made by RtsHost.lobe. A hit whose weight is 0 does not have
 * the lobe. Initially the weights and parameters are 0 and the normal is that of the hits; a shader
 * writes only what differs. */
#define RTS_MAX_LOBE_FLOATS 16
typedef struct RtsLobeFunctions RtsLobeFunctions;
typedef struct RtsLobe {
  RtsLobeKind kind;
  float* weight[3];
  float* normal[3]; /* unit, on the side of the hit's geometric normal */
  float* parameter[2];
  /* For RTS_LOBE_CUSTOM. */
  const RtsLobeFunctions* functions;
  float* data[RTS_MAX_LOBE_FLOATS]; /* the requested number of arrays, initially 0 */
  /* 1: the lobe is a coat over the batch's other lobes, such as varnish or a highlight,
   * whose light does not have the colour of the surface (RT_REFLECTION in frame.h). No picture of
   * RT_RGBA depends on it. Initially 0. */
  uint32_t coat;
} RtsLobe;

/* The functions of a custom lobe. They get n pairs of a hit of the batch (hit[i] is its
 * lane) and a direction. Directions are unit, in render space, and point away from the surface; the
 * direction towards the eye is -hits->direction. A lobe must be reciprocal unless it transmits, and
 * must conserve energy. Results for hits where the lobe's weight is 0 are ignored. The arrays of
 * these functions are not padded to RTS_LANES. [render] */
struct RtsLobeFunctions {
  uint32_t size;      /* sizeof(RtsLobeFunctions) */
  uint32_t transmits; /* 1: directions on the other side of the surface may have a value */
  /* Writes for each direction the BSDF times the cosine at the lobe's normal to `value` (the lobe's
   * weight is not included), and to `density` the pdf of `sample` with respect to solid angle, 0
   * where `sample` never returns the direction. */
  void (*evaluate)(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                   const float* const direction[3], float* const value[3], float* density);
  /* Samples a direction for each point of the unit square. Writes the direction, `quotient` =
   * `value` / pdf, and the pdf to `density`; a pdf of 0 means that no direction was sampled. */
  void (*sample)(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                 const float* const square[2], float* const direction[3], float* const quotient[3],
                 float* density);
};

/* The result of `surface` besides the lobes. All arrays are zero on entry. */
typedef struct RtsSurface {
  float* emission[3]; /* emitted radiance towards the ray's origin */
  float* albedo[3];   /* surface colour for the albedo channel; NULL where it is not rendered */
} RtsSurface;

/* Light from one light that arrives at the points of a batch. */
typedef struct RtsIllumination {
  /* Vector to the light. A light writes it in its local space with any length; a surface shader
   * reads it as a unit vector in render space. */
  float* toLight[3];
  /* Direct part: light colour x intensity x attenuation x cone; 0 outside the light's reach. It is
   * the radiance of a white Lambertian surface that faces the light. */
  float* color[3];
  float* ambient[3]; /* the same for the ambient part */
  int directional;   /* set by the light; 1: toLight has no end point, shadow rays are infinite */
} RtsIllumination;

/* Camera rays, in the camera's local space; the host transforms them to render space. */
typedef struct RtsRays {
  float* origin[3];
  float* direction[3]; /* unit */
} RtsRays;

/* The interior of a body whose surface has the shader, by colour channel; an index that
 * differs by channel is dispersion. Faces point outwards; equal media bound one body. Where bodies
 * overlap, that of the highest priority counts (C. Schmidt, B. Budge, "Simple Nested Dielectrics in
 * Ray Traced Images", JGT 7(2), 2002); boundaries of the others inside it are invisible. */
typedef struct RtsMedium {
  float index[3];      /* index of refraction, > 0 */
  float absorption[3]; /* per world unit of length; transmittance is exp(-absorption x length) */
  int32_t priority;
  /* The host sets them to 0 before it calls `medium`. A medium scatters in transports
   * that follow paths. In the others it attenuates light by both coefficients. */
  float scattering[3]; /* per world unit of length, >= 0: light that goes on in other directions */
  /* Mean cosine of the angle of scattering, -1 < g < 1; 0: all directions alike. The phase function
   * is that of L. Henyey and J. Greenstein, "Diffuse Radiation in the Galaxy", ApJ 93, 1941. */
  float anisotropy;
} RtsMedium;

/* The position and strength of a light in its local space, for selecting one of many
 * lights and for tracing paths that start at the light. */
typedef struct RtsExtent {
  int32_t parallel; /* 1: light falls along `direction` everywhere; 0: it comes from `position` */
  float position[3];
  float direction[3]; /* unit; axis of the lit cone */
  float cosine;       /* cosine of the cone's half angle; -1: the light shines in all directions */
  /* Estimate of the flux (parallel: of the irradiance), mean over the colour channels. */
  float power;
  float radius; /* nothing beyond this distance is lit; infinite if there is no limit */
} RtsExtent;

/* Where points appear in the picture. */
typedef struct RtsProjection {
  /* Pixels from the top left corner, as far as the camera has them also for points that are not in
   * the picture (RtsHost.pixels). */
  float* xy[2];
  /* Vector from the point to the sampled point on the lens; for parallel views a unit vector
   * towards the eye. */
  float* toEye[3];
  /* Pixels covered per unit of area of a surface at the point that faces the eye; 0: the point is
   * not in the picture. */
  float* weight;
  int parallel; /* set by the camera; 1: parallel view */
} RtsProjection;

/* Rays that a shader traces, from hits of its batch or from any other place. */
typedef struct RtsRequest {
  uint32_t count;
  /* Lane of the hit that each ray belongs to (in a transport: of the camera ray). */
  const uint32_t* hit;
  /* Render space. If origin[0] is NULL, the rays start at their hits, offset from the surface to
   * the side of the direction. */
  const float* origin[3];
  const float* direction[3]; /* unit */
  const float* length;       /* end of each ray, in world units; NULL: infinite */
} RtsRequest;

/* The first hits of rays. An array is NULL where the caller does not need it. Only `distance` is
 * written for rays that hit nothing. */
typedef struct RtsFound {
  float* distance;     /* from the ray's origin; infinite: nothing is hit */
  float* position[3];  /* render space */
  float* geometric[3]; /* unit geometric normal, turned towards the ray's origin */
  float* normal[3];    /* unit shading normal */
  uint32_t* name;      /* rtLoadName */
} RtsFound;

/* Classes -------------------------------------------------------------------------------------- */

typedef enum RtsKind {
  RTS_SURFACE = 1,
  RTS_LIGHT = 2,
  RTS_CAMERA = 3,
  RTS_ENVIRONMENT = 4,
  RTS_TRANSPORT = 5,
  RTS_KIND_32_BITS = 0x7fffffff /* not a kind: fixes the size of the enumeration */
} RtsKind;

/* Traits: bits that RtsClass.traits returns for one set of parameter values. */
enum {
  RTS_TRANSPARENT = 1, /* surface: transmission may be above 0; shadow rays then call `transmit` */
  RTS_UNLIT = 2,       /* surface: never evaluates lights */
  RTS_NO_SHADOW = 4,   /* light: casts no shadows */
  RTS_EMISSIVE = 8,    /* surface with `surface`: emission may be above 0 */
  /* The automatic choice of the transport depends on these. */
  RTS_SPECULAR = 16, /* surface: may have REFLECTION or DIELECTRIC lobes */
  RTS_GLOSSY = 32,   /* surface: may have scattering lobes other than DIFFUSE */
  RTS_GLOBAL = 64,   /* surface: needs indirect light, so path tracing is chosen */
  /* Hosts that do not know the following bits ignore them. */
  RTS_NO_SCATTER = 128, /* surface: only REFLECTION, DIELECTRIC and TRANSPARENT lobes */
  RTS_BACKDROP = 256,   /* environment: does not light surfaces that are shaded by `shade` */
  /* surface with RTS_EMISSIVE: each side emits the same radiance at all its points and in all
   * directions: it depends on the parameters only. The host then calls `surface` once for the light
   * samples of a shape. Has no effect on geometry with parameter values of its own. */
  RTS_UNIFORM_EMISSION = 512,
  /* surface with `medium`: only its medium acts on light, as in a cloud. Where the
   * indices of refraction on both sides are equal, the surface is invisible: no channel shows it,
   * and light samples pass through it. */
  RTS_MEDIUM_ONLY = 1024,
  /* surface and light: where both have it, the light's colour is its irradiance at a surface that
   * faces it, and not pi times as much: so lights of X3D 4 and glTF shine on physical materials. */
  RTS_IRRADIANCE = 2048
};

/* How often a parameter's value may change. Functions always find the value for a hit in
 * the hit's parameter struct. */
enum {
  RTS_PER_SHADER = 0,
  RTS_PER_TRIANGLE = 1, /* RTS_FLOAT to RTS_MATRIX only */
  RTS_PER_VERTEX = 2    /* interpolated; RTS_FLOAT to RTS_MATRIX only */
};

/* A shader class. Functions that the class does not have are NULL. */
typedef struct RtsClass {
  uint32_t size; /* sizeof(RtsClass) of the plug-in's header */
  RtsKind kind;
  const char* name;   /* unique in the plug-in */
  const char* text;   /* one line for the user: what the class is */
  uint32_t paramSize; /* bytes of the parameter struct */
  uint32_t paramCount;
  const RtsParam* params;
  /* Returns the RTS_* traits of a shader with these parameters. NULL: no traits. [commit] */
  uint32_t (*traits)(const RtsHost* host, const void* params);
  /* surface: writes radiance and transmission of every hit to out. [render] */
  void (*shade)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out);
  /* surface: writes only the transmission (0..1), for shadow rays. Only these parts of hits are
   * valid: position, direction, uv, color, flags and params. NULL: opaque. [render] */
  void (*transmit)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                   float* const transmission[3]);
  /* light: writes the illumination of n points in the light's local space to out. [render] */
  void (*illuminate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                     const float* const local[3], RtsIllumination* out);
  /* camera: writes the rays, in local space, of n points of the picture. xy: pixels from the top
   * left corner; size: width and height in pixels. [render] */
  void (*generate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                   const float* const xy[2], const float size[2], RtsRays* out);
  /* environment: writes the radiance (rgb) and opacity (a, 0..1) seen in n unit directions of its
   * local space. NULL: black, opacity 0. [render] */
  void (*miss)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
               const float* const direction[3], float* const rgba[4]);
  /* environment: fog between the camera and n hits. fromEye: vectors from the eye to the hits, in
   * local space. Writes the fog's colour and the fraction (0..1) of surface radiance that arrives.
   * NULL: no fog. [render] */
  void (*attenuate)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                    const float* const fromEye[3], float* const color[3], float* fraction);
  /* surface: describes every hit by lobes (RtsHost.lobe) and emission. If a class has
   * both this and `shade`, path tracing calls this and the other transports call
   * `shade`. [render] */
  void (*surface)(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out);
  /* RTS_PER_* for each parameter. NULL: all are RTS_PER_SHADER. */
  const uint8_t* frequency;
  /* Called once for each new set of parameter values, before any other function gets it. May write
   * the fields of the struct that are not parameters, for example tables computed from parameters;
   * they are zero before. Returns NULL, or an error message (static, or stored in the struct) that
   * the host logs. A surface is then drawn by the default surface shader; a light, camera,
   * environment or transport is left out. [commit] */
  const char* (*prepare)(const RtsHost* host, void* params);
  /* Frees what `prepare` allocated. Called once when neither the scene nor a frame uses the
   * values, also if `prepare` returned a message; on any thread. */
  void (*release)(const RtsHost* host, void* params);
  /* surface: returns 1 and writes the interior of the body; 0: it has no interior. [commit] */
  int (*medium)(const RtsHost* host, const void* params, RtsMedium* out);
  /* light: returns 1 and writes its extent; 0: unknown. [commit] */
  int (*extent)(const RtsHost* host, const void* params, RtsExtent* out);
  /* camera: the inverse of `generate`: projects n points of the camera's local space to the
   * picture. lens: a point of the unit square for each. [render] */
  void (*project)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                  const float* const local[3], const float* const lens[2], const float size[2],
                  RtsProjection* out);
  /* transport: computes radiance (rgb) and alpha of n camera rays with RtsHost.trace, findHit,
   * occluded and random. [render] */
  void (*radiance)(const RtsHost* host, RtsBatch* batch, const void* params, const RtsRequest* rays,
                   float* const rgba[4]);
  /* light: looks along n rays of the light's local space for its luminous opening, the bright face
   * that is seen where the light hangs. The camera sees it straight, in mirrors and through glass.
   * It is opaque there, and nowhere else: it blocks no light and sends none, because that is
   * `illuminate`. Directions have any length. Writes to `distance` how many lengths of its
   * direction each ray goes to the opening, infinite if it does not meet it, and the radiance that
   * the ray sees there. NULL: no opening. [render] */
  void (*opening)(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                  const float* const origin[3], const float* const direction[3], float* distance,
                  float* const radiance[3]);
} RtsClass;

typedef struct RtsPlugin {
  uint32_t magic; /* RTS_MAGIC */
  uint16_t major, minor;
  uint32_t size; /* sizeof(RtsPlugin) */
  uint32_t classCount;
  const RtsClass* const* classes;
} RtsPlugin;

/* Host: the functions that a shader may call ------------------------------------------------------
 * Functions with an RtsBatch take the batch that was passed to the running batch function, and the
 * hits that were passed with it. */

struct RtsHost {
  uint32_t size;
  uint16_t major, minor;
  /* Returns the number of lights to evaluate for the batch. The host may let one of them stand for
   * many: it then selects a light for each hit and divides by the selection probability. 0 where
   * the host asks only for transmission and albedo; rays traced by `trace` are black then. */
  uint32_t (*lights)(RtsBatch* batch);
  /* Evaluates light i (0 <= i < lights) at the hits, without shadows. Sets the pointers of out to
   * arrays of the host, valid until the next call for this batch. */
  void (*illuminate)(RtsBatch* batch, uint32_t i, const RtsHits* hits, RtsIllumination* out);
  /* Traces shadow rays from the hits to light i and multiplies light->color by the transmittance
   * (by colour). wanted[lane] is 0 for lanes to skip, 1, or 2 if the light comes through the
   * surface. Must follow illuminate(i). Does nothing if shadows are off. */
  void (*shadow)(RtsBatch* batch, uint32_t i, const RtsHits* hits, const uint8_t* wanted,
                 RtsIllumination* light);
  /* Writes filtered texels at n texture coordinates: rgba, linear; grey is replicated, a missing
   * alpha is 1. Texture 0 gives 1 1 1 1. */
  void (*sample)(RtsBatch* batch, RtsTexture texture, uint32_t n, const float* const uv[2],
                 float* const rgba[4]);
  /* Returns the number of components (1..4) of a texture, 0 for texture 0. */
  uint32_t (*components)(const RtsHost* host, RtsTexture texture);
  /* Returns n floats (rounded up to RTS_LANES), aligned and uninitialised. Never NULL; freed when
   * the batch function returns. */
  float* (*scratch)(RtsBatch* batch, uint32_t n);
  /* Passes a message to the application's log callback. level: 0 debug to 3 error. */
  void (*log)(const RtsHost* host, int level, const char* utf8);
  /* For `surface`: adds a lobe to the batch's hits and returns it. The host owns it.
   * Returns NULL for an unknown kind and after RTS_MAX_LOBES lobes of a batch. */
  RtsLobe* (*lobe)(RtsBatch* batch, RtsLobeKind kind);
  /* As `lobe`, for a custom lobe with a number of floats (at most RTS_MAX_LOBE_FLOATS) per hit. */
  RtsLobe* (*customLobe)(RtsBatch* batch, const RtsLobeFunctions* functions, uint32_t floats);
  /* Writes a point of the unit square for each hit (camera: each point of the picture; transport:
   * each ray). Every pair (0..3) is a sequence of its own, well distributed over the samples of a
   * pixel and the same whenever the picture is rendered. A call makes the pixel's value a Monte
   * Carlo estimate. The points are (0.5, 0.5) in the functions of an environment and in `project`.
   */
  void (*random)(RtsBatch* batch, uint32_t pair, float* const square[2]);
  /* For `shade` and `radiance`: writes the radiance (and, if rgba[3] is not NULL, the alpha) that
   * arrives along rays, shaded by the engine. May nest up to the depth limit, at most 64 times;
   * black beyond. */
  void (*trace)(RtsBatch* batch, const RtsRequest* rays, float* const rgba[4]);
  /* Writes the first hit of each ray. */
  void (*findHit)(RtsBatch* batch, const RtsRequest* rays, RtsFound* out);
  /* Writes the transmittance (by colour, 0..1) between each ray's origin and end: 0 where blocked.
   */
  void (*occluded)(RtsBatch* batch, const RtsRequest* rays, float* const transmission[3]);
  /* The following functions describe hits. The functions of cameras, environments and transports
   * have no hits: for each of their n points, directions or rays the host then writes a throughput
   * of 1, and 0 for everything else. */
  /* Writes position and geometric normal (not unit) of the hits in the frame of the object
   * (rtBeginObject) that the surface belongs to, which rtInstantiateObject places. Either may be
   * NULL. */
  void (*local)(RtsBatch* batch, float* const position[3], float* const normal[3]);
  /* Writes the derivatives of the hits' position with respect to the texture coordinates, in render
   * space; 0 without texture coordinates. */
  void (*derivatives)(RtsBatch* batch, float* const alongS[3], float* const alongT[3]);
  /* Writes rtLoadName, outermost instance and triangle (as in RThit) of the hits. Each may be NULL.
   */
  void (*ids)(RtsBatch* batch, uint32_t* name, uint32_t* instance, uint32_t* primitive);
  /* Writes for each hit the number of surfaces that the path hit before, and the path throughput:
   * the fraction of radiance that reaches the camera. Either may be NULL. */
  void (*path)(RtsBatch* batch, uint32_t* depth, float* const throughput[3]);
  /* Writes a bound of the rounding error of the hits' positions along the geometric normal, in
   * world units. */
  void (*error)(RtsBatch* batch, float* error);
  /* For `miss`: writes 1 for each direction that is seen as a backdrop: the ray comes
   * from the camera and has passed transparent surfaces at most. Writes 0 for directions from which
   * light is wanted: those of mirrored, refracted and scattered rays and of light samples. */
  void (*backdrop)(RtsBatch* batch, uint32_t* seen);
  /* As `sample`, at n texture coordinates of three numbers (s, t, r), for a texture that may be a
   * volume (rtTexImage3D). A texture without depth ignores r; `sample` sees the first slice of a
   * volume. */
  void (*sampleVolume)(RtsBatch* batch, RtsTexture texture, uint32_t n, const float* const str[3],
                       float* const rgba[4]);
  /* Writes where n points (render space) are in the picture, in pixels from its top left corner:
   * where the camera sees them through the middle of its lens, or would if nothing hid them. The
   * place depends on the point alone, so it is the same for mirrored and shadow rays. Points beside
   * the picture have places beside it; one that has none gets 0 0. Returns 0, and writes nothing,
   * if the camera's class has no `project`. */
  int (*pixels)(RtsBatch* batch, uint32_t n, const float* const position[3], float* const xy[2]);
};
#define RTS_MAX_LOBES 8

#if defined(_WIN32)
#define RTS_EXPORT __declspec(dllexport)
#else
#define RTS_EXPORT __attribute__((visibility("default")))
#endif
/* The only symbol that the host looks up in a plug-in:
 *   RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC,         RTS_ABI_MAJOR, RTS_ABI_MINOR,
 *                                           sizeof(RtsPlugin), n,             classes}; */
#define RTS_ENTRY_NAME "rtsPlugin"

#ifdef __cplusplus
}
#endif
#endif
