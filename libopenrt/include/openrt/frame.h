/* frame.h: frames, quality settings, pixels, error bars, statistics (OpenRT, C99). openrt.h states
 * the conventions. docs/error-bars.md explains how errors are estimated.
 */
#ifndef OPENRT_FRAME_H
#define OPENRT_FRAME_H

#include "openrt/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Frames --------------------------------------------------------------------------------------- */

/* Channels of a frame, to be or'ed. The number in front is that of floats per pixel. "First sample"
 * is the first of the pixel's samples. */
enum {
  RT_RGBA = 1,       /* 4: mean radiance; alpha, which is 1 where the environment shows or a surface
                           is opaque */
  RT_DEPTH = 2,      /* 1: distance along the view axis (RT_DEPTH_ALONG: along the ray), first
                           sample; infinite if nothing is hit */
  RT_NORMAL = 4,     /* 3: mean shading normal in world space, towards the camera; 0 0 0 if nothing
                           is hit */
  RT_ALBEDO = 8,     /* 3: mean surface colour as the shader reports it */
  RT_POSITION = 16,  /* 3: world-space position of the hit, first sample */
  RT_NAME = 32,      /* 1: name (rtLoadName) of the hit, first sample; 0 if nothing is hit. Names
                           above 2^24 are rounded to floats, also in RT_COVERAGE */
  RT_SAMPLES = 64,   /* 1: number of samples taken */
  RT_VARIANCE = 128, /* 3: sample variance of radiance; divided by the number of samples it is the
                           variance of the mean */
  RT_ERROR = 256,    /* 3: half-width of the 95 % confidence interval of each colour; infinite if
                           nothing is known */
  RT_TRUST = 512,    /* 1: 1 if that interval can be trusted, else 0 */
  /* 3: world-space vector from where the hit point of the first sample was in the previous frame of
   * this context (with RT_VIEW: of this view) to where it is now: how its instance moved, or its
   * vertices. 0 0 0 if nothing moved or nothing is hit; not a number if the point did not exist or
   * was invisible in the previous frame, and everywhere in the first one. The motion of the camera
   * is not part of it. Where an object was defined again, geometries and instances of the same name
   * (rtLoadName) are the same if there are as many as before and their indices and objects are
   * equal. */
  RT_MOTION = 1024,
  /* 3: the part of the radiance that coats reflect, which does not have the colour of the surface:
   * varnish, lacquer, highlights of VRML97. It is the light that the first surface of a path,
   * besides mirrors and clear things, reflects by a lobe that its shader calls a coat
   * (RtsLobe.coat); with the transport whitted only mirror images, with direct nothing. Light that
   * paths from lamps bring is not part of it, and RT_CLAMP does not change it. For callers that
   * rebuild pictures from few samples. */
  RT_REFLECTION = 2048,
  /* 16: eight pairs of a name (rtLoadName), which is not 0, and the share of the pixel's samples
   * that hit it first, 0 .. 1; the largest share first, equal shares by name. Pairs that are not
   * used are 0 0. rtUniteNames makes several names one. In a pixel with more than 1,024 names,
   * those with the smallest numbers are counted. */
  RT_COVERAGE = 4096,
  /* 2: where in the pixel the first sample was taken, 0 .. 1 from its left and from its upper edge.
   * For callers that rebuild pictures from few samples. */
  RT_PLACE = 8192
};
/* Values of RTchannelInfo.kind: what the floats of a channel are. */
enum {
  RT_CHANNEL_NUMBERS = 0, /* any numbers */
  RT_CHANNEL_COUNTS = 1,  /* whole numbers */
  RT_CHANNEL_NAMES = 2,   /* names (rtLoadName), which are whole numbers */
  RT_CHANNEL_SHARES = 3   /* pairs of a name and a share */
};

