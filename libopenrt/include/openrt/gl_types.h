/* gl_types.h: the types of OpenGL, with both prefixes. openrt/gl.h includes it. */
#ifndef OPENRT_GL_TYPES_H
#define OPENRT_GL_TYPES_H

#include "openrt/openrt.h"

typedef unsigned int GLenum;
typedef unsigned char GLboolean;
typedef unsigned int GLbitfield;
typedef void GLvoid;
typedef signed char GLbyte;
typedef short GLshort;
typedef int GLint;
typedef unsigned char GLubyte;
typedef unsigned short GLushort;
typedef unsigned int GLuint;
typedef int GLsizei;
typedef float GLfloat;
typedef float GLclampf;
typedef double GLdouble;
typedef double GLclampd;

/* openrt/openrt.h has RTenum. */
typedef GLboolean RTboolean;
typedef GLbitfield RTbitfield;
typedef GLvoid RTvoid;
typedef GLbyte RTbyte;
typedef GLshort RTshort;
typedef GLint RTint;
typedef GLubyte RTubyte;
typedef GLushort RTushort;
typedef GLuint RTuint;
typedef GLsizei RTsizei;
typedef GLfloat RTfloat;
typedef GLclampf RTclampf;
typedef GLdouble RTdouble;
typedef GLclampd RTclampd;

#endif
