/* formula.c: A script engine for a language with one kind of statement, NAME = EXPRESSION. It is
 * a template for other engines (docs/script-engines.md). Scheme "formula:", files "*.formula".
 * [the browser's thread]
 *
 *   DEF Wave Script {
 *     eventIn SFTime time  field SFFloat height 2  eventOut SFFloat y
 *     url "formula: y = height * sin(3 * time)"
 *   }
 *
 * Names are functions, and the Script's fields and events of the types SFBool, SFInt32, SFFloat
 * and SFTime. When events have arrived, all statements run in order. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xvrml/xscript.h>

enum { mostDepth = 200 }; /* maximum nesting of parentheses: programs are not trusted */

/* --- The interpreter of a Script, from `create` to `destroy` --- */

typedef struct Formula {
  const XsHost* host;       /* both are valid until destroy */
  const XsScriptInfo* info; /* the program and the Script's declarations */
  int due;                  /* events have arrived */
  const char* at;           /* position of the next character (parser) */
  const char* end;          /* end of the program (parser) */
  uint32_t line;            /* current line, counted from 1 (parser) */
  uint32_t depth;           /* nesting depth of parentheses (parser) */
  uint64_t steps;           /* operations since shouldStop was last called */
  double values[];          /* current values of info->fields */
} Formula;

/* --- Messages; the host adds the file name and the program's first line --- */

static XsResult fail(Formula* f, const char* what, const char* name, size_t length) {
  char text[200];
  const int shown = length < 60 ? (int)length : 60;
  const int bytes = snprintf(text, sizeof text, "%s%.*s", what, shown, name);
  const XsString message = {text, (uint64_t)bytes};
  f->host->log(f->host, f->info->self, 3, f->line, message);
  return XS_FAILED;
}

/* --- Values: plain C arrays, here of one number --- */

static double numberOf(const XsValue* value) {
  switch (value->type) {
  case XS_SFBOOL:
  case XS_SFINT32: return value->of.ints[0];
  case XS_SFFLOAT: return value->of.floats[0];
  case XS_SFTIME: return value->of.doubles[0];
  default: return 0;
  }
}

/* Sends an eventOut or writes a field. The host refuses invalid values (NaN) and says why. */
static XsResult give(Formula* f, const XsField* field, double number) {
  const XsHost* host = f->host;
  const int isInt = number > -2147483649.0 && number < 2147483648.0;
  const int32_t whole = field->type == XS_SFBOOL ? number != 0 : isInt ? (int32_t)number : 0;
  const float single = (float)number;
  XsValue value = {field->type, 1, {NULL}};
  XsString why = {"", 0};
  if (field->type == XS_SFFLOAT)
    value.of.floats = &single;
  else if (field->type == XS_SFTIME)
    value.of.doubles = &number;
  else
    value.of.ints = &whole;
  const XsResult result = (field->access == XS_EVENT_OUT ? host->send : host->write)(
      host, f->info->self, field->name, &value);
  if (result == XS_OK || result == XS_STOPPED) return result;
  host->lastError(host, f->info->self, &why);
  return fail(f, "", why.data, why.bytes);
}

/* --- The language: a parser that evaluates while it reads; with `run` 0 it only parses, as in
 * `create`, to find errors --- */

static const struct {
  const char* name;
  double (*call)(double);
} functions[] = {{"sin", sin},     {"cos", cos},     {"tan", tan}, {"sqrt", sqrt}, {"abs", fabs},
                 {"floor", floor}, {"round", round}, {"exp", exp}, {"log", log}};

static void blanks(Formula* f) { /* skips blanks; a line end ends the statement */
  while (f->at < f->end && (*f->at == ' ' || *f->at == '\t' || *f->at == '\r')) f->at++;
}
static int take(Formula* f, char c) {
  blanks(f);
  if (f->at >= f->end || *f->at != c) return 0;
  f->at++;
  return 1;
}
static size_t name(Formula* f, const char** begin) {
  blanks(f);
  *begin = f->at;
  while (f->at < f->end && (isalnum((unsigned char)*f->at) || *f->at == '_')) f->at++;
  return (size_t)(f->at - *begin);
}
static int is(const char* known, const char* text, size_t length) {
  return strlen(known) == length && memcmp(known, text, length) == 0;
}
static const XsField* fieldNamed(Formula* f, const char* text, size_t length) {
  for (uint32_t i = 0; i < f->info->fieldCount; i++)
    if (is(f->info->fields[i].name, text, length)) return &f->info->fields[i];
  return NULL;
}

static XsResult sum(Formula* f, double* result);

static XsResult factor(Formula* f, double* result) {
  const char* word;
  size_t length;
  XsResult answer;
  f->steps++;
  blanks(f);
  if (f->at < f->end && (isdigit((unsigned char)*f->at) || *f->at == '.')) {
    /* strtod stops at the zero byte that ends the host's texts. */
    char* rest;
    *result = strtod(f->at, &rest);
    if (rest == f->at) return fail(f, "a number was expected", "", 0);
    f->at = rest;
    return XS_OK;
  }
  if (++f->depth > mostDepth) return fail(f, "too many parentheses within one another", "", 0);
  if (take(f, '-')) {
    answer = factor(f, result);
    *result = -*result;
  } else if (take(f, '(')) {
    answer = sum(f, result);
    if (answer == XS_OK && !take(f, ')')) answer = fail(f, "')' was expected", "", 0);
  } else if ((length = name(f, &word)) == 0) {
    answer = fail(f, "a number, a name or '(' was expected", "", 0);
  } else if (take(f, '(')) {
    size_t i = 0;
    const size_t count = sizeof functions / sizeof *functions;
    while (i < count && !is(functions[i].name, word, length)) i++;
    answer = i < count ? sum(f, result) : fail(f, "there is no function ", word, length);
    if (answer == XS_OK && !take(f, ')')) answer = fail(f, "')' was expected", "", 0);
    if (answer == XS_OK) *result = functions[i].call(*result);
  } else {
    const XsField* field = fieldNamed(f, word, length);
    answer = field ? XS_OK : fail(f, "the Script has no field or event ", word, length);
    if (field) *result = f->values[field - f->info->fields];
  }
  f->depth--;
  return answer;
}

