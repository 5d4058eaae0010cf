/* xscript.h: the SDK of script engines (C99, needs nothing but itself): what runs the Script nodes
 * of a VRML97 world (ISO/IEC 14772-1 4.12, 6.40) in some language.
 *
 * A plug-in is a shared library that exports one constant, `xsPlugin`, and links against nothing of
 * XVRML: what it needs of the host comes as a table of functions. It has engines; an engine makes
 * an interpreter for each Script node. Nodes are numbers (handles), values are plain typed arrays,
 * texts are counted UTF-8: nothing that crosses this border points into the scene graph, so an
 * engine can pass all of it on to another process.
 *
 * Thread: every function of both tables, host's and engine's, on the browser's thread. The host
 * never calls an interpreter while one of its functions, or another interpreter's, is running:
 * events that a script causes are delivered after it has returned. Nothing is thrown across this
 * border, and no function ends the process.
 *
 * Versions: structures grow at their end only, and begin with their size, so that each side knows
 * what the other has.
 */
#ifndef XVRML_XSCRIPT_H
#define XVRML_XSCRIPT_H

#include <stddef.h>
#include <stdint.h>

#define XS_MAGIC 0x50435358u /* "XSCP" */
#define XS_ABI_MAJOR 1       /* a host refuses another major number */
#define XS_ABI_MINOR 1 /* grows with every field appended; a host accepts minors up to its own */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct XsHost XsHost;

/* A node. 0 is VRML's NULL. A Script knows the nodes it was given: in its fields, in events, by
 * what it read or made; a number that it was not given is refused. A number is good until the
 * engine's function returns in which it was given; `retain` keeps it longer. While it is good, a
 * node has one number for a Script. The number of the Script's own node is always good. */
typedef uint64_t XsNode;

/* Values
 * -----------------------------------------------------------------------------------------------------------------
 */

/* Type: what an array's element is in C */
typedef enum XsType {
  XS_SFBOOL = 1, /* int32_t, 0 or 1 */
  XS_SFCOLOR,    /* float[3], rgb */
  XS_SFFLOAT,    /* float */
  XS_SFIMAGE,    /* XsImage */
  XS_SFINT32,    /* int32_t */
  XS_SFNODE,     /* XsNode */
  XS_SFROTATION, /* float[4]: axis, angle in radians */
  XS_SFSTRING,   /* XsString */
  XS_SFTIME,     /* double, seconds */
  XS_SFVEC2F,    /* float[2] */
  XS_SFVEC3F,    /* float[3] */
  XS_MFCOLOR,    /* from here on: any number of the elements above */
  XS_MFFLOAT,
  XS_MFINT32,
  XS_MFNODE,
  XS_MFROTATION,
  XS_MFSTRING,
  XS_MFTIME,
  XS_MFVEC2F,
  XS_MFVEC3F,
  XS_TYPE_32_BITS = 0x7fffffff /* no type: fixes the size of the enumeration */
} XsType;

/* UTF-8. From the host it also ends with a zero byte, which `bytes` does not count. */
typedef struct XsString {
  const char* data;
  uint64_t bytes;
} XsString;

/* Rows from the bottom, `components` (0 to 4) bytes a pixel: width * height * components bytes in
 * all. */
typedef struct XsImage {
  int32_t width, height, components;
  int32_t reserved; /* 0 */
  const uint8_t* pixels;
} XsImage;

/* A value of one of the 20 types. Who hands it over owns what it points to. */
typedef struct XsValue {
  XsType type;
  uint32_t count; /* elements: 1 for SF types */
  union {
    const void* data;      /* NULL only if count is 0 */
    const int32_t* ints;   /* SFBool, SFInt32 */
    const float* floats;   /* SFFloat, SFVec2f, SFVec3f, SFColor, SFRotation: count tuples one after
                              the other */
    const double* doubles; /* SFTime */
    const XsNode* nodes;   /* SFNode */
    const XsString* strings; /* SFString */
    const XsImage* images;   /* SFImage */
  } of;
} XsValue;

