/* xscript.h: the SDK for script engines, which run the Script nodes of a VRML97 world (ISO/IEC
 * 14772-1 4.12, 6.40) in some language. C99, no other header of XVRML needed.
 *
 * A plug-in is a shared library that exports one constant, `xsPlugin`, and links against nothing of
 * XVRML: it receives the host's functions as a table. A plug-in has engines; an engine makes an
 * interpreter for each Script node. Nodes are numbers (handles), values are plain typed arrays,
 * strings are UTF-8 with a length. Nothing in this interface points into the scene graph, so an
 * engine can forward everything to another process.
 *
 * Thread: every function of both tables, host's and engine's, is called on the browser's thread.
 * The host never calls an interpreter while one of that interpreter's functions, or another
 * interpreter's, is running: events that a script causes are delivered after its function has
 * returned. No exception crosses this interface, and no function ends the process.
 *
 * Versions: structures begin with their size and grow only at their end, so that each side knows
 * which members the other has. */
#ifndef XVRML_XSCRIPT_H
#define XVRML_XSCRIPT_H

#include <stddef.h>
#include <stdint.h>

#define XS_MAGIC 0x50435358u /* "XSCP" */
#define XS_ABI_MAJOR 1       /* a host refuses another major number */
/* grows with everything that is appended; a host accepts minors up to its own */
#define XS_ABI_MINOR 0

#ifdef __cplusplus
extern "C" {
#endif

typedef struct XsHost XsHost;

/* A node; 0 is VRML's NULL. A Script may use the numbers that it was given: in its fields, in
 * events, in what it read or made. Any other number is refused. A number is valid until the
 * engine's function returns during which it was given; `retain` keeps it valid longer. While it is
 * valid, a node has one number for a Script. The number of the Script's own node is always
 * valid. */
typedef uint64_t XsNode;

/* --- Values --- */

/* Field types, with the C type of an array's element. MF types are arrays of the elements of the SF
 * type of the same name; xscript_types.h has a table. */
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
  XS_MFCOLOR,
  XS_MFFLOAT,
  XS_MFINT32,
  XS_MFNODE,
  XS_MFROTATION,
  XS_MFSTRING,
  XS_MFTIME,
  XS_MFVEC2F,
  XS_MFVEC3F,
  XS_MFBOOL,      /* the types that X3D adds follow */
  XS_SFCOLORRGBA, /* float[4], rgba */
  XS_MFCOLORRGBA,
  XS_SFDOUBLE, /* double */
  XS_MFDOUBLE,
  XS_MFIMAGE,
  XS_SFMATRIX3D, /* double[9], row by row */
  XS_MFMATRIX3D,
  XS_SFMATRIX3F, /* float[9], row by row */
  XS_MFMATRIX3F,
  XS_SFMATRIX4D, /* double[16], row by row */
  XS_MFMATRIX4D,
  XS_SFMATRIX4F, /* float[16], row by row */
  XS_MFMATRIX4F,
  XS_SFVEC2D, /* double[2] */
  XS_MFVEC2D,
  XS_SFVEC3D, /* double[3] */
  XS_MFVEC3D,
  XS_SFVEC4D, /* double[4] */
  XS_MFVEC4D,
  XS_SFVEC4F, /* float[4] */
  XS_MFVEC4F,
  XS_TYPE_32_BITS = 0x7fffffff /* not a type: fixes the size of the enumeration */
} XsType;

/* UTF-8. A string from the host is also followed by a zero byte, which `bytes` does not count. */
typedef struct XsString {
  const char* data;
  uint64_t bytes;
} XsString;

/* Pixels in rows from the bottom: width * height * components bytes. components is 0 to 4. */
typedef struct XsImage {
  int32_t width, height, components;
  int32_t reserved; /* 0 */
  const uint8_t* pixels;
} XsImage;