/* Settings of rtQuality and rtQualityf. */
enum {
  RT_SAMPLES_PER_PIXEL = 1, /* 1 .. 65536, default 16 */
  RT_MAX_DEPTH = 2,         /* most surfaces on a path that bend light, 0 .. 10000, default 25 */
  RT_SEED = 3,              /* default 0 */
  RT_SHADOWS = 4,           /* 1 (default) or 0 */
  RT_TRANSPORT = 5,         /* one of RT_TRANSPORT_* below, default RT_TRANSPORT_AUTO */
  /* Independent replicates of a pixel's samples, 1 .. 1024. 0 (default): 16 to 31 if RT_ERROR,
   * RT_TRUST, a target error or a time limit is asked for and there are at least 32 samples, else
   * one. */
  RT_REPLICATES = 6,
  /* rtQualityf: 0 .. 1; 0 (default): none. Each part of the picture is sampled until the mean over
   * its pixels of (RT_ERROR summed over the colours) / (colours summed + 0.03), at most 1 a pixel,
   * is about this value, or RT_SAMPLES_PER_PIXEL samples have been taken. */
  RT_TARGET_ERROR = 7,
  /* rtQualityf: seconds, 0 .. 1e6; 0 (default): none. The picture is made in rounds until so many
   * seconds have passed since the frame was started. It depends on the speed of the machine. */
  RT_TIME_LIMIT = 8,
  /* rtQualityf: 0 .. 1, default 1/4096. The transport whitted ends branches that carry less than
   * this fraction of the camera ray. */
  RT_ENERGY_CUT = 9,
  /* rtQualityf: upper bound of a sample's radiance in each colour; 0 (default): none. It biases the
   * picture; RTstats.leftOut.clipped tells by how much. */
  RT_CLAMP = 10,
  /* 0 (default) or 1: the whole picture is made early and then improved, for callers of rtSnapshot.
   * The finished picture has the same bytes. It takes a few per cent longer. */
  RT_PROGRESSIVE = 11,
  /* backend=cluster: number of frames that rtSwapBuffers leaves unfinished, 1 (default) .. 64. It
   * takes effect at once and does not change pictures. */
  RT_FRAMES_IN_FLIGHT = 12,
  /* Edge of tiles in pixels, 4 .. 128; 0 (default): chosen by picture size and samples. Errors are
   * judged tile by tile. */
  RT_TILE_SIZE = 13,
  /* 0 (default) or 1: RT_DEPTH, RT_NORMAL, RT_ALBEDO, RT_POSITION, RT_NAME, RT_MOTION and
   * RT_COVERAGE tell about what is seen in mirrors and through smooth glass instead of about the
   * mirror or the glass. The position is then that of the image: on the ray of the camera, as far
   * away as the light has travelled. Normal and motion are those of the image, the name is that of
   * the shape that is seen, and the albedo is multiplied by what the mirrors and the glass let
   * through. For callers that rebuild pictures from few samples. It changes no other channel. */
  RT_FOLLOW_IMAGES = 14,
  /* 0 (default) or 1: a picture with one sample per pixel takes it anywhere in the pixel, as chosen
   * by the seed, and not in the middle. The first samples of consecutive seeds fill the pixel
   * evenly: each 2^k of them, from a multiple of 2^k on, are a (0,k,2)-net. For callers that
   * combine frames of several seeds. */
  RT_JITTER = 15,
  /* 1 (default) .. 4: light is followed in one pixel of each block of so many pixels each way. The
   * others take one sample: they have the channels of its first hit, no colour and RT_SAMPLES 0, or
   * the environment's colour and RT_SAMPLES 1 if they see it directly. Consecutive seeds choose
   * each pixel of a block in turn. With RT_TRANSPORT_LIGHT, paths from lamps add their light to the
   * others alone, so that the light of a block is that of its pixel plus the mean of the others.
   * For callers that rebuild pictures from few samples. Frames with error bars, a target error, a
   * time limit or a transport of a plug-in follow light in every pixel. */
  RT_LIGHT_STRIDE = 16,
  /* 0 (default) .. 2147483647: the sequence of frames that a frame belongs to. RT_MOTION tells the
   * motion since the frame before of the same sequence, so that several views of a scene can be
   * rendered in turns. A sequence begins anew, with everything new, after 32 frames of others, and
   * if its last frame lacked RT_MOTION and something moved for a frame of another one. It changes
   * no other channel. */
  RT_VIEW = 17,
  /* One of RT_MEASURE_* below, default RT_MEASURE_NOTHING: each pixel is the reading of a
   * photometric sensor instead of a part of a picture. */
  RT_MEASURE = 18,
  /* Says what RT_DEPTH measures: one of RT_DEPTH_ALONG_*, default RT_DEPTH_ALONG_AXIS. */
  RT_DEPTH_ALONG = 19,
  /* rtQualityf: seconds, 0 .. 3600, that a frame waits while acceleration structures are built; 0
   * (default): until they are. After that time building goes on beside the frame, which shows the
   * scene of an earlier commit, with the settings and the places of the camera and of lights of its
   * own commit; the camera's parameters, as its angle of view, are those of before, too.
   * RTstats.outdated says so. Once they are built, the next frame shows them; the edits of later
   * commits follow in the frame after it. Alone, moved instances never wait: only new geometry
   * does, geometry that is defined again, and instances that come or go. A frame waits all the same
   * if there is no earlier scene, if its camera has another shader, if its RT_VIEW is another than
   * that of the frame before, if the edits that wait take more than 128 MB, and after rtKeepSums;
   * so do ray queries. It takes effect at once, and is no part of frames and recordings. With
   * backend=cluster frames wait. */
  RT_PATIENCE = 20
};