static XsResult product(Formula* f, double* result) {
  XsResult answer = factor(f, result);
  while (answer == XS_OK) {
    double right;
    const int times = take(f, '*');
    if (!times && !take(f, '/')) break;
    if ((answer = factor(f, &right)) == XS_OK) *result = times ? *result * right : *result / right;
  }
  return answer;
}

static XsResult sum(Formula* f, double* result) {
  XsResult answer = product(f, result);
  while (answer == XS_OK) {
    double right;
    const int plus = take(f, '+');
    if (!plus && !take(f, '-')) break;
    if ((answer = product(f, &right)) == XS_OK) *result = plus ? *result + right : *result - right;
  }
  return answer;
}

static XsResult statement(Formula* f, int run) {
  const char* word;
  double result = 0;
  const size_t length = name(f, &word);
  const XsField* field = fieldNamed(f, word, length);
  if (!field || field->access == XS_EVENT_IN)
    return fail(f, "no field or eventOut of the Script: ", word, length);
  if (field->type != XS_SFBOOL && field->type != XS_SFINT32 && field->type != XS_SFFLOAT &&
      field->type != XS_SFTIME)
    return fail(f, "not of type SFBool, SFInt32, SFFloat or SFTime: ", word, length);
  if (!take(f, '=')) return fail(f, "'=' was expected behind ", word, length);
  const XsResult answer = sum(f, &result);
  if (answer != XS_OK) return answer;
  blanks(f);
  if (f->at < f->end && *f->at != '\n') return fail(f, "unexpected: ", f->at, 1);
  if (!run) return XS_OK;
  f->values[field - f->info->fields] = result;
  return give(f, field, result);
}

static XsResult program(Formula* f, int run) {
  XsResult answer = XS_OK;
  f->at = f->info->text.data;
  f->end = f->at + f->info->text.bytes;
  for (f->line = 1; answer == XS_OK && f->at < f->end; f->line++) {
    f->depth = 0;
    blanks(f);
    if (f->at < f->end && *f->at != '\n') answer = statement(f, run);
    while (f->at < f->end && *f->at != '\n') f->at++; /* skips the rest of a line with an error */
    if (f->at < f->end) f->at++;
    if (f->host->shouldStop(f->host, f->info->self, f->steps)) return XS_STOPPED;
    f->steps = 0;
  }
  return answer;
}

/* --- The functions that the host calls --- */

static XsResult create(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made) {
  Formula* f = calloc(1, sizeof *f + info->fieldCount * sizeof *f->values);
  if (!f) return XS_FAILED;
  f->host = host;
  f->info = info;
  const XsResult answer = program(f, 0);
  if (answer != XS_OK)
    free(f);
  else
    *made = (XsInterpreter)(uintptr_t)f;
  return answer;
}
static void destroy(XsInterpreter interpreter) { free((void*)(uintptr_t)interpreter); }

/* The event's data are valid until this function returns, so numbers are copied. */
static XsResult event(XsInterpreter interpreter, const XsEvent* event) {
  Formula* f = (Formula*)(uintptr_t)interpreter;
  f->values[event->index] = numberOf(&event->value);
  f->due = 1;
  return XS_OK;
}

static XsResult eventsProcessed(XsInterpreter interpreter, double time) {
  Formula* f = (Formula*)(uintptr_t)interpreter;
  XsValue value;
  (void)time;
  if (!f->due) return XS_OK;
  f->due = 0;
  for (uint32_t i = 0; i < f->info->fieldCount; i++) { /* other nodes may have changed a field */
    const XsField* field = &f->info->fields[i];
    if (field->access == XS_FIELD &&
        f->host->read(f->host, f->info->self, f->info->self, field->name, &value) == XS_OK)
      f->values[i] = numberOf(&value);
  }
  return program(f, 1);
}

static const char* const schemes[] = {"formula", NULL};
static const char* const suffixes[] = {".formula", NULL};
/* XS_HARMLESS promises that a program ends soon, allocates no memory, and uses only the host's
 * functions. Without this promise, leave the flag out; programs of untrusted worlds then run in
 * a process of their own. */
static const XsEngine engine = {.size = sizeof(XsEngine),
                                .flags = XS_HARMLESS,
                                .name = "formula",
                                .text = "formulas: y = sin(x) * 2",
                                .schemes = schemes,
                                .suffixes = suffixes,
                                .create = create,
                                .destroy = destroy,
                                .event = event,
                                .eventsProcessed = eventsProcessed};
static const XsEngine* const engines[] = {&engine};
XS_EXPORT const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin),
                                     1,        engines};
