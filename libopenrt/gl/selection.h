// selection.h: the selection mode of OpenGL (1.1, section 5.2). Primitives are not drawn: the names
// of those that lie in the view, hidden or not, are written into the buffer of the program.
#pragma once

#include "gl/frame.h"

namespace rtgl {

class Selection {
 public:
  static constexpr size_t maxNameDepth = 64;

  GLenum mode() const { return mode_; } // GL_RENDER, GL_SELECT or GL_FEEDBACK
  // Returns what glRenderMode returns about the mode that ends.
  GLint setMode(GLenum mode);
  void setBuffer(GLuint* buffer, GLsizei size);
  GLuint* buffer() const { return buffer_; }
  size_t bufferSize() const { return size_; }

  // The stack of names. In other modes these calls do nothing.
  void initNames();
  void loadName(GLuint name);
  void pushName(GLuint name);
  void popName();
  size_t nameDepth() const { return names_.size(); }

  // Notes a hit if a part of the chunk lies in the view. toClip: to clip coordinates.
  void draw(const ChunkPtr& chunk, const Matrix& toClip, const Polygon& polygon);

 private:
  void endRecord();
  void put(GLuint value);

  GLenum mode_ = GL_RENDER;
  GLuint* buffer_ = nullptr;
  size_t size_ = 0, used_ = 0;
  bool overflow_ = false;
  GLint records_ = 0;
  std::vector<GLuint> names_;
  bool hit_ = false; // since the stack has changed
  double nearest_ = 0, farthest_ = 0;
};

} // namespace rtgl