/* Values of RT_DEPTH_ALONG: what RT_DEPTH is, in units of the world. */
enum {
  /* The distance along the view axis: from the plane through the camera that is parallel to its x
   * and y axes. Also where the camera's matrix shears the picture. */
  RT_DEPTH_ALONG_AXIS = 0,
  /* The distance along the ray of the sample, from the point of the ray that is nearest to the
   * camera: the camera itself if its rays begin there (a pinhole, a panorama), the plane above if
   * they are parallel to the axis. */
  RT_DEPTH_ALONG_RAY = 1
};
/* Values of RT_MEASURE: what the pixels of a frame are. Every sample of a sensor uses the camera's
 * ray through the middle of its pixel, so that an orthographic camera is a grid of points. Red,
 * green and blue of RT_RGBA are all the reading, and those of RT_ERROR its half-width. Units: a
 * radiance of 1 in all three colours is a luminance of 1 cd/m2, and the unit of length is the
 * metre. A colour counts as 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R BT.709, luminance of
 * linear sRGB).
 *
 * The variance of a reading is that of its own replicates; it is not pooled with neighbouring
 * pixels. Channels of first hits are 0 for RT_MEASURE_ILLUMINANCE.
 *
 * Sensors follow paths (RT_TRANSPORT_PATH) where the transport is RT_TRANSPORT_AUTO. Under
 * RT_TRANSPORT_LIGHT, illuminances include light that lamps send by way of mirrors and glass: paths
 * from lamps add their flux to the cells that they cross. A cell is the part of the camera's plane
 * that a pixel covers, and this light is its mean over the cell; all other light is that at the
 * point. The camera must have parallel rays that start in a plane across them, as an orthographic
 * one. Other sensors follow paths then, too (RTstats.transport.chosen tells it). */
enum {
  RT_MEASURE_NOTHING = 0, /* pixels are those of a picture */
  /* Luminance in cd/m2 of the light that arrives at the origin of the ray against its direction. */
  RT_MEASURE_LUMINANCE = 1,
  /* Illuminance in lux at the origin of the ray, of a plane whose normal is the ray's direction:
   * light of the half space that the ray points to. A point on a surface must lie a little off it.
   */
  RT_MEASURE_ILLUMINANCE = 2
};

/* Light transports: how light is followed from surfaces whose shaders answer in lobes (openrts.h).
 */