/* A value of one of the types above. The side that passes it owns the memory that it points to. */
typedef struct XsValue {
  XsType type;
  uint32_t count; /* number of elements: 1 for SF types */
  union {
    const void* data;        /* NULL only if count is 0 */
    const int32_t* ints;     /* SFBool, SFInt32 */
    const float* floats;     /* SFFloat and tuples of floats: count tuples in a row */
    const double* doubles;   /* SFTime, SFDouble and tuples of doubles: count tuples in a row */
    const XsNode* nodes;     /* SFNode */
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
  const char* name; /* as declared; an exposedField x: without set_ and _changed */
  XsType type;
  XsAccess access;
} XsField;

/* Results of functions. If the result is not XS_OK, nothing was changed; the host's `lastError`
 * gives the reason. */
typedef enum XsResult {
  XS_OK = 0,
  XS_NO_NODE = 1, /* NULL, or a number that this Script was not given */
  /* No such field or event, or one that cannot be read (sent, written) from here. */
  XS_NO_FIELD = 2,
  /* The value is of another type, or is not a valid value of its type (counts, UTF-8). */
  XS_WRONG_TYPE = 3,
  XS_NOT_ALLOWED = 4, /* needs directOutput TRUE, or trust */
  XS_STOPPED = 5,     /* the Script's time is up: the engine must return at once */
  /* From an engine: the script failed, and the reason was logged. From the host: it could not be
   * done. */
  XS_FAILED = 6,
  XS_RESULT_32_BITS = 0x7fffffff
} XsResult;

/* --- Engine: functions that the host calls --- */

/* XsScriptInfo.flags */
enum {
  XS_DIRECT_OUTPUT = 1, /* may post events to other nodes, and add and delete routes (6.40) */
  /* Each event is delivered as it arrives; otherwise events come together at the end of a
   * cascade. */
  XS_MUST_EVALUATE = 2,
  XS_TRUSTED = 4, /* the user trusts this world: the program may do whatever the user may */
  XS_NETWORK = 8  /* the user allows the network */
};

typedef struct XsScriptInfo {
  uint32_t size;  /* sizeof(XsScriptInfo) in the host's header */
  uint32_t flags; /* XS_DIRECT_OUTPUT ... */
  /* The Script's own node: the first argument of all host functions that act for this Script. */
  XsNode self;
  const char* scheme; /* in lower case, "javascript"; "" for a program read from a file */
  /* For messages: the file that holds the program, or the world that holds the Script. */
  const char* origin;
  XsString text; /* the program: the text after the scheme, or the file's bytes */
  uint32_t fieldCount;
  /* The fields and events that the Script declares, in order, without url, directOutput and
   * mustEvaluate. In X3D there are exposedFields, too (inputOutput). */
  const XsField* fields;
  /* Bytes that the program may use, if the engine can tell; beyond them it fails as if out of
   * memory. 0: no limit. */
  uint64_t memory;
} XsScriptInfo;

typedef struct XsEvent {
  uint32_t size;  /* sizeof(XsEvent) in the host's header */
  uint32_t index; /* index of the eventIn or exposedField in XsScriptInfo.fields */
  /* Name of the eventIn or exposedField x. An exposedField already has the value and has sent it
   * on; the stock engines call the program's function set_x. */
  const char* name;
  XsValue value; /* valid until the function returns */
  double time;   /* the event's timestamp in seconds */
} XsEvent;

/* An engine's number or pointer for an interpreter. The host only passes it back. */
typedef uint64_t XsInterpreter;

/* XsEngine.flags */
enum {
  /* Its programs can do whatever the user can. They run in trusted worlds only. */
  XS_NEEDS_TRUST = 1,
  /* 1.1: its programs always end soon, use little memory and can only call the host's functions.
   * They run in the browser's process, even in worlds that are not trusted. */
  XS_HARMLESS = 2
};

typedef struct XsEngine {
  uint32_t size; /* sizeof(XsEngine) in the plug-in's header; optional functions are NULL */
  uint32_t flags;
  const char* name; /* "ecmascript" */
  const char* text; /* one line for people: language, version */
  /* The Script urls that the engine serves: lists that end with NULL, in lower case. A list may be
   * NULL. */
  const char* const* schemes;   /* URL schemes without the colon: "javascript", "vrmlscript" */
  const char* const* mimeTypes; /* types of data: URLs: "application/javascript" */
  const char* const* suffixes;  /* ends of file names: ".js" */
  /* Makes an interpreter, compiles the program and runs its outermost statements, if the language
   * has such. No event is delivered yet. info and the memory it points to are valid until
   * `destroy`. On XS_FAILED (the reason is logged), the host tries the Script's next URL. */
  XsResult (*create)(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made);
  /* Frees an interpreter. No call comes after it; the host releases the Script's handles. */
  void (*destroy)(XsInterpreter interpreter);
  /* Called before the first event and before the world is shown (4.12.3). Optional, as are the next
   * four. */
  XsResult (*initialize)(XsInterpreter interpreter, double time);
  /* Delivers one event (4.12.2). Not called for a Script that was stopped. */
  XsResult (*event)(XsInterpreter interpreter, const XsEvent* event);
  /* Called after the events of a cascade, or of a part of it that ended because no event was left
   * (4.12.4). */
  XsResult (*eventsProcessed)(XsInterpreter interpreter, double time);
  /* Called before the node, its url, or the world is removed (4.12.3). The Script's own fields can
   * still be read; nothing can be sent. */
  XsResult (*shutdown)(XsInterpreter interpreter, double time);
  /* Called each time the world's time advances, before the events of that time. For engines with
   * event sources of their own, such as windows or another process. Events sent here have this
   * time. */
  XsResult (*tick)(XsInterpreter interpreter, double time);
  /* Called before the first `create` in a process for programs that are not trusted. Afterwards no
   * file can be opened, no thread or process started and no socket made, and memory is limited. The
   * engine does here whatever its language needs of these. Optional. */
  XsResult (*prepare)(void);
  /* 1.3: `tick` is called only for programs whose text contains this word. NULL: for all. */
  const char* tickWord;
} XsEngine;

typedef struct XsPlugin {
  uint32_t magic; /* XS_MAGIC */
  uint16_t major, minor;
  uint32_t size; /* sizeof(XsPlugin) */
  uint32_t engineCount;
  const XsEngine* const* engines;
} XsPlugin;

/* --- Host: functions that an engine may call ---
 *
 * `self` says which Script calls. Values, strings and field descriptions that the host returns are
 * valid until the next call for this Script that returns one, and at most until the engine's
 * function returns. Each call counts as steps of the Script (see shouldStop). */

typedef struct XsNodeInfo {
  uint32_t size;        /* set by the engine: sizeof(XsNodeInfo) in its header */
  uint32_t fieldCount;  /* number of fields, for `field` */
  const char* typeName; /* "Transform", a prototype's name, "Script" */
  const char* defName;  /* "" if it has none */
} XsNodeInfo;

struct XsHost {
  uint32_t size; /* sizeof(XsHost) in the host's header */
  uint16_t major, minor;

  /* --- The Script's own fields and events --- */
  /* Sends an event from one of the Script's eventOuts when the engine's function returns. If one
   * eventOut gets several, the last one counts. Each eventOut sends at most once per cascade; later
   * events are dropped (4.10.3). */
  XsResult (*send)(const XsHost* host, XsNode self, const char* eventOut, const XsValue* value);
  /* Sets one of the Script's own fields, without an event. An exposedField x also sends x_changed,
   * as if by `send`. */
  XsResult (*write)(const XsHost* host, XsNode self, const char* field, const XsValue* value);

  /* --- Nodes --- */
  /* Reads a field of a node. The Script's own node gives any field, or the last value that an
   * eventOut sent. Other nodes give exposedFields and eventOuts (x and x_changed). */
  XsResult (*read)(const XsHost* host, XsNode self, XsNode node, const char* field, XsValue* out);
  /* Posts an event to an eventIn or exposedField (x and set_x); it leaves when the engine's
   * function returns. Nodes other than the Script's own need XS_DIRECT_OUTPUT. */
  XsResult (*post)(const XsHost* host, XsNode self, XsNode node, const char* eventIn,
                   const XsValue* value);
  XsResult (*describe)(const XsHost* host, XsNode self, XsNode node, XsNodeInfo* out);
  /* `field` describes the field with an index (0 <= index < fieldCount), findField the one that an
   * event or field name refers to. */
  XsResult (*field)(const XsHost* host, XsNode self, XsNode node, uint32_t index, XsField* out);
  XsResult (*findField)(const XsHost* host, XsNode self, XsNode node, const char* name,
                        XsField* out);
  /* A retained number stays valid until it is released as often as it was retained, even if the
   * node is removed from the world. */
  XsResult (*retain)(const XsHost* host, XsNode self, XsNode node);
  XsResult (*release)(const XsHost* host, XsNode self, XsNode node);

  /* --- The Browser object, 4.12.10 --- */
  XsResult (*getName)(const XsHost* host, XsNode self, XsString* out);
  XsResult (*getVersion)(const XsHost* host, XsNode self, XsString* out);
  /* Metres per second, in the viewer's coordinate system. */
  double (*getCurrentSpeed)(const XsHost* host, XsNode self);
  /* Frames per second; 0: not known. */
  double (*getCurrentFrameRate)(const XsHost* host, XsNode self);
  XsResult (*getWorldUrl)(const XsHost* host, XsNode self, XsString* out);
  XsResult (*setDescription)(const XsHost* host, XsNode self, XsString text);
  /* The next three take effect after the cascade. createVrmlFromUrl sends an MFNode to an eventIn
   * of `node`. */
  XsResult (*replaceWorld)(const XsHost* host, XsNode self, uint32_t count, const XsNode* nodes);
  XsResult (*loadUrl)(const XsHost* host, XsNode self, uint32_t urlCount, const XsString* urls,
                      uint32_t parameterCount, const XsString* parameters);
  XsResult (*createVrmlFromUrl)(const XsHost* host, XsNode self, uint32_t urlCount,
                                const XsString* urls, XsNode node, const char* eventIn);
  /* out: an MFNode. Errors in the text are logged; XS_FAILED if nothing of it can be used. */
  XsResult (*createVrmlFromString)(const XsHost* host, XsNode self, XsString vrml, XsValue* out);
  /* Adding and deleting routes needs XS_DIRECT_OUTPUT, unless both nodes are the Script's own. A
   * change takes effect at once, but not for events already on their way. */
  XsResult (*addRoute)(const XsHost* host, XsNode self, XsNode from, const char* eventOut,
                       XsNode to, const char* eventIn);
  XsResult (*deleteRoute)(const XsHost* host, XsNode self, XsNode from, const char* eventOut,
                          XsNode to, const char* eventIn);

  /* --- Time, messages --- */
  double (*now)(const XsHost* host, XsNode self); /* the timestamp of the cascade */
  /* An interpreter calls this often, with the number of its steps (such as instructions) since the
   * last call. If the result is not 0, the engine's function must return XS_STOPPED without running
   * more of the program; the Script then gets no more events. */
  int32_t (*shouldStop)(const XsHost* host, XsNode self, uint64_t steps);
  /* Logs a text. severity: 0 printed by the script, 1 note, 2 warning, 3 error. line: line of the
   * program, counted from 1; 0 if not known. */
  void (*log)(const XsHost* host, XsNode self, int32_t severity, uint32_t line, XsString text);
  /* Gives the reason why the last call did not return XS_OK. */
  XsResult (*lastError)(const XsHost* host, XsNode self, XsString* out);

  /* --- 1.1: for engines that share the host's own library, such as the Python binding. They work
   * only in trusted worlds in the browser's process; elsewhere they are NULL or return 0. */
  /* Returns the host's object (xvrml::Node*) for a node, or for node 0 the xvrml::Browser* that
   * runs the Script. It lives as long as the number is valid. */
  void* (*object)(const XsHost* host, XsNode self, XsNode node);
  /* Returns the number of such a node, as if it had been read from a field; 0 if there is none. */
  XsNode (*number)(const XsHost* host, XsNode self, void* object);

  /* --- 1.2: the scene that the Script stands in: the world's file, or the content of an Inline. An
   * engine reads these members only if `size` says that they are there. */
  /* out: the SFNode of a DEF name. XS_NO_NODE if the scene has no such name. */
  XsResult (*namedNode)(const XsHost* host, XsNode self, XsString name, XsValue* out);
  /* out: an MFNode, the outermost nodes. */
  XsResult (*rootNodes)(const XsHost* host, XsNode self, XsValue* out);

  /* --- 1.3: what scenes and nodes of X3D say of themselves (ISO/IEC 19777-1). An engine reads
   * these members only if `size` says that they are there. */
  /* out: an MFString of three: the scene's version ("2.0" is VRML97), its encoding ("VRML", "XML",
   * "JSON", or "SCRIPTED" for all others) and its file. */
  XsResult (*sceneFacts)(const XsHost* host, XsNode self, XsValue* out);
  /* out: the SFNode of a new instance of a prototype that the scene declares, with its defaults.
   * XS_NO_NODE if the scene declares no such prototype. */
  XsResult (*createInstance)(const XsHost* host, XsNode self, XsString prototype, XsValue* out);
  /* out: the SFNode of a DEF name among a node and its descendants. XS_NO_NODE: there is none. */
  XsResult (*nodeWithin)(const XsHost* host, XsNode self, XsNode node, XsString name, XsValue* out);
  /* out: an MFString of the abstract types of ISO/IEC 19775-1 that the node has, X3DNode first. */
  XsResult (*nodeTypes)(const XsHost* host, XsNode self, XsNode node, XsValue* out);
  /* out: a node with its descendants, or for node 0 the whole scene, as text. encoding: "VRML"
   * (VRML97 for what a file of VRML97 holds, else ClassicVRML) or "XML". Prototypes are not part of
   * a node's text. */
  XsResult (*writeNode)(const XsHost* host, XsNode self, XsNode node, XsString encoding,
                        XsString* out);

  /* --- 1.4 */
  /* out: nodes as the text of a file that holds them, with a head, with the prototypes that they
   * are instances of, and with the routes among them. encoding: as for writeNode. A node 0 is
   * passed over. */
  XsResult (*writeScene)(const XsHost* host, XsNode self, uint32_t count, const XsNode* nodes,
                         XsString encoding, XsString* out);
  /* out: the name that the other standard, VRML97 or X3D, has for the field with this index.
   * findField finds VRML97's names in files of both, and X3D's in files of X3D. XS_NO_FIELD: both
   * standards have the same name. */
  XsResult (*otherName)(const XsHost* host, XsNode self, XsNode node, uint32_t index,
                        XsString* out);
};

#if defined(_WIN32)
#define XS_EXPORT __declspec(dllexport)
#else
#define XS_EXPORT __attribute__((visibility("default")))
#endif
/* The one symbol of a plug-in:
 *    XS_EXPORT const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR,
 *                                         sizeof(XsPlugin), n, engines}; */
#define XS_ENTRY_NAME "xsPlugin"

#ifdef __cplusplus
}
#endif
#endif
