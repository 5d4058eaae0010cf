/* sums.h: the sums of a frame, from which it is continued or added to others (OpenRT, C99).
 * openrt.h states the conventions.
 */
#ifndef OPENRT_SUMS_H
#define OPENRT_SUMS_H

#include "openrt/context.h"
#include "openrt/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sums of frames ------------------------------------------------------------------------------- */

/* A frame adds samples to sums, from which it computes its channels and their errors. A program can
 * keep these sums while the frame is made, and store them. Another process continues the frame from
 * them, and the finished frame has the same bytes as one that was not interrupted. Sums of finished
 * frames that differ in RT_SEED alone can be added; the result does not depend on the order.
 *
 * An object of type RTsums never changes. It belongs to no context. */
typedef struct RTsumsObject* RTsums;

/* An error as those of openrt/context.h: sums are damaged, not finished, or of something else. */
enum { RT_SUMS_ERROR = 0x0515 };

/* 1: the sums of the frames that follow are kept, which takes 10 to 320 bytes a pixel (and 12 for
 * each name in it with RT_COVERAGE), and as much again with RT_TARGET_ERROR. 0 (default): they are
 * not. Frames with RT_TIME_LIMIT cannot be kept. Call it before anything is committed: sums know by
 * all commits what they show. RT_SUMS_ERROR if the backend keeps no sums, or something was
 * committed. [context-thread] */
RT_API void rtKeepSums(int keep);
/* Returns the sums so far of the oldest frame in flight, or else of the finished frame; NULL if
 * none are kept. Delete them with rtDeleteSums. [any-thread] */
RT_API RTsums rtGetSums(RTcontext context);
/* The next frame begins with the sums. If it cannot, rtSwapBuffers or rtRender records
 * RT_SUMS_ERROR, whose message says why, and starts no frame: another scene, other settings than
 * RT_PROGRESSIVE, another version or instruction set. More RT_SAMPLES_PER_PIXEL are allowed where
 * the samples so far are also those of the longer frame. Needs rtKeepSums(1). [context-thread] */
RT_API void rtContinueFrom(RTsums sums);
/* Adds the sums of two finished frames of different seeds. With NULL as the second, returns what
 * is needed of the first one to add it to others and to read its pixels, which is less than to
 * continue it. Returns NULL and records RT_SUMS_ERROR if they cannot be added. [any-thread] */
RT_API RTsums rtMergeSums(RTsums a, RTsums b);
RT_API void rtDeleteSums(RTsums sums); /* NULL is allowed. [any-thread] */

/* Receives bytes in order. It returns 1, or 0 to end the call. */
typedef int (*RTwriteCallback)(const void* data, size_t size, void* user);
/* Passes the sums as bytes to the function. Returns 1, or 0 if that has returned 0. [any-thread] */
RT_API int rtWriteSums(RTsums sums, RTwriteCallback write, void* user);
/* Makes sums of such bytes, which may come from anywhere. Returns NULL and records RT_SUMS_ERROR if
 * they are not sums, or damaged. [any-thread] */
RT_API RTsums rtReadSums(const void* data, size_t size);

/* Describes what sums are of. */
typedef struct RTsumsInfo {
  size_t size; /* Set it to sizeof(RTsumsInfo) before the call. */
  int width, height;
  uint32_t channels;
  uint32_t samples;             /* RT_SAMPLES_PER_PIXEL */
  uint32_t seeds;               /* number of frames that were added */
  uint32_t firstSeed, lastSeed; /* others between them may be missing */
  int complete;                 /* 1 if the frame is finished */
  double done;                  /* share of the samples that are there, 0 to 1 */
} RTsumsInfo;
/* Writes what is known about sums. Returns 1, or 0 if a pointer is NULL or info->size is not set.
 * [any-thread] */
RT_API int rtGetSumsInfo(RTsums sums, RTsumsInfo* info);
/* Copies one channel of the picture of finished sums, laid out as by rtReadPixels. Returns 1, or 0
 * with an error: RT_SUMS_ERROR if the frame is not finished. [any-thread] */
RT_API int rtReadSumsPixels(RTsums sums, RTenum channel, float* out, size_t count);
/* Writes the statistics of the picture of finished sums: those of rays, errors, light that is left
 * out, the transport and the kernel. The others become 0. Returns as rtReadSumsPixels does.
 * [any-thread] */
RT_API int rtGetSumsStats(RTsums sums, RTstats* stats);

#ifdef __cplusplus
}
#endif
#endif
