/* worker.h: the workers of a cluster (OpenRT, C99; backend=cluster, see rtNewContext). openrt.h
 * states the conventions.
 */
#ifndef OPENRT_WORKER_H
#define OPENRT_WORKER_H

#include "openrt/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Workers: the machines of backend=cluster ----------------------------------------------------- */

/* A worker; numbers count since it joined. */
typedef struct RTworker {
  size_t size;   /* Set it to sizeof(RTworker) in the first element before the call. */
  char name[64]; /* host and address, for people; "here" is this process */
  uint32_t threads;
  int alive;                         /* 0 if it has left or was refused */
  uint64_t jobs;                     /* jobs done */
  uint64_t late;                     /* results that came after another worker had done the job */
  uint64_t lost;                     /* jobs taken away from it because it left */
  uint64_t bytesSent, bytesReceived; /* to the worker, from the worker */
  uint64_t rays;
  double busySeconds; /* sum over its threads */
  double latency;     /* seconds that a job is under way beyond its work, smoothed */
} RTworker;
/* Writes at most count workers, among them those that have left, and returns how many there are.
 * workers may be NULL if count is 0. [any-thread] */
RT_API size_t rtGetWorkers(RTcontext context, RTworker* workers, size_t count);

#ifdef __cplusplus
}
#endif
#endif