enum {
  /* The cheapest transport that leaves out nothing which the scene's lobes do with light.
   * RTstats.transport.chosen tells which one that is. */
  RT_TRANSPORT_AUTO = 0,
  /* Light that comes straight from lights. No mirror images, nothing behind glass. */
  RT_TRANSPORT_DIRECT = 1,
  /* Direct light and the whole tree of reflections and refractions, without random decisions
   * (T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980). */
  RT_TRANSPORT_WHITTED = 2,
  /* Path tracing: also light between diffuse surfaces. Unbiased, with noise. */
  RT_TRANSPORT_PATH = 3,
  /* Path tracing, and light tracing for caustics: light of lamps that mirrors or lenses send to
   * surfaces which the camera sees directly, also of lights without extent. */
  RT_TRANSPORT_LIGHT = 4
};
/* Bits of RTstats.transport.leavesOut: light of the scene that the transport does not follow.
 * Images in mirrors and glass; light between surfaces; surfaces that emit; light of the
 * environment; light of lamps that mirrors or lenses send. */
enum {
  RT_LEAVES_IMAGES = 1,
  RT_LEAVES_BETWEEN = 2,
  RT_LEAVES_EMITTERS = 4,
  RT_LEAVES_SKY = 8,
  RT_LEAVES_CAUSTICS = 16
};

/* A quality setting, its range and its default. The library owns the texts, which are constants. */
typedef struct RTqualityInfo {
  size_t size;      /* Set it to sizeof(RTqualityInfo) before the call. */
  RTenum quality;   /* RT_SAMPLES_PER_PIXEL ... */
  const char* name; /* for people and command lines: "samples" ... */
  int isReal;       /* 1 if rtQualityf sets it, 0 if rtQuality does */
  double minimum, maximum, defaultValue;
  int zeroIsAuto;      /* 1 if 0 is allowed outside of the range: the library then decides */
  const char* choices; /* names of the values minimum, minimum + 1 ... with blanks between them;
                          NULL if the values have no names */
  const char* text;    /* a description for people */
} RTqualityInfo;
/* Writes what is known about quality setting number 0, 1 ... Returns 1, or 0 if there are not so
 * many, or if info is NULL or info->size is not set. Works without a context. [any-thread] */
RT_API int rtGetQualityInfo(int number, RTqualityInfo* info);
/* Returns 1 if rtQuality or rtQualityf accepts the value for the quality setting, else 0, also for
 * an unknown setting. Works without a context. [any-thread] */
RT_API int rtIsQualityAllowed(RTenum quality, double value);

/* A light transport. The library owns the texts, which are constants for people. */
typedef struct RTtransportInfo {
  size_t size;      /* Set it to sizeof(RTtransportInfo) before the call. */
  RTenum transport; /* RT_TRANSPORT_AUTO ... */
  const char* name; /* also for command lines: "auto", "direct" ... */
  const char* text; /* the light that it follows; "and ..." adds to the transport before */
  /* The light that its pictures have, and how exactly. {depth} stands for the value of
   * RT_MAX_DEPTH, {shadows} for "with shadows" or "without shadows". */
  const char* claim;
  int tracesPaths; /* 1 if it follows light between surfaces, with random decisions; else 0 */
  int tracesLamps; /* 1 if it also traces paths that start at lamps; else 0 */
  uint32_t omits;  /* RT_LEAVES_* bits: kinds of light that it does not follow everywhere.
                      RTstats.transport.leavesOut tells which of these a scene has. */
} RTtransportInfo;
/* Writes what is known about a transport (RT_TRANSPORT_*; the numbers are 0, 1 ... without a gap).
 * Returns 1, or 0 if there is no such transport, or if info is NULL or info->size is not set. Works
 * without a context. [any-thread] */
RT_API int rtGetTransportInfo(RTenum transport, RTtransportInfo* info);

/* A channel of frames. The library owns the texts, which are constants. */
typedef struct RTchannelInfo {
  size_t size;        /* Set it to sizeof(RTchannelInfo) before the call. */
  RTenum channel;     /* RT_RGBA ... */
  const char* name;   /* for people and command lines: "rgba", "z" ... */
  int components;     /* floats per pixel */
  const char* planes; /* names of the floats in OpenEXR files, with blanks between them */
  RTenum kind;        /* one of RT_CHANNEL_* */
  const char* text;   /* the rest of a sentence that begins with the name; NULL if the name says
                         enough */
} RTchannelInfo;
/* Writes what is known about channel number 0, 1 ... Returns 1, or 0 if there are not so many, or
 * if info is NULL or info->size is not set. Works without a context. [any-thread] */
