/* write_failures.c: a library for LD_PRELOAD that makes one write to a file fail as on a full disk.
 * Used by write_failures.py.
 *
 * It counts the calls that can fail for lack of space: open and fopen that create a file; write,
 * writev and pwrite to regular files; fwrite, fflush and fclose of streams on such files; close and
 * fsync of them; rename. Standard output and standard error are not counted.
 *
 * Environment variables:
 * - WRITE_FAILURE=N makes the N-th call fail with ENOSPC (0: none).
 * - WRITE_FAILURE_STICKS=1 makes all later calls fail as well, except for those that release space.
 * - WRITE_FAILURE_COUNT names the file that keeps the number of calls so far. This file itself is
 *   not counted. One process at a time. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static long calls;

static int regular(int descriptor) {
  struct stat status;
  return descriptor > STDERR_FILENO && fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

static void keep(long number) {
  const char* path = getenv("WRITE_FAILURE_COUNT");
  char text[32];
  int file, length;
  if (!path) return;
  file = (int)syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return;
  length = snprintf(text, sizeof text, "%ld\n", number);
  (void)!syscall(SYS_write, file, text, (size_t)length);
  syscall(SYS_close, file);
}

/* Counts a call. Returns 1 if the call must fail, with the reason in errno. */
static int fails(void) {
  const char* which = getenv("WRITE_FAILURE");
  const char* sticks = getenv("WRITE_FAILURE_STICKS");
  const long wanted = which ? atol(which) : 0;
  long number;
  pthread_mutex_lock(&mutex);
  number = ++calls;
  keep(number);
  pthread_mutex_unlock(&mutex);
  if (wanted == 0 || number < wanted || (number > wanted && !(sticks && *sticks == '1'))) return 0;
  errno = ENOSPC;
  return 1;
}

#define REAL(result, name, ...)                                                                    \
  static result (*real)(__VA_ARGS__);                                                              \
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, name)

static int absent(const char* path) {
  struct stat status;
  return stat(path, &status) != 0 && errno == ENOENT;
}

/* A new file needs space, too. */
static int opens(const char* name, const char* path, int flags, va_list more) {
  REAL(int, name, const char*, int, ...);
  const unsigned mode = (flags & O_CREAT) ? va_arg(more, unsigned) : 0;
  const int before = errno;
  if ((flags & O_CREAT) && absent(path) && fails()) return -1;
  errno = before;
  return real(path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list more;
  int result;
  va_start(more, flags);
  result = opens("open", path, flags, more);
  va_end(more);
  return result;
}

int open64(const char* path, int flags, ...) {
  va_list more;
  int result;
  va_start(more, flags);
  result = opens("open64", path, flags, more);
  va_end(more);
  return result;
}

FILE* fopen(const char* path, const char* mode) {
  REAL(FILE*, "fopen", const char*, const char*);
  if (*mode != 'r' && absent(path) && fails()) return NULL;
  return real(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  REAL(FILE*, "fopen64", const char*, const char*);
  if (*mode != 'r' && absent(path) && fails()) return NULL;
  return real(path, mode);
}

ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  REAL(ssize_t, "writev", int, const struct iovec*, int);
  if (regular(descriptor) && fails()) return -1;
  return real(descriptor, parts, count);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  REAL(ssize_t, "write", int, const void*, size_t);
  if (regular(descriptor) && fails()) return -1;
  return real(descriptor, bytes, count);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t at) {
  REAL(ssize_t, "pwrite", int, const void*, size_t, off_t);
  if (regular(descriptor) && fails()) return -1;
  return real(descriptor, bytes, count, at);
}

/* Simulates a disk that fills up half way: some of the bytes are written. */
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* stream) {
  REAL(size_t, "fwrite", const void*, size_t, size_t, FILE*);
  if (regular(fileno(stream)) && fails()) {
    const size_t done = real(bytes, size, count / 2, stream);
    errno = ENOSPC;
    return done;
  }
  return real(bytes, size, count, stream);
}

int fflush(FILE* stream) {
  REAL(int, "fflush", FILE*);
  if (stream && regular(fileno(stream)) && fails()) return EOF;
  return real(stream);
}

int fclose(FILE* stream) {
  REAL(int, "fclose", FILE*);
  const int descriptor = fileno(stream);
  const int writes = regular(descriptor) && (fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY;
  const int failed = writes && fails();
  const int result = real(stream);
  if (failed) errno = ENOSPC;
  return failed ? EOF : result;
}

int close(int descriptor) {
  REAL(int, "close", int);
  const int writes = regular(descriptor) && (fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY;
  const int failed = writes && fails();
  const int result = real(descriptor);
  if (failed) errno = ENOSPC;
  return failed ? -1 : result;
}

int rename(const char* from, const char* to) {
  REAL(int, "rename", const char*, const char*);
  return fails() ? -1 : real(from, to);
}

int fsync(int descriptor) {
  REAL(int, "fsync", int);
  return regular(descriptor) && fails() ? -1 : real(descriptor);
}

int fdatasync(int descriptor) {
  REAL(int, "fdatasync", int);
  return regular(descriptor) && fails() ? -1 : real(descriptor);
}
