/* hostile_engine.c: a script engine that does everything a program must not do, with the scheme
 * "hostile:". It stands for an engine whose library has been taken over by the program it runs. A
 * program has lines "WHEN: COMMAND ARGUMENT". WHEN is the name of an eventIn, or create,
 * initialize, eventsProcessed, shutdown, destroy, tick. Each attempt is printed with its outcome.
 */
#define _GNU_SOURCE
#include <xvrml/xscript.h>

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef struct Interpreter {
  const XsHost* host;
  const XsScriptInfo* info;
} Interpreter;

static volatile int64_t sink;

static void say(const Interpreter* self, const char* what) {
  const XsString text = {what, strlen(what)};
  self->host->log(self->host, self->info->self, 0, 0, text);
}
static void outcome(const Interpreter* self, const char* what, int worked) {
  char line[200];
  snprintf(line, sizeof line, "%s: %s", what, worked ? "worked" : strerror(errno));
  say(self, line);
}

/* --- Commands that do not end --- */

static void spin(Interpreter* self, const char* argument) {
  (void)self;
  (void)argument;
  for (;;) sink++;
}
/* Calls the host forever and ignores the answers. */
static void calls(Interpreter* self, const char* argument) {
  XsValue value;
  for (;;) self->host->read(self->host, self->info->self, self->info->self, argument, &value);
}
static void chatter(Interpreter* self, const char* argument) {
  for (;;) say(self, argument);
}
/* Sleeps MILLISECONDS, then prints "slept". */
static void slow(Interpreter* self, const char* argument) {
  const long ms = atol(argument);
  const struct timespec time = {ms / 1000, ms % 1000 * 1000000L};
  nanosleep(&time, NULL);
  say(self, "slept");
}

/* --- Commands that take all resources --- */

static void bomb(Interpreter* self, const char* argument) {
  (void)self;
  (void)argument;
  for (;;) {
    char* block = malloc(1 << 20);
    if (!block) abort();
    memset(block, 1, 1 << 20);
    sink += block[123];
  }
}
static int deeper(volatile char* above) {
  volatile char frame[1000];
  frame[0] = (char)(above[0] + 1);
  return sink == -1 ? 0 : deeper(frame) + frame[0];
}
static void recurse(Interpreter* self, const char* argument) {
  volatile char top[1] = {0};
  (void)self;
  (void)argument;
  sink = deeper(top);
}
static void crash(Interpreter* self, const char* argument) {
  (void)self;
  (void)argument;
  raise(SIGSEGV);
  abort();
}
static void leave(Interpreter* self, const char* argument) {
  (void)self;
  _exit(atoi(argument));
}

/* --- Commands that access the outside --- */

static void readFile(Interpreter* self, const char* argument) {
  outcome(self, "open", open(argument, O_RDONLY) >= 0);
}
static void writeFile(Interpreter* self, const char* argument) {
  outcome(self, "create", open(argument, O_CREAT | O_WRONLY, 0600) >= 0);
}
static void connectOut(Interpreter* self, const char* argument) {
  (void)argument;
  outcome(self, "socket", socket(AF_INET, SOCK_STREAM, 0) >= 0);
}
static void execute(Interpreter* self, const char* argument) {
  char* const arguments[] = {(char*)"true", NULL};
  execv(argument, arguments);
  outcome(self, "exec", 0);
}
static void forks(Interpreter* self, const char* argument) {
  const pid_t child = fork();
  (void)argument;
  if (child == 0) _exit(0);
  outcome(self, "fork", child > 0);
}
static void signals(Interpreter* self, const char* argument) {
  (void)argument;
  outcome(self, "kill", kill(getppid(), 0) == 0);
}
/* Tries to raise the limits again. */
static void raises(Interpreter* self, const char* argument) {
  const struct rlimit most = {RLIM_INFINITY, RLIM_INFINITY};
  (void)argument;
  outcome(self, "setrlimit", setrlimit(RLIMIT_AS, &most) == 0);
}
static void environment(Interpreter* self, const char* argument) {
  say(self, getenv(argument) ? "set" : "not set");
}
/* Whether the process started with LD_LIBRARY_PATH, before it gave up its rights. */
static int libraryPath;
__attribute__((constructor)) static void loaded(void) {
  libraryPath = getenv("LD_LIBRARY_PATH") != NULL;
}
static void given(Interpreter* self, const char* argument) {
  (void)argument;
  say(self, libraryPath ? "given" : "not given");
}
/* Prints how many are open besides the standard ones and the socket. */
static void descriptors(Interpreter* self, const char* argument) {
  int open = 0;
  char line[40];
  (void)argument;
  for (int i = 4; i < 1024; i++) open += fcntl(i, F_GETFD) >= 0;
  snprintf(line, sizeof line, "%d open", open);
  say(self, line);
}