RT_API int rtGetChannelInfo(int number, RTchannelInfo* info);

/* Sets size (1 .. 65536 pixels each way, at most 2^28 in all) and channels of the frames that
 * follow. [context-thread] */
RT_API void rtFrameBuffer(int width, int height, uint32_t channels);
/* Unites names in the channel RT_COVERAGE of the frames that follow, so that a thing of many parts
 * has one share: name i counts as names[i], and is not counted if that is 0. Names from count on
 * count as themselves. It changes no other channel. The array is copied; count 0 (the default):
 * none are united. count: at most 2^24. [context-thread] */
RT_API void rtUniteNames(const uint32_t* names, size_t count);
/* Limits the frames that follow to a rectangle of their pixels, rows from the top. Its pixels are
 * those of the whole frame in every channel, and take their share of the time (paths from lamps are
 * traced for the whole frame). The contents of the channels outside of it are undefined. The
 * rectangle is cut off at the border of the frame; one that lies outside gives a frame without
 * samples. width and height 0 (the default): the whole frame. x and y: 0 .. 65535; width and
 * height: 0 .. 65536, both 0 or both above 0. Two results follow from more than the rectangle: a
 * target error (RT_TARGET_ERROR) shares the samples out over what is made, and at the border of
 * the frame RT_ERROR and RT_TRUST of constant pixels depend on the range of its colours.
 * [context-thread] */
RT_API void rtScissor(int x, int y, int width, int height);
/* Set a quality setting of the frames that follow. [context-thread] */
RT_API void rtQuality(RTenum name, int value);
RT_API void rtQualityf(RTenum name, double value);
/* Commits the edits, waits for the frame in flight, makes it the one that rtReadPixels reads, and
 * starts the next one. Needs a frame buffer and no open definition (else RT_INVALID_OPERATION).
 * With backend=cluster the next frame starts first, and the call waits for the oldest one only
 * while more than RT_FRAMES_IN_FLIGHT are unfinished; RTstats.frame tells which one was finished
 * last. [context-thread] */
RT_API void rtSwapBuffers(void);
/* Waits for the oldest frame in flight and makes it the one that rtReadPixels reads. Returns 1, or
 * 0 if none is in flight. [context-thread] */
RT_API int rtFinishFrame(void);
/* Commits the edits, renders and waits. rtReadPixels then reads this frame. Needs what
 * rtSwapBuffers needs. [context-thread] */
RT_API void rtRender(void);
/* Ends the frames in flight early. Their pictures hold the tiles that are finished. [any-thread] */
RT_API void rtCancel(RTcontext context);
/* Returns which fraction of the oldest frame in flight is done, 0 to 1. [any-thread] */
RT_API float rtProgress(RTcontext context);
/* Copies one channel of the oldest frame in flight, as far as it is finished, laid out as by
 * rtReadPixels. Unfinished tiles are 0 (RT_DEPTH: infinite); tiles of a frame in rounds have what
 * has been made so far. count is the number of floats that out has room for. Returns 1, or 0 if no
 * frame with this channel and at most count floats is in flight. [any-thread] */
RT_API int rtSnapshot(RTcontext context, RTenum channel, float* out, size_t count);
/* Copies one channel of the finished frame: width * height * components floats, first row at the
 * top. count is the number of floats that out has room for. [context-thread] */
RT_API void rtReadPixels(RTenum channel, float* out, size_t count);

/* Statistics, by subject ----------------------------------------------------------------------- */

typedef struct RTsceneStats {
  uint64_t triangles, uniqueTriangles, objects, instances, lights, textures;
} RTsceneStats;

/* Input that is not used. */
typedef struct RTrejectedStats {
  uint64_t primitives; /* degenerate primitives, which were dropped */
  uint64_t instances;  /* instances whose matrix is singular or out of range */
  uint64_t rays;       /* rays that were not finite */
  uint64_t hits;       /* hits of slivers that single precision reported and double precision
                          refuted (docs/decisions/0041) */
} RTrejectedStats;

/* Seconds. */
typedef struct RTtimeStats {
  double commit, build, render;
} RTtimeStats;

