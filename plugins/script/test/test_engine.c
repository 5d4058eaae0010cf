/* test_engine.c: A script engine for tests, which is also an example: scheme "test:". It calls
 * every function of the script ABI (xvrml/xscript.h). [the browser's thread]
 *
 * A program consists of lines "WHEN: COMMAND ARGUMENT...". WHEN is the name of an eventIn, or
 * create, initialize, eventsProcessed, shutdown or tick. NODE is a field of the Script of type
 * SFNode, `self`, `kept` (see keep), or `value`: the event's node. Refusals of the host are
 * printed. */
#include <xvrml/xscript.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_ARGUMENTS 6

typedef struct Interpreter {
  const XsHost* host;
  const XsScriptInfo* info;
  XsNode kept;
  int32_t count; /* events counted by `after` */
} Interpreter;

typedef struct Call {
  Interpreter* self;
  const XsEvent* event; /* NULL: none */
  char* words[MOST_ARGUMENTS];
  const char* rest; /* the line after the command */
} Call;

static XsString text(const char* string) {
  XsString s = {string, strlen(string)};
  return s;
}

static void say(Interpreter* self, int32_t severity, uint32_t line, const char* what) {
  self->host->log(self->host, self->info->self, severity, line, text(what));
}

/* Prints why the host refused a call. Stops the program only if its time is up. */
static XsResult answer(Call* call, XsResult result) {
  if (result == XS_OK || result == XS_STOPPED) return result;
  XsString why = {"", 0};
  char message[400];
  call->self->host->lastError(call->self->host, call->self->info->self, &why);
  snprintf(message, sizeof message, "%s: %d %s", call->words[0], (int)result, why.data);
  say(call->self, 0, 0, message);
  return XS_OK;
}

static XsNode nodeOf(Call* call, const char* name) {
  Interpreter* self = call->self;
  XsValue value;
  if (strcmp(name, "self") == 0) return self->info->self;
  if (strcmp(name, "kept") == 0) return self->kept;
  if (strcmp(name, "value") == 0)
    return call->event &&
                   (call->event->value.type == XS_SFNODE || call->event->value.type == XS_MFNODE) &&
                   call->event->value.count > 0
               ? call->event->value.of.nodes[0]
               : 0;
  if (self->host->read(self->host, self->info->self, self->info->self, name, &value) != XS_OK ||
      value.type != XS_SFNODE)
    return 0;
  return value.of.nodes[0];
}

static XsValue strings(const XsString* list, uint32_t count, XsType type) {
  XsValue value = {type, count, {NULL}};
  value.of.strings = list;
  return value;
}

/* --- Commands: send, read, write, post --- */

static XsResult echo(Call* c) { /* arguments: OUT */
  if (!c->event) return XS_FAILED;
  return answer(
      c, c->self->host->send(c->self->host, c->self->info->self, c->words[1], &c->event->value));
}

static XsResult sendText(Call* c) { /* arguments: OUT TEXT; sends an SFString */
  XsString s = text(strlen(c->rest) > strlen(c->words[1]) ? c->rest + strlen(c->words[1]) + 1 : "");
  XsValue value = strings(&s, 1, XS_SFSTRING);
  return answer(c, c->self->host->send(c->self->host, c->self->info->self, c->words[1], &value));
}

static XsResult add(Call* c) { /* arguments: FIELD OUT; sends the SFInt32 field plus the event */
  const XsHost* host = c->self->host;
  const XsNode self = c->self->info->self;
  XsValue field;
  int32_t sum;
  XsValue value = {XS_SFINT32, 1, {&sum}};
  XsResult result = host->read(host, self, self, c->words[1], &field);
  if (result != XS_OK || field.type != XS_SFINT32 || !c->event) return answer(c, result);
  sum = field.of.ints[0] + c->event->value.of.ints[0];
  result = answer(c, host->write(host, self, c->words[1], &value));
  return result != XS_OK ? result : answer(c, host->send(host, self, c->words[2], &value));
}