typedef enum XsAccess {
  XS_FIELD = 1,
  XS_EXPOSED_FIELD,
  XS_EVENT_IN,
  XS_EVENT_OUT,
  XS_ACCESS_32_BITS = 0x7fffffff
} XsAccess;

typedef struct XsField {
  const char* name; /* as declared; exposedField x: without set_ and _changed */
  XsType type;
  XsAccess access;
} XsField;

/* What functions answer. Everything but XS_OK changed nothing; `lastError` of the host says why. */
typedef enum XsResult {
  XS_OK = 0,
  XS_NO_NODE = 1,  /* NULL, or a number this Script was not given */
  XS_NO_FIELD = 2, /* no such field or event, or none that may be read (sent, written) from here */
  XS_WRONG_TYPE = 3, /* the value is of another type, or no good value of its own (counts, UTF-8) */
  XS_NOT_ALLOWED = 4, /* needs directOutput TRUE, or trust */
  XS_STOPPED = 5,     /* the Script's time is up: return at once */
  XS_FAILED =
      6, /* of the engine: the script failed, details were logged; of the host: could not be done */
  XS_RESULT_32_BITS = 0x7fffffff
} XsResult;

/* Engine: what the host calls
 * --------------------------------------------------------------------------------------------- */

/* XsScriptInfo.flags */
enum {
  XS_DIRECT_OUTPUT = 1, /* may post events to other nodes, add and delete routes (6.40) */
  XS_MUST_EVALUATE =
      2, /* events are delivered one by one as they arrive; else together at the end of a cascade */
  XS_TRUSTED = 4, /* the user trusts this world: the program may do whatever the user may */
  XS_NETWORK = 8  /* the user allows the network */
};

typedef struct XsScriptInfo {
  uint32_t size;  /* sizeof(XsScriptInfo) of the host's header */
  uint32_t flags; /* XS_DIRECT_OUTPUT ... */
  XsNode self; /* the Script's own node: first argument of all functions of the host that speak for
                  this Script */
  const char* scheme; /* in lower case, "javascript"; "" for a program read from a file */
  const char* origin; /* for messages: the file that holds the program, or the world that holds the
                         Script */
  XsString text;      /* the program: what stands behind the scheme, or the file's bytes */
  uint32_t fieldCount;
  const XsField*
      fields; /* what the Script declares, in order, without url, directOutput and mustEvaluate */
  /* --- 1.1 --- */
  uint64_t memory; /* bytes that the program may use, if the engine can tell; beyond it fails as
                      want of memory. 0: no limit */
} XsScriptInfo;

typedef struct XsEvent {
  uint32_t size;    /* sizeof(XsEvent) of the host's header */
  uint32_t index;   /* of the eventIn in XsScriptInfo.fields */
  const char* name; /* and its name */
  XsValue value;    /* good until the function returns */
  double time;      /* the event's timestamp in seconds */
} XsEvent;

/* An engine's own number or pointer for an interpreter; the host only hands it back. */
typedef uint64_t XsInterpreter;

/* XsEngine.flags */
enum {
  XS_NEEDS_TRUST =
      1, /* its programs can do whatever the user can: they run in trusted worlds only */
  XS_HARMLESS =
      2 /* 1.1: its programs always end soon, use little memory and reach nothing but the host's
           functions: they run in the browser's process in worlds that are not trusted, too */
};