/* --- Well-behaved commands --- */

static void print(Interpreter* self, const char* argument) { say(self, argument); }
/* Sends the number of its process to OUT. */
static void process(Interpreter* self, const char* argument) {
  const int32_t number = (int32_t)getpid();
  const XsValue value = {XS_SFINT32, 1, {&number}};
  self->host->send(self->host, self->info->self, argument, &value);
}
/* Runs forever, but calls the host. */
static void polite(Interpreter* self, const char* argument) {
  (void)argument;
  while (!self->host->shouldStop(self->host, self->info->self, 1)) sink++;
}
/* Sends raw bytes in place of a message. */
static void speak(Interpreter* self, const char* argument) {
  ssize_t written = write(3, argument, strlen(argument));
  outcome(self, "write", written > 0);
}

static const struct {
  const char* name;
  void (*run)(Interpreter* self, const char* argument);
} commands[] = {{"spin", spin},        {"calls", calls},       {"chatter", chatter},
                {"slow", slow},        {"bomb", bomb},         {"recurse", recurse},
                {"crash", crash},      {"exit", leave},        {"open", readFile},
                {"create", writeFile}, {"socket", connectOut}, {"exec", execute},
                {"fork", forks},       {"kill", signals},      {"raise", raises},
                {"env", environment},  {"given", given},       {"descriptors", descriptors},
                {"print", print},      {"process", process},   {"polite", polite},
                {"speak", speak}};

/* Runs all lines for this event, in order. */
static XsResult run(XsInterpreter interpreter, const char* when) {
  Interpreter* self = (Interpreter*)(uintptr_t)interpreter;
  const char* p = self->info->text.data;
  while (*p) {
    char line[1000], *command, *argument;
    const size_t length = strcspn(p, "\n");
    snprintf(line, sizeof line, "%.*s", (int)length, p);
    p += length + (p[length] == '\n');
    command = strchr(line, ':');
    if (!command) continue;
    *command++ = 0;
    if (strcmp(line + strspn(line, " "), when) != 0) continue;
    command += strspn(command, " ");
    argument = strchr(command, ' ');
    if (argument) *argument++ = 0;
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
      if (strcmp(commands[i].name, command) == 0) commands[i].run(self, argument ? argument : "");
  }
  return XS_OK;
}

static XsResult create(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made) {
  Interpreter* self = calloc(1, sizeof *self);
  if (!self) return XS_FAILED;
  self->host = host;
  self->info = info;
  *made = (XsInterpreter)(uintptr_t)self;
  return run(*made, "create");
}
static void destroy(XsInterpreter interpreter) {
  run(interpreter, "destroy");
  free((void*)(uintptr_t)interpreter);
}
static XsResult initialize(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "initialize");
}
static XsResult event(XsInterpreter interpreter, const XsEvent* event) {
  return run(interpreter, event->name);
}
static XsResult processed(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "eventsProcessed");
}
static XsResult shutDown(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "shutdown");
}
static XsResult tick(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "tick");
}

static const char* const schemes[] = {"hostile", NULL};
static const XsEngine engine = {sizeof(XsEngine), 0,          "hostile", "misbehaves, for tests",
                                schemes,          NULL,       NULL,      create,
                                destroy,          initialize, event,     processed,
                                shutDown,         tick,       NULL,      NULL};
static const XsEngine* const engines[] = {&engine};
XS_EXPORT const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin),
                                     1,        engines};