static XsResult after(Call* c) { /* arguments: N OUT; sends the Nth event and drops the others */
  return ++c->self->count == atoi(c->words[1])
             ? answer(c, c->self->host->send(c->self->host, c->self->info->self, c->words[2],
                                             &c->event->value))
             : XS_OK;
}

static XsResult readNode(Call* c) { /* arguments: NODE FIELD OUT */
  const XsHost* host = c->self->host;
  XsValue value;
  const XsResult result =
      host->read(host, c->self->info->self, nodeOf(c, c->words[1]), c->words[2], &value);
  return answer(c, result == XS_OK ? host->send(host, c->self->info->self, c->words[3], &value)
                                   : result);
}

static XsResult
writeField(Call* c) { /* argument: FIELD; writes the event's value to a field of the Script */
  return answer(
      c, c->self->host->write(c->self->host, c->self->info->self, c->words[1], &c->event->value));
}

static XsResult post(Call* c) { /* arguments: NODE EVENTIN; posts the event, or TRUE without one */
  const int32_t yes = 1;
  XsValue value = {XS_SFBOOL, 1, {&yes}};
  if (c->event) value = c->event->value;
  return answer(c, c->self->host->post(c->self->host, c->self->info->self, nodeOf(c, c->words[1]),
                                       c->words[2], &value));
}

static XsResult describe(Call* c) { /* argument: NODE; prints its type, name and fields */
  static const char* const access[] = {"", "field", "exposedField", "eventIn", "eventOut"};
  const XsHost* host = c->self->host;
  XsNodeInfo info = {sizeof(XsNodeInfo), 0, NULL, NULL};
  char line[300];
  const XsNode node = nodeOf(c, c->words[1]);
  const XsResult result = host->describe(host, c->self->info->self, node, &info);
  if (result != XS_OK) return answer(c, result);
  snprintf(line, sizeof line, "%s '%s'", info.typeName, info.defName);
  say(c->self, 0, 0, line);
  for (uint32_t i = 0; i < info.fieldCount; i++) {
    XsField field;
    if (host->field(host, c->self->info->self, node, i, &field) != XS_OK) return XS_FAILED;
    snprintf(line, sizeof line, "%s %d %s", access[field.access], (int)field.type, field.name);
    say(c->self, 0, 0, line);
  }
  return XS_OK;
}

static XsResult find(Call* c) { /* arguments: NODE NAME; prints the field with this name */
  XsField field;
  char line[300];
  const XsResult result = c->self->host->findField(c->self->host, c->self->info->self,
                                                   nodeOf(c, c->words[1]), c->words[2], &field);
  if (result != XS_OK) return answer(c, result);
  snprintf(line, sizeof line, "%s is %d %s", c->words[2], (int)field.type, field.name);
  say(c->self, 0, 0, line);
  return XS_OK;
}

static XsResult keep(Call* c) { /* keeps the event's node as `kept` */
  const XsNode node = nodeOf(c, "value");
  c->self->kept = node;
  return answer(c, c->self->host->retain(c->self->host, c->self->info->self, node));
}

static XsResult borrow(Call* c) { /* sets `kept` without retaining the node: it is invalid later */
  c->self->kept = nodeOf(c, "value");
  return XS_OK;
}

static XsResult drop(Call* c) {
  return answer(c, c->self->host->release(c->self->host, c->self->info->self, c->self->kept));
}

/* --- The Browser object --- */

static XsResult
browser(Call* c) { /* argument: OUT; sends an MFString of the Browser's properties */
  const XsHost* host = c->self->host;
  const XsNode self = c->self->info->self;
  XsString s;
  XsString list[5];
  char name[100], version[100], url[400], speed[40], rate[40];
  if (host->getName(host, self, &s) != XS_OK) return XS_FAILED;
  snprintf(name, sizeof name, "%s", s.data);
  if (host->getVersion(host, self, &s) != XS_OK) return XS_FAILED;
  snprintf(version, sizeof version, "%s", s.data);
  if (host->getWorldUrl(host, self, &s) != XS_OK) return XS_FAILED;
  snprintf(url, sizeof url, "%s", s.data);
  snprintf(speed, sizeof speed, "%g", host->getCurrentSpeed(host, self));
  snprintf(rate, sizeof rate, "%g", host->getCurrentFrameRate(host, self));
  list[0] = text(name);
  list[1] = text(version);
  list[2] = text(url);
  list[3] = text(speed);
  list[4] = text(rate);
  const XsValue value = strings(list, 5, XS_MFSTRING);
  return answer(c, host->send(host, self, c->words[1], &value));
}

