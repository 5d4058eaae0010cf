/* fake_oidn.c: A library with the functions of Open Image Denoise that OpenRT uses, for tests on
 * machines without it. Its filter gives every pixel the mean colour of the image, and leaves an
 * albedo as it is. It checks what it is given as the real one does, and counts what was made and
 * released.
 *
 * Compiled with one of these it is unusable in one way: FAKE_OLD (version 1), FAKE_INCOMPLETE (a
 * function is missing), FAKE_WITHOUT_DEVICE, FAKE_FAILING (filtering fails), FAKE_FAILING_LARGE
 * (filtering of more than 16x16 pixels fails), FAKE_WITHOUT_MEMORY (the same, for lack of memory),
 * FAKE_SLOW (a picture takes 50 ms), FAKE_CRASHING (filtering ends the process by a signal),
 * FAKE_LEAVING (loading ends the process), FAKE_NAN (the result is not a number). */
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fake_oidn.h"

#define EXPORT __attribute__((visibility("default")))

typedef struct {
  int threads;
  bool affinity, committed;
  const char* error;
  int code; /* the code of the error; 0: 3, an invalid operation */
} Device;

typedef struct {
  Device* device;
  size_t bytes;
  char* data;
} Buffer;

typedef struct {
  const char* name;
  Buffer* buffer;
  size_t width, height, offset;
} Image;

enum { images = 4 };

typedef struct {
  Device* device;
  Image image[images]; /* color, albedo, normal, output */
  bool hdr, cleanAux, committed;
  int quality;
} Filter;

EXPORT FakeOidnCounts fakeOidnCounts;

static const char* globalError;

#ifdef FAKE_LEAVING
__attribute__((constructor)) static void leave(void) { _Exit(0); }
#endif

EXPORT void* oidnNewDevice(int type) {
#ifdef FAKE_WITHOUT_DEVICE
  (void)type;
  globalError = "the fake has no device";
  return NULL;
#else
  Device* device = calloc(1, sizeof *device);
  if (!device || type != 0) abort();
  device->affinity = true;
  __atomic_add_fetch(&fakeOidnCounts.devices, 1, __ATOMIC_SEQ_CST);
  return device;
#endif
}

EXPORT void oidnReleaseDevice(void* device) {
  __atomic_sub_fetch(&fakeOidnCounts.devices, 1, __ATOMIC_SEQ_CST);
  free(device);
}

EXPORT void oidnCommitDevice(void* given) {
  Device* device = given;
  device->committed = true;
  fakeOidnCounts.threads = device->threads;
  fakeOidnCounts.affinity = device->affinity;
}

EXPORT int oidnGetDeviceInt(void* device, const char* name) {
  (void)device;
  if (strcmp(name, "type") == 0) return 1; /* a processor */
#ifdef FAKE_OLD
  return 10403;
#else
  return 20499;
#endif
}

EXPORT void oidnSetDeviceInt(void* given, const char* name, int value) {
  Device* device = given;
  if (strcmp(name, "numThreads") != 0 || device->committed)
    device->error = "unexpected setting of a device";
  device->threads = value;
}

EXPORT void oidnSetDeviceBool(void* given, const char* name, bool value) {
  Device* device = given;
  if (strcmp(name, "setAffinity") != 0 || device->committed)
    device->error = "unexpected setting of a device";
  device->affinity = value;
}

EXPORT int oidnGetDeviceError(void* given, const char** message) {
  Device* device = given;
  const char** error = device ? &device->error : &globalError;
  const int code = !*error ? 0 : device && device->code ? device->code : 3;
  if (message) *message = *error;
  *error = NULL;
  return code;
}

EXPORT void* oidnNewBuffer(void* device, size_t bytes) {
  Buffer* buffer = calloc(1, sizeof *buffer);
  if (!buffer) abort();
  buffer->device = device;
  buffer->bytes = bytes;
  buffer->data = calloc(1, bytes);
  if (!buffer->data) abort();
  __atomic_add_fetch(&fakeOidnCounts.buffers, 1, __ATOMIC_SEQ_CST);
  return buffer;
}

EXPORT void oidnReleaseBuffer(void* given) {
  Buffer* buffer = given;
  free(buffer->data);
  free(buffer);
  __atomic_sub_fetch(&fakeOidnCounts.buffers, 1, __ATOMIC_SEQ_CST);
}

static bool holds(Buffer* buffer, size_t offset, size_t bytes) {
  const bool fits = offset <= buffer->bytes && bytes <= buffer->bytes - offset;
  if (!fits) buffer->device->error = "access outside of a buffer";
  return fits;
}

EXPORT void oidnWriteBuffer(void* given, size_t offset, size_t bytes, const void* from) {
  Buffer* buffer = given;
  if (holds(buffer, offset, bytes)) memcpy(buffer->data + offset, from, bytes);
}

