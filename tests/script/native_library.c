/* native_library.c: C functions like those of real libraries, for tests of the script engine
 * `native`: numbers, vectors, lists, texts, pictures and nodes in and out; functions with the names
 * of events; a sensor to poll. Called on the browser's thread. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <xvrml/xscript.h>

float twice(float x) { return 2 * x; }
float addOne(float x) { return x + 1; }
float tenTimes(float x) { return 10 * x; }
double half(double x) { return x / 2; }
int32_t invert(int32_t yes) { return !yes; }
int64_t wide(int64_t x, uint8_t small) { return x * 1000 + small; }

float length2(const float v[3]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }
void swap2(const float* v, float* out) {
  out[0] = v[1];
  out[1] = v[0];
}
void shift3(const float* v, float by, float* out) {
  out[0] = v[0] + by;
  out[1] = v[1] + by;
  out[2] = v[2] + by;
}
void turn(const float* r, float* out) {
  memcpy(out, r, 4 * sizeof(float));
  out[3] += 1;
}

/* Returns all numbers of a list and one more. *count is the capacity on entry and the number of
 * elements on return. */
void more_floats(const float* v, uint32_t n, float* out, uint32_t* count) {
  if (n + 1 > *count) return;
  memcpy(out, v, n * sizeof *v);
  out[n] = (float)n;
  *count = n + 1;
}
void more_ints(const int32_t* v, uint32_t n, int32_t* out, uint32_t* count) {
  memcpy(out, v, n * sizeof *v);
  out[n] = (int32_t)n;
  *count = n + 1;
}
void more_times(const double* v, uint32_t n, double* out, uint32_t* count) {
  memcpy(out, v, n * sizeof *v);
  out[n] = (double)n;
  *count = n + 1;
}
void reverse3(const float* v, uint32_t n, float* out, uint32_t* count) {
  for (uint32_t i = 0; i < n; ++i) memcpy(out + 3 * i, v + 3 * (n - 1 - i), 3 * sizeof *v);
  *count = n;
}
void reverse2(const float* v, uint32_t n, float* out, uint32_t* count) {
  for (uint32_t i = 0; i < n; ++i) memcpy(out + 2 * i, v + 2 * (n - 1 - i), 2 * sizeof *v);
  *count = n;
}
void reverse4(const float* v, uint32_t n, float* out, uint32_t* count) {
  for (uint32_t i = 0; i < n; ++i) memcpy(out + 4 * i, v + 4 * (n - 1 - i), 4 * sizeof *v);
  *count = n;
}
void liar(int32_t in, int32_t* out, uint32_t* count) { *out = in, *count += 1; }
/* Like a solver: returns three numbers and whether there is a solution. */
int solve(const float* target, float* joints) {
  for (int i = 0; i < 3; ++i) joints[i] = target[i] * 10;
  return target[0] >= 0;
}
int status(float x, float* out) {
  *out = x;
  return x < 0 ? -1 : 0;
}
void smooth(float x, float* state, float* out) { *out = *state = (*state + x) / 2; }
void read_double(int channel, double* out) { *out = channel + 0.5; }

const char* greet(const char* name) {
  static char text[100];
  if (!*name) return NULL;
  snprintf(text, sizeof text, "hello %s", name);
  return text;
}
void upper(const char* in, char* out, uint32_t room) {
  uint32_t i = 0;
  for (; in[i] && i + 1 < room; ++i)
    out[i] = in[i] >= 'a' && in[i] <= 'z' ? (char)(in[i] - 32) : in[i];
  out[i] = 0;
}
int32_t letters(const char* const* texts, uint32_t count) {
  int32_t sum = 0;
  for (uint32_t i = 0; i < count; ++i) sum += (int32_t)strlen(texts[i]);
  return sum;
}
int32_t brightness(const XsImage* image) {
  int32_t sum = 0;
  for (int32_t i = 0; i < image->width * image->height * image->components; ++i)
    sum += image->pixels[i];
  return sum;
}
XsNode same_node(XsNode node) { return node; }
void last_node(const XsNode* nodes, uint32_t count, XsNode* out) {
  *out = count ? nodes[count - 1] : 0;
}
void all_nodes(const XsNode* nodes, uint32_t count, XsNode* out, uint32_t* written) {
  memcpy(out, nodes, count * sizeof *nodes);
  *written = count;
}
/* Everything else goes through the host's table. */
int hello(const XsHost* host, XsNode self, double time) {
  const XsString text = {"from C", 6};
  (void)time;
  host->log(host, self, 0, 0, text);
  return 0;
}

/* Functions found by their names: a counter that has news every second time it is polled. */
static int32_t asked, started;
void initialize(int32_t from) {
  started = from;
  asked = 0;
}
int poll(int32_t from, int32_t* count) {
  (void)from;
  *count = started + ++asked;
  return asked % 2 == 0;
}
int32_t set_from(int32_t value, int32_t from) { return started = value + from; }
void shutdown(int32_t from) { printf("%s", from < 0 ? "negative\n" : ""); }