static XsResult description(Call* c) { /* argument: TEXT */
  return answer(c,
                c->self->host->setDescription(c->self->host, c->self->info->self, text(c->rest)));
}

static XsResult create(Call* c) { /* arguments: OUT VRML; creates nodes and sends them */
  const XsHost* host = c->self->host;
  XsValue nodes;
  const XsResult result = host->createVrmlFromString(host, c->self->info->self,
                                                     text(c->rest + strlen(c->words[1])), &nodes);
  return answer(c, result == XS_OK ? host->send(host, c->self->info->self, c->words[1], &nodes)
                                   : result);
}

static XsResult fromUrl(Call* c) { /* arguments: NODE EVENTIN URL */
  const XsString url = text(c->words[3]);
  return answer(c, c->self->host->createVrmlFromUrl(c->self->host, c->self->info->self, 1, &url,
                                                    nodeOf(c, c->words[1]), c->words[2]));
}

static XsResult load(Call* c) { /* arguments: URL PARAMETER */
  const XsString url = text(c->words[1]), parameter = text(c->words[2]);
  return answer(c, c->self->host->loadUrl(c->self->host, c->self->info->self, 1, &url,
                                          *c->words[2] ? 1 : 0, &parameter));
}

static XsResult replace(Call* c) { /* replaces the world by the event's nodes */
  if (!c->event || c->event->value.type != XS_MFNODE) return XS_FAILED;
  return answer(c, c->self->host->replaceWorld(c->self->host, c->self->info->self,
                                               c->event->value.count, c->event->value.of.nodes));
}

static XsResult addRoute(Call* c) { /* arguments: NODE OUT NODE IN */
  const XsHost* host = c->self->host;
  const XsNode from = nodeOf(c, c->words[1]), to = nodeOf(c, c->words[3]);
  return answer(c, host->addRoute(host, c->self->info->self, from, c->words[2], to, c->words[4]));
}

static XsResult deleteRoute(Call* c) {
  const XsHost* host = c->self->host;
  const XsNode from = nodeOf(c, c->words[1]), to = nodeOf(c, c->words[3]);
  return answer(c,
                host->deleteRoute(host, c->self->info->self, from, c->words[2], to, c->words[4]));
}

/* --- Scenes and nodes of X3D --- */

/* Adds a value to a line: texts as they are, nodes as TYPE:NAME. */
static void addValue(Call* c, const XsValue* value, char* line, size_t size) {
  const XsHost* host = c->self->host;
  const XsNode self = c->self->info->self;
  XsNode nodes[8];
  uint32_t count = value->count < 8 ? value->count : 8;
  for (uint32_t i = 0; i < count; ++i) {
    const size_t used = strlen(line);
    if (value->type == XS_MFSTRING)
      snprintf(line + used, size - used, " %s", value->of.strings[i].data);
    else
      nodes[i] = value->of.nodes[i]; /* the next call of the host ends the value */
  }
  for (uint32_t i = 0; value->type != XS_MFSTRING && i < count; ++i) {
    const size_t used = strlen(line);
    XsNodeInfo info = {sizeof info, 0, NULL, NULL};
    if (host->describe(host, self, nodes[i], &info) == XS_OK)
      snprintf(line + used, size - used, " %s:%s", info.typeName, info.defName);
  }
}

