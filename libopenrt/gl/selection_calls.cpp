// selection_calls.cpp: Implements the calls of the selection mode. The feedback mode is refused,
// and nothing is drawn in it.
#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

GLint rtglRenderMode(GLenum mode) {
  GLint answer = 0;
  guarded("glRenderMode", [&](State& s) {
    if (s.open()) fail(GL_INVALID_OPERATION, "glEnd is missing");
    if (mode != GL_RENDER && mode != GL_SELECT && mode != GL_FEEDBACK)
      fail(GL_INVALID_ENUM, "no such mode");
    if (mode == GL_FEEDBACK)
      s.refuse("glRenderMode(GL_FEEDBACK)", "gluProject tells where vertices are in the picture");
    answer = s.selection.setMode(mode);
  });
  return answer;
}
void rtglSelectBuffer(GLsizei size, GLuint* buffer) {
  guarded("glSelectBuffer", [&](State& s) { s.selection.setBuffer(buffer, size); });
}
void rtglInitNames(void) {
  listed("glInitNames", [](State& s) { s.selection.initNames(); });
}
void rtglLoadName(GLuint name) {
  listed("glLoadName", [name](State& s) { s.selection.loadName(name); });
}
void rtglPushName(GLuint name) {
  listed("glPushName", [name](State& s) { s.selection.pushName(name); });
}
void rtglPopName(void) {
  listed("glPopName", [](State& s) { s.selection.popName(); });
}
