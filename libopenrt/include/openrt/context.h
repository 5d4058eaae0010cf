/* context.h: errors, contexts and their configuration (OpenRT, C99). openrt.h states the
 * conventions.
 */
#ifndef OPENRT_CONTEXT_H
#define OPENRT_CONTEXT_H

#include <stddef.h>
#include <stdint.h>

#define OPENRT_VERSION_MAJOR 0
#define OPENRT_VERSION_MINOR 2
#define OPENRT_VERSION_PATCH 0

#if defined(_WIN32)
#define RT_API __declspec(dllexport)
#else
#define RT_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* An RTid names an object, instance, shader class, shader, texture or light; 0 names nothing. An
 * RTenum is a value of one of the enumerations of these headers. */
typedef uint32_t RTid;
typedef uint32_t RTenum;
typedef struct RTcontext_* RTcontext;

/* Errors --------------------------------------------------------------------------------------- */

enum {
  RT_NO_ERROR = 0,
  RT_INVALID_ENUM = 0x0500,
  /* A number is NaN, infinite, negative where a positive one is needed, or an index out of range.
   */
  RT_INVALID_VALUE = 0x0501,
  /* The state does not allow the call: unbalanced brackets, no context, a thing of another kind. */
  RT_INVALID_OPERATION = 0x0502,
  RT_STACK_OVERFLOW = 0x0503,
  RT_STACK_UNDERFLOW = 0x0504,
  RT_OUT_OF_MEMORY = 0x0505,
  /* The id was never made, has been deleted, or names another kind of thing. */
  RT_INVALID_ID = 0x0510,
  /* The shader's class declares no such parameter, or declares it with another type. */
  RT_INVALID_PARAMETER = 0x0511,
  /* A shader library is missing, cannot be read, or was built for another ABI. */
  RT_PLUGIN_ERROR = 0x0512,
  /* A recording cannot be written. */
  RT_IO_ERROR = 0x0513,
  /* backend=cluster: there are too few workers (require=N), or no usable address or key. */
  RT_CLUSTER_ERROR = 0x0514
};

/* level: 0 debug, 1 information, 2 warning, 3 error. Messages belong to the library and are valid
 * during the call. */
typedef void (*RTerrorCallback)(RTenum error, const char* message, void* user);
typedef void (*RTlogCallback)(int level, const char* message, void* user);

/* Returns the first error since the last call, and clears it. Works without a current context, too:
 * it then returns errors of rtNewContext. [any-thread] */
RT_API RTenum rtGetError(void);
/* Returns the text of the error that the last rtGetError returned. The library owns it; it is valid
 * until the next rt call of this thread. [any-thread] */
RT_API const char* rtGetErrorMessage(void);
/* Sets a function that is called at once on every error of the current context. NULL removes it.
 * [context-thread] */
RT_API void rtErrorCallback(RTerrorCallback callback, void* user);
/* Sets a function that receives the library's messages. Render threads call it, too. Without one
 * the library is silent. [context-thread] */
RT_API void rtLogCallback(RTlogCallback callback, void* user);

/* Life ----------------------------------------------------------------------------------------- */

/* Makes a context and makes it current on this thread. Returns NULL on failure. Delete the context
 * with rtDeleteContext. config is NULL or holds key=value pairs between blanks; a value with blanks
 * stands in "double quotes". [any-thread]
 *   backend=local|null|record|cluster
 *                          who renders (default local). debug:NAME is the same and explains misuse
 *                          of the API to rtLogCallback.
 *   threads=N              render threads. 0 (default) means as many as the process may use.
 *   isa=auto|avx512|avx2|avx|sse4.2|sse2|neon
 *                          instruction set of the ray kernels. auto (default) is the best one of
 *                          the machine. Machines give the same bytes with the same one, if their
 *                          processors are of one maker. One that the machine lacks is an
 *                          RT_INVALID_VALUE, whose message lists those that it has.
 *                          RTstats.machine.isa is the one in use.
 *   file=PATH              the recording to write (backend=record)
 *   record=PATH            a recording that is written while another backend renders. openrt-replay
 *                          makes the same bytes of it, except for frames that did not wait for
 *                          their scene (RTstats.outdated).
 *   shaderpath=DIR[:DIR...]
 *                          folders of shader libraries, searched before $OPENRT_SHADER_PATH and the
 *                          installed folder
 *   lightsamples=on|off    off, for checks: paths find shapes and the sky by hitting them alone
 * With backend=cluster, openrt-workers on other machines render, too. Pictures have the same bytes
 * however many workers there are, and while workers join, are slow or are lost. Further keys:
 *   workers=HOST[:PORT],...
 *                          workers to call (port 7447 unless one is given). HOST:PORT=PUBLICKEY
 *                          names a worker with a key of its own; @FILE names a file with one worker
 *                          on each line.
 *   listen=ADDRESS[:PORT]  where workers call in (openrt-worker --connect)
 *   key=FILE               the key file (openrt-worker --new-key FILE), which every address other
 *                          than loopback needs
 *   allow=FILE             further public keys that are accepted, one on each line
 *   local=N                threads of this process that render, too. 0 means none as long as a
 *                          worker lives. The default is threads=N.
 *   split=auto|tiles|samples|frames
 *                          how the work is divided into jobs (default auto)
 *   require=N              A frame waits while there are fewer than N workers, and fails with
 *                          RT_CLUSTER_ERROR after 10 seconds. With 0 (default) this process ends
 *                          the frame alone and says so in the log.
 *   tolerant=1             accepts workers of another instruction set or version. The last bits of
 *                          pictures may then differ.
 * Workers use the instruction set of this process. One that lacks it is refused; isa=NAME chooses
 * one that all have. */
RT_API RTcontext rtNewContext(const char* config);
/* Makes a context current on this thread. NULL makes none current. [any-thread] */
RT_API void rtMakeCurrent(RTcontext context);
/* Returns the context that is current on this thread, or NULL. [any-thread] */
RT_API RTcontext rtGetCurrent(void);
/* Ends a context and its frame in flight, and frees everything in it. NULL is allowed. Records
 * RT_IO_ERROR if the recording is not whole. [context-thread] */
RT_API void rtDeleteContext(RTcontext context);
/* Make and end a default context. rtInit takes arguments of the form --rt-KEY=VALUE out of argv and
 * into the configuration. [context-thread] */
RT_API void rtInit(int* argc, char** argv);
RT_API void rtExit(void);

#ifdef __cplusplus
}
#endif
#endif