static XsResult scene(Call* c) { /* arguments: WHAT ARGUMENT...; prints what the host tells */
  const XsHost* host = c->self->host;
  const XsNode self = c->self->info->self;
  const char *what = c->words[1], *first = c->words[2], *second = c->words[3];
  XsValue value = {XS_MFSTRING, 0, {NULL}};
  XsString written = {"", 0};
  XsResult result = XS_FAILED;
  char line[600] = "";
  snprintf(line, sizeof line, "%s", what);
  if (strcmp(what, "named") == 0) result = host->namedNode(host, self, text(first), &value);
  if (strcmp(what, "roots") == 0) result = host->rootNodes(host, self, &value);
  if (strcmp(what, "facts") == 0) result = host->sceneFacts(host, self, &value);
  if (strcmp(what, "instance") == 0) result = host->createInstance(host, self, text(first), &value);
  if (strcmp(what, "within") == 0)
    result = host->nodeWithin(host, self, nodeOf(c, first), text(second), &value);
  if (strcmp(what, "types") == 0) result = host->nodeTypes(host, self, nodeOf(c, first), &value);
  if (strcmp(what, "text") == 0) {
    result = host->writeNode(host, self, nodeOf(c, first), text(second), &written);
    if (result == XS_OK) snprintf(line, sizeof line, "text %s", written.data);
  }
  if (strcmp(what, "file") == 0) {
    const XsNode node = nodeOf(c, first);
    result = host->writeScene(host, self, 1, &node, text(second), &written);
    if (result == XS_OK) snprintf(line, sizeof line, "file %s", written.data);
  }
  if (result == XS_OK) {
    addValue(c, &value, line, sizeof line);
    say(c->self, 0, 0, line);
  }
  return answer(c, result);
}

/* --- Time, messages, errors --- */

static XsResult now(Call* c) { /* argument: OUT, an SFTime */
  const double time = c->self->host->now(c->self->host, c->self->info->self);
  const XsValue value = {XS_SFTIME, 1, {&time}};
  return answer(c, c->self->host->send(c->self->host, c->self->info->self, c->words[1], &value));
}

static XsResult print(Call* c) {
  say(c->self, 0, 0, c->rest);
  return XS_OK;
}
static XsResult error(Call* c) { /* arguments: LINE TEXT */
  say(c->self, 3, (uint32_t)atoi(c->words[1]), c->rest + strlen(c->words[1]) + 1);
  return XS_FAILED;
}
static XsResult fail(Call* c) {
  (void)c;
  return XS_FAILED;
}
static XsResult loop(Call* c) { /* runs until it is stopped */
  while (!c->self->host->shouldStop(c->self->host, c->self->info->self, 1000)) {}
  return XS_STOPPED;
}

static XsResult wrong(Call* c) { /* argument: OUT; sends values that the host must refuse */
  const XsHost* host = c->self->host;
  const XsNode self = c->self->info->self;
  const int32_t number = 1;
  const XsString bad = {"\xff", 1}, none = {NULL, 5};
  XsValue value = {XS_SFINT32, 1, {&number}};
  answer(c, host->send(host, self, c->words[1], &value));
  answer(c, host->send(host, self, c->words[1], NULL));
  value = strings(NULL, 3, XS_MFSTRING);
  answer(c, host->send(host, self, c->words[1], &value));
  value = strings(&bad, 1, XS_MFSTRING);
  answer(c, host->send(host, self, c->words[1], &value));
  value = strings(&none, 1, XS_MFSTRING);
  answer(c, host->send(host, self, c->words[1], &value));
  answer(c, host->send(host, self, "noSuchEvent", &value));
  answer(c, host->send(host, self, NULL, &value));
  answer(c, host->post(host, self, 123456789, "set_x", &value));
  return answer(c, host->send(host, 987654321, c->words[1], &value));
}

static const struct {
  const char* name;
  XsResult (*run)(Call* call);
} commands[] = {{"echo", echo},         {"text", sendText},
                {"add", add},           {"after", after},
                {"read", readNode},     {"write", writeField},
                {"post", post},         {"describe", describe},
                {"find", find},         {"keep", keep},
                {"borrow", borrow},     {"drop", drop},
                {"browser", browser},   {"description", description},
                {"create", create},     {"fromUrl", fromUrl},
                {"load", load},         {"replace", replace},
                {"addRoute", addRoute}, {"deleteRoute", deleteRoute},
                {"now", now},           {"print", print},
                {"error", error},       {"fail", fail},
                {"loop", loop},         {"wrong", wrong},
                {"scene", scene}};