typedef struct XsEngine {
  uint32_t size; /* sizeof(XsEngine) of the plug-in's header; optional functions are NULL */
  uint32_t flags;
  const char* name; /* "ecmascript" */
  const char* text; /* one line for people: language, version */
  /* What it serves: lists that end with NULL, in lower case; a list may be NULL. */
  const char* const* schemes;   /* URL schemes without the colon: "javascript", "vrmlscript" */
  const char* const* mimeTypes; /* of data: URLs: "application/javascript" */
  const char* const* suffixes;  /* of files: ".js" */
  /* Makes an interpreter, compiles the program and runs its outermost statements, if the language
   * has such; no event yet. info and what it points to are good until `destroy`. XS_FAILED (after
   * logging why): the Script's next URL is tried. */
  XsResult (*create)(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made);
  /* Frees it. No call comes after it; the Script's handles are released by the host. */
  void (*destroy)(XsInterpreter interpreter);
  /* 4.12.3: before the first event and before the world is shown. Optional, as the four below. */
  XsResult (*initialize)(XsInterpreter interpreter, double time);
  /* 4.12.2, one event. Not called for an eventIn of a Script that was stopped. */
  XsResult (*event)(XsInterpreter interpreter, const XsEvent* event);
  /* 4.12.4: after the events of a cascade, or of a part of it that ended for want of events. */
  XsResult (*eventsProcessed)(XsInterpreter interpreter, double time);
  /* 4.12.3: before the node, its url, or the world goes. Own fields can still be read; nothing can
   * be sent. */
  XsResult (*shutdown)(XsInterpreter interpreter, double time);
  /* Each time the world's time moves on, before its events: for engines with sources of events of
   * their own, as windows or another process. What is sent belongs to this time. */
  XsResult (*tick)(XsInterpreter interpreter, double time);
  /* --- 1.1 --- */
  /* Before the first `create` in a process for programs that are not trusted: afterwards no file
   * can be opened, no thread or process started, no socket made, and memory is limited. What the
   * language needs of these it does here. Optional. */
  XsResult (*prepare)(void);
} XsEngine;

typedef struct XsPlugin {
  uint32_t magic; /* XS_MAGIC */
  uint16_t major, minor;
  uint32_t size; /* sizeof(XsPlugin) */
  uint32_t engineCount;
  const XsEngine* const* engines;
} XsPlugin;

/* Host: what an engine may call
 * ----------------------------------------------------------------------------------------------
 * `self` says for which Script. Values, texts and field descriptions that come out are good until
 * the next call for this Script that gives one out, and not longer than the engine's function that
 * asks. Counts as steps of the Script (see shouldStop). */

typedef struct XsNodeInfo {
  uint32_t size;        /* set by the engine: sizeof(XsNodeInfo) of its header */
  uint32_t fieldCount;  /* for `field` */
  const char* typeName; /* "Transform", a prototype's name, "Script" */
  const char* defName;  /* "" if it has none */
} XsNodeInfo;

struct XsHost {
  uint32_t size; /* sizeof(XsHost) of the host's header */
  uint16_t major, minor;

  /* --- The Script's own fields and events --- */
  /* An event from one of its eventOuts. It leaves when the engine's function returns; of several
   * from one eventOut the last one counts. At most one per eventOut and cascade: later ones are
   * dropped (4.10.3). */
  XsResult (*send)(const XsHost* host, XsNode self, const char* eventOut, const XsValue* value);
  /* A new value for one of its own fields; no event. */
  XsResult (*write)(const XsHost* host, XsNode self, const char* field, const XsValue* value);

  /* --- Nodes --- */
  /* Own node: any field, or the value last sent of an eventOut. Other nodes: exposedFields and
   * eventOuts (x and x_changed). */
  XsResult (*read)(const XsHost* host, XsNode self, XsNode node, const char* field, XsValue* out);
  /* An event to an eventIn or exposedField (x and set_x); leaves when the engine's function
   * returns. Other nodes than its own: with XS_DIRECT_OUTPUT only. */
  XsResult (*post)(const XsHost* host, XsNode self, XsNode node, const char* eventIn,
                   const XsValue* value);
  XsResult (*describe)(const XsHost* host, XsNode self, XsNode node, XsNodeInfo* out);
  /* Field number index (0 <= index < fieldCount), and the one that an event or field name means. */
  XsResult (*field)(const XsHost* host, XsNode self, XsNode node, uint32_t index, XsField* out);
  XsResult (*findField)(const XsHost* host, XsNode self, XsNode node, const char* name,
                        XsField* out);
  /* Retained numbers stay good until they are released as often, whatever becomes of the node in
   * the world. */
  XsResult (*retain)(const XsHost* host, XsNode self, XsNode node);
  XsResult (*release)(const XsHost* host, XsNode self, XsNode node);

