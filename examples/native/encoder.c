/* encoder.c: A C library for a rotary encoder that knows nothing of VRML: open, read, close. It
 * simulates the encoder of a motor that accelerates and hunts a little. gauge.wrl displays it.
 *
 *   cc -std=c99 -shared -fPIC encoder.c -o libencoder.so -lm
 *   XVRML_NATIVE_PATH=$PWD vv gauge.wrl --trust --time 2 -o gauge.png */
#include <math.h>
#include <stdint.h>
#include <string.h>

static int32_t stepsOfTurn; /* steps per turn; 0 while the encoder is closed */
static int32_t lastCount;
static double firstTime, lastTime; /* times of readings, in seconds since 1970 */

/* Returns the number of turns of the real machine's shaft, `time` seconds after the motor was
 * switched on. */
static double shaft(double time) {
  return 0.75 * (time - (1 - exp(-time))) + 0.02 * sin(11 * time);
}

/* device: only "simulated:..." exists. steps: steps per turn. */
int encoder_open(const char* device, int32_t steps) {
  if (strncmp(device, "simulated:", 10) != 0 || steps < 1) return 0;
  stepsOfTurn = steps;
  lastCount = INT32_MIN;
  return 1;
}

/* Reads the needle's rotation (axis and angle) and the turns per second. Returns 1 if the
 * encoder has moved by a step since the last reading. */
int encoder_read(double time, float rotation[4], float* speed) {
  if (!stepsOfTurn) return 0;
  if (lastCount == INT32_MIN) firstTime = time; /* the first reading switches the motor on */
  const double turns = shaft(time - firstTime);
  const int32_t count = (int32_t)floor(turns * stepsOfTurn);
  if (count == lastCount) return 0;
  rotation[0] = rotation[1] = 0;
  rotation[2] = -1; /* clockwise as seen from the front */
  rotation[3] = (float)(6.283185307179586 * count / stepsOfTurn);
  *speed = time > lastTime && lastCount != INT32_MIN
               ? (float)((count - lastCount) / (stepsOfTurn * (time - lastTime)))
               : 0;
  lastCount = count;
  lastTime = time;
  return 1;
}

void encoder_close(void) { stepsOfTurn = 0; }

/* Computes a colour: blue for slow, red for `limit` turns per second. */
void heat(float speed, float limit, float rgb[3]) {
  float t = fabsf(speed) / limit;
  if (t > 1) t = 1;
  rgb[0] = t;
  rgb[1] = 0.25f * (1 - t);
  rgb[2] = 1 - t;
}
