/* c99.c: uses both public C headers in one C99 program without extensions, to show that they
 * compile, link and agree with each other. */
#include <openrt/openrt.h>
#include <openrt/openrts.h>

#include <stdio.h>

int main(void) {
  RTcontext context = rtNewContext("backend=null");
  if (!context) return 1;
  if (RT_PARAM_TEXTURE != (int)RTS_TEXTURE || RT_ENVIRONMENT != (int)RTS_ENVIRONMENT) return 2;
  RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(0, 0, 0);
  rtVertex3f(1, 0, 0);
  rtVertex3f(0, 1, 0);
  rtEnd();
  rtEndObject();
  if (rtInstantiateObject(object) == 0) return 3;
  rtFrameBuffer(4, 3, RT_RGBA | RT_DEPTH);
  rtRender();
  float depth[12];
  rtReadPixels(RT_DEPTH, depth, 12);
  RTenum error = rtGetError();
  if (error != RT_NO_ERROR) fprintf(stderr, "%s\n", rtGetErrorMessage());
  rtDeleteContext(context);
  return error == RT_NO_ERROR ? 0 : 4;
}