EXPORT void oidnReadBuffer(void* given, size_t offset, size_t bytes, void* to) {
  Buffer* buffer = given;
  if (holds(buffer, offset, bytes)) memcpy(to, buffer->data + offset, bytes);
}

EXPORT void* oidnNewFilter(void* given, const char* type) {
  Device* device = given;
  static const char* const names[images] = {"color", "albedo", "normal", "output"};
  if (!device->committed || strcmp(type, "RT") != 0) {
    device->error = "no such filter";
    return NULL;
  }
  Filter* filter = calloc(1, sizeof *filter);
  if (!filter) abort();
  filter->device = device;
  for (int i = 0; i < images; i++) filter->image[i].name = names[i];
  __atomic_add_fetch(&fakeOidnCounts.filters, 1, __ATOMIC_SEQ_CST);
  return filter;
}

EXPORT void oidnReleaseFilter(void* filter) {
  free(filter);
  __atomic_sub_fetch(&fakeOidnCounts.filters, 1, __ATOMIC_SEQ_CST);
}

EXPORT void oidnSetFilterImage(void* given, const char* name, void* buffer, int format,
                               size_t width, size_t height, size_t offset, size_t pixelStride,
                               size_t rowStride) {
  Filter* filter = given;
  Image* found = NULL;
  for (int i = 0; i < images; i++)
    if (strcmp(filter->image[i].name, name) == 0) found = &filter->image[i];
  if (!found || format != 3 || pixelStride || rowStride ||
      !holds(buffer, offset, width * height * 3 * sizeof(float))) {
    filter->device->error = "unexpected image";
    return;
  }
  found->buffer = buffer;
  found->width = width;
  found->height = height;
  found->offset = offset;
}

EXPORT void oidnSetFilterBool(void* given, const char* name, bool value) {
  Filter* filter = given;
  if (strcmp(name, "hdr") == 0)
    filter->hdr = value;
  else if (strcmp(name, "cleanAux") == 0)
    filter->cleanAux = value;
  else
    filter->device->error = "unexpected setting of a filter";
}

EXPORT void oidnSetFilterInt(void* given, const char* name, int value) {
  Filter* filter = given;
  if (strcmp(name, "quality") != 0 || value < 4 || value > 6)
    filter->device->error = "unexpected setting of a filter";
  filter->quality = value;
}

EXPORT void oidnCommitFilter(void* given) {
  Filter* filter = given;
  filter->committed = true;
  fakeOidnCounts.width = (int)filter->image[3].width;
  fakeOidnCounts.height = (int)filter->image[3].height;
  fakeOidnCounts.quality = filter->quality;
}

#ifndef FAKE_INCOMPLETE
EXPORT void oidnExecuteFilter(void* given) {
  Filter* filter = given;
  __atomic_add_fetch(&fakeOidnCounts.runs, 1, __ATOMIC_SEQ_CST);
#ifdef FAKE_CRASHING
  raise(SIGSEGV);
#endif
  if (!filter->image[0].buffer) { /* an albedo alone: it stays as it is */
    if (!filter->committed || !filter->image[1].buffer || filter->image[2].buffer ||
        filter->image[1].offset != filter->image[3].offset || filter->hdr || filter->cleanAux)
      filter->device->error = "the fake cannot filter this albedo";
    return;
  }
  const bool guided = filter->image[1].buffer && filter->image[2].buffer;
  bool usable = filter->committed && filter->hdr && filter->cleanAux == guided;
  usable = usable && filter->image[3].buffer;
#ifdef FAKE_FAILING
  usable = false;
#endif
#if defined FAKE_FAILING_LARGE || defined FAKE_WITHOUT_MEMORY
  usable = usable && filter->image[0].width <= 16;
#endif
#ifdef FAKE_WITHOUT_MEMORY
  filter->device->code = 4;
#endif
  if (!usable) {
    filter->device->error = "the fake cannot filter this";
    return;
  }
#ifdef FAKE_SLOW
  const struct timespec pause = {0, 50 * 1000 * 1000};
  nanosleep(&pause, NULL);
#endif
  const size_t pixels = filter->image[0].width * filter->image[0].height;
  const float* from =
      (const float*)(void*)(filter->image[0].buffer->data + filter->image[0].offset);
  float* to = (float*)(void*)(filter->image[3].buffer->data + filter->image[3].offset);
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < 3 * pixels; i++) sum[i % 3] += from[i];
  for (size_t i = 0; i < 3 * pixels; i++) to[i] = (float)(sum[i % 3] / (double)pixels);
#ifdef FAKE_NAN
  for (size_t i = 0; i < 3 * pixels; i += 2) to[i] = 0.0f / 0.0f;
#endif
}
#endif