/* Runs one line: splits a copy into words and calls the command. */
static XsResult runLine(Call call, const char* line, size_t length) {
  char copy[2000], words[2000], *p;
  if (length >= sizeof copy) return XS_FAILED;
  memcpy(copy, line, length);
  copy[length] = 0;
  memcpy(words, copy, length + 1);
  p = words;
  for (int i = 0; i < MOST_ARGUMENTS; i++) {
    while (*p == ' ') p++;
    call.words[i] = p;
    while (*p && *p != ' ') p++;
    if (*p) *p++ = 0;
  }
  call.rest = copy + (call.words[0] - words) + strlen(call.words[0]);
  while (*call.rest == ' ') call.rest++;
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
    if (strcmp(commands[i].name, call.words[0]) == 0) return commands[i].run(&call);
  return XS_FAILED;
}

/* Runs all lines for this event, in order. */
static XsResult run(XsInterpreter interpreter, const char* when, const XsEvent* event) {
  Call call = {0};
  call.self = (Interpreter*)(uintptr_t)interpreter;
  call.event = event;
  const XsString program = call.self->info->text;
  const size_t length = strlen(when);
  for (const char *p = program.data, *end = p + program.bytes; p < end;) {
    const char* stop = memchr(p, '\n', (size_t)(end - p));
    if (!stop) stop = end;
    while (p < stop && *p == ' ') p++;
    if ((size_t)(stop - p) > length && memcmp(p, when, length) == 0 && p[length] == ':') {
      const XsResult result = runLine(call, p + length + 1, (size_t)(stop - p) - length - 1);
      if (result != XS_OK) return result;
    }
    p = stop + 1;
  }
  return XS_OK;
}

static XsResult createInterpreter(const XsHost* host, const XsScriptInfo* info,
                                  XsInterpreter* made) {
  Interpreter* self = calloc(1, sizeof *self);
  if (!self) return XS_FAILED;
  self->host = host;
  self->info = info;
  const XsResult result = run((XsInterpreter)(uintptr_t)self, "create", NULL);
  if (result != XS_OK)
    free(self);
  else
    *made = (XsInterpreter)(uintptr_t)self;
  return result;
}
static void destroyInterpreter(XsInterpreter interpreter) { free((void*)(uintptr_t)interpreter); }
static XsResult initialize(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "initialize", NULL);
}
static XsResult event(XsInterpreter interpreter, const XsEvent* event) {
  return run(interpreter, event->name, event);
}
static XsResult processed(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "eventsProcessed", NULL);
}
static XsResult shutdown(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "shutdown", NULL);
}
static XsResult tick(XsInterpreter interpreter, double time) {
  (void)time;
  return run(interpreter, "tick", NULL);
}

static const char* const schemes[] = {"test", NULL};
static const char* const mimeTypes[] = {"text/x-test", NULL};
static const char* const suffixes[] = {".test", NULL};
static const char* const trustedSchemes[] = {"trusted-test", NULL};
static const XsEngine engine = {sizeof(XsEngine),
                                XS_HARMLESS,
                                "test",
                                "lines of commands, for tests",
                                schemes,
                                mimeTypes,
                                suffixes,
                                createInterpreter,
                                destroyInterpreter,
                                initialize,
                                event,
                                processed,
                                shutdown,
                                tick,
                                NULL,
                                NULL};
static const XsEngine trusted = {
    sizeof(XsEngine),   XS_NEEDS_TRUST, "trusted", "the same for trusted worlds",
    trustedSchemes,     NULL,           NULL,      createInterpreter,
    destroyInterpreter, initialize,     event,     processed,
    shutdown,           NULL,           NULL,      NULL};
static const XsEngine* const engines[] = {&engine, &trusted};
XS_EXPORT const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin),
                                     2,        engines};