  /* --- The Browser object, 4.12.10 --- */
  XsResult (*getName)(const XsHost* host, XsNode self, XsString* out);
  XsResult (*getVersion)(const XsHost* host, XsNode self, XsString* out);
  double (*getCurrentSpeed)(const XsHost* host,
                            XsNode self); /* metres per second, in the viewer's coordinate system */
  double (*getCurrentFrameRate)(const XsHost* host,
                                XsNode self); /* frames per second; 0: not known */
  XsResult (*getWorldUrl)(const XsHost* host, XsNode self, XsString* out);
  XsResult (*setDescription)(const XsHost* host, XsNode self, XsString text);
  /* These three happen after the cascade. createVrmlFromUrl sends an MFNode to the event of a node.
   */
  XsResult (*replaceWorld)(const XsHost* host, XsNode self, uint32_t count, const XsNode* nodes);
  XsResult (*loadUrl)(const XsHost* host, XsNode self, uint32_t urlCount, const XsString* urls,
                      uint32_t parameterCount, const XsString* parameters);
  XsResult (*createVrmlFromUrl)(const XsHost* host, XsNode self, uint32_t urlCount,
                                const XsString* urls, XsNode node, const char* eventIn);
  /* out: an MFNode. What is wrong in the text is logged; XS_FAILED if nothing of it can be used. */
  XsResult (*createVrmlFromString)(const XsHost* host, XsNode self, XsString vrml, XsValue* out);
  /* With XS_DIRECT_OUTPUT only, unless both nodes are the Script's own. At once, but not followed
   * by events under way. */
  XsResult (*addRoute)(const XsHost* host, XsNode self, XsNode from, const char* eventOut,
                       XsNode to, const char* eventIn);
  XsResult (*deleteRoute)(const XsHost* host, XsNode self, XsNode from, const char* eventOut,
                          XsNode to, const char* eventIn);

  /* --- Time, messages --- */
  double (*now)(const XsHost* host, XsNode self); /* the timestamp of the cascade */
  /* Asked often by an interpreter: the number of its steps (instructions or so) since it asked
   * last. Not 0: the function must return XS_STOPPED without running more of the program; the
   * Script then gets no more events. */
  int32_t (*shouldStop)(const XsHost* host, XsNode self, uint64_t steps);
  /* severity 0 printed by the script, 1 note, 2 warning, 3 error; line of the program from 1, 0 if
   * not known. */
  void (*log)(const XsHost* host, XsNode self, int32_t severity, uint32_t line, XsString text);
  /* Why the last call that did not answer XS_OK could not be done. */
  XsResult (*lastError)(const XsHost* host, XsNode self, XsString* out);

  /* --- 1.1: for engines that share the host's own library, as Python's binding does. Trusted
   * worlds in the browser's process only; else NULL and 0. --- */
  /* The host's object (xvrml::Node*) of a node; of node 0 the xvrml::Browser* that runs the Script.
   * It lives as long as the number is good. */
  void* (*object)(const XsHost* host, XsNode self, XsNode node);
  /* The number of such a node, as if it had been read from a field; 0 if there is none. */
  XsNode (*number)(const XsHost* host, XsNode self, void* object);
};

#if defined(_WIN32)
#define XS_EXPORT __declspec(dllexport)
#else
#define XS_EXPORT __attribute__((visibility("default")))
#endif
/* The one symbol of a plug-in:
 *   XS_EXPORT const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin), n,
 * engines}; */
#define XS_ENTRY_NAME "xsPlugin"

#ifdef __cplusplus
}
#endif
#endif