typedef struct RTrayStats {
  uint64_t camera, shadow, secondary;
} RTrayStats;

/* The acceleration structures. */
typedef struct RTbvhStats {
  uint64_t bytes;
  uint64_t objectBuilds;   /* structures built for objects (or for merged static ones) since the
                              context was made; those that are refitted do not count */
  uint64_t topLevelBuilds; /* times the top level above them was built or refitted */
} RTbvhStats;

typedef struct RTmachineStats {
  uint32_t threads;
  char isa[16];    /* instruction set of the ray kernels, for example "avx2" */
  char kernel[32]; /* for example "Embree 3.13.5" */
} RTmachineStats;

/* The light transport of the last frame. */
typedef struct RTtransportStats {
  RTenum chosen;            /* RT_TRANSPORT_* that made the frame */
  char reason[192];         /* the reason for people */
  uint32_t leavesOut;       /* RT_LEAVES_* bits */
  uint64_t unreachedLights; /* lights whose rays by way of mirrors or glass are not followed;
                               RT_TRANSPORT_LIGHT follows them if the class of the light has an
                               extent and that of the camera has project */
} RTtransportStats;

/* The error of the picture as a whole. The error of a pixel is (errors of the colours summed) /
 * (colours summed + 0.03), at most 1. */
typedef struct RTerrorStats {
  double mean;         /* estimate of the mean over the pixels of their true error */
  double meanInterval; /* With 95 % probability that mean lies in mean +- this. */
  double halfWidth;    /* mean over the pixels of RT_ERROR; RT_TARGET_ERROR is compared to it */
  double p99;          /* RT_ERROR that 99 % of the pixels stay below */
  double level;        /* 0.95 */
  uint64_t pixels;     /* finished pixels, which these numbers are about; 0 without RT_VARIANCE or
                          RT_ERROR */
  uint64_t trusted;    /* number of them with RT_TRUST 1 */
  double unmet;    /* radiance that may be missing, with 95 %: paths meet it by chance alone, and
                      few have met it */
  char method[48]; /* "replicated nets, Student's t", "sample variance" or "" */
} RTerrorStats;

/* Light that is left out, as a mean over the pixels of the sum over the colours. No error bar
 * covers it. */
typedef struct RTleftOutStats {
  double cutByDepth;  /* throughput of paths that RT_MAX_DEPTH ended, and of paths and shadow rays
                         after 512 straight passages; times the radiance beyond it is the loss */
  double cutByEnergy; /* the same of branches that RT_ENERGY_CUT ended */
  double clipped;     /* radiance that RT_CLAMP took away */
  uint64_t shaderFaults; /* hits at which a shader returned NaN or infinity, which counts as 0; the
                            log names the class */
} RTleftOutStats;

/* backend=cluster, since the context was made; else 0. A tile here is a job, which may be a part
 * of a tile. */
typedef struct RTclusterStats {
  uint32_t workers;                 /* connected workers, without this process */
  uint64_t tilesRemote, tilesLocal; /* done by workers; done by this process */
  uint64_t reissued;                /* jobs given out again because they were late or lost */
  uint64_t duplicates;              /* results that came after the job had been done */
  uint64_t bytesSent, bytesReceived;
} RTclusterStats;

/* Statistics of the scene and of the last frame. */
typedef struct RTstats {
  size_t size;    /* Set it to sizeof(RTstats) before the call. */
  uint64_t frame; /* number of the finished frame, counted from 1; 0 if there is none */
  RTsceneStats scene;
  RTrejectedStats rejected;
  RTtimeStats time;
  RTrayStats rays;
  RTbvhStats bvh;
  RTmachineStats machine;
  RTtransportStats transport;
  RTerrorStats error;
  RTleftOutStats leftOut;
  RTclusterStats cluster;
  uint32_t outdated; /* 1 if the last frame did not wait for its scene and shows an earlier one, of
                        which the statistics then are (RT_PATIENCE); else 0 */
} RTstats;
/* Writes the statistics of the last commit and of the last finished frame. [context-thread] */
RT_API void rtGetStats(RTstats* stats);

#ifdef __cplusplus
}
#endif
#endif
