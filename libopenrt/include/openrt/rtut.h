/* rtut.h: windows and events for programs that draw with openrt/gl.h, in GLUT's manner (library
 * librtut, C99). It needs SDL 2.
 *
 * A program that includes GL/glut.h includes this header instead. Names with glut and GLUT_ mean
 * those with rtut and RTUT_. There is one window. Its pictures begin with one sample per pixel
 * (rtglSamples); one that nobody redraws becomes better while the window waits. rtut prints errors
 * on stderr, as GLUT does; exit codes are returned.
 *
 * Without a window: OPENRT_UT_FRAMES=N in the environment, or rtutFrames, renders N frames into
 * files. The clock of the program then runs 40 ms from one frame to the next, so that the pictures
 * are always the same. Another value of OPENRT_UT_FRAMES than a number from 1 is reported, and
 * nothing is rendered. All functions: [context-thread].
 */
#ifndef OPENRT_RTUT_H
#define OPENRT_RTUT_H

#include "openrt/gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Takes the options of the library (--rt-KEY=VALUE) out of argv and makes a context. */
RT_API void rtutInit(int* argc, char** argv);
/* mode: RTUT_DOUBLE or RTUT_SINGLE. The other bits change nothing: there is always a depth test,
 * and calls for stencils, accumulation and indices are refused by their names. */
RT_API void rtutInitDisplayMode(unsigned int mode);
RT_API void rtutInitWindowSize(int width, int height);
RT_API void rtutInitWindowPosition(int x, int y);
/* Returns 1, or 0 if there is no display and no frames are rendered into files, or a window
 * already. */
RT_API int rtutCreateWindow(const char* title);
RT_API void rtutDestroyWindow(int window);
RT_API void rtutSetWindowTitle(const char* title);
RT_API void rtutReshapeWindow(int width, int height);
RT_API void rtutFullScreen(void);

/* Callbacks. NULL removes one. */
RT_API void rtutDisplayFunc(void (*display)(void));
RT_API void rtutReshapeFunc(void (*reshape)(int width, int height));
RT_API void rtutIdleFunc(void (*idle)(void));
RT_API void rtutKeyboardFunc(void (*keyboard)(unsigned char key, int x, int y));
RT_API void rtutKeyboardUpFunc(void (*keyboard)(unsigned char key, int x, int y));
RT_API void rtutSpecialFunc(void (*special)(int key, int x, int y));
RT_API void rtutSpecialUpFunc(void (*special)(int key, int x, int y));
/* ignore: a key that is held is one call, instead of several. Call it after rtutCreateWindow. */
RT_API void rtutIgnoreKeyRepeat(int ignore);
/* The wheel is button 3 (away from the user) or 4. */
RT_API void rtutMouseFunc(void (*mouse)(int button, int state, int x, int y));
RT_API void rtutMotionFunc(void (*motion)(int x, int y));
RT_API void rtutPassiveMotionFunc(void (*motion)(int x, int y));
RT_API void rtutVisibilityFunc(void (*visibility)(int state));
/* Calls a function once, after so many milliseconds. */
RT_API void rtutTimerFunc(unsigned int milliseconds, void (*timer)(int value), int value);

RT_API void rtutPostRedisplay(void);
/* Ends the frame and shows it. */
RT_API void rtutSwapBuffers(void);
/* Runs until the window is closed, rtutLeaveMainLoop is called or the frames are rendered. Returns
 * 0, 1 if there is no window, 2 if a picture cannot be written or OPENRT_UT_FRAMES is no number. */
RT_API int rtutMainLoop(void);
RT_API void rtutLeaveMainLoop(void);
/* Renders so many frames without a window, with four samples per pixel. pattern: file names, with
 * one %d for the number of the frame from 0, for example "frame%04d.ppm" (default, also
 * $OPENRT_UT_FILE). Call it before rtutCreateWindow. */
RT_API void rtutFrames(int count, const char* pattern);
/* RTUT_ELAPSED_TIME: milliseconds; RTUT_WINDOW_WIDTH, RTUT_WINDOW_HEIGHT. */
RT_API int rtutGet(GLenum what);
/* Returns RTUT_ACTIVE_* bits of the event that is being handled. */
RT_API int rtutGetModifiers(void);

/* Solids around the origin, solid and as wires. */
RT_API void rtutSolidSphere(GLdouble radius, GLint slices, GLint stacks);
RT_API void rtutWireSphere(GLdouble radius, GLint slices, GLint stacks);
RT_API void rtutSolidCube(GLdouble size);
RT_API void rtutWireCube(GLdouble size);
/* inner: the radius of the tube; outer: that of the circle of its middle. */
RT_API void rtutSolidTorus(GLdouble inner, GLdouble outer, GLint sides, GLint rings);
RT_API void rtutWireTorus(GLdouble inner, GLdouble outer, GLint sides, GLint rings);
/* The base lies in the plane z = 0. */
RT_API void rtutSolidCone(GLdouble base, GLdouble height, GLint slices, GLint stacks);
RT_API void rtutWireCone(GLdouble base, GLdouble height, GLint slices, GLint stacks);
/* Their corners are 1 from the origin; those of the dodecahedron are sqrt(3). */
RT_API void rtutSolidTetrahedron(void);
RT_API void rtutWireTetrahedron(void);
RT_API void rtutSolidOctahedron(void);
RT_API void rtutWireOctahedron(void);
RT_API void rtutSolidDodecahedron(void);
RT_API void rtutWireDodecahedron(void);
RT_API void rtutSolidIcosahedron(void);
RT_API void rtutWireIcosahedron(void);
/* Newell's teapot, with texture coordinates: its body has the radius `size`. */
RT_API void rtutSolidTeapot(GLdouble size);
RT_API void rtutWireTeapot(GLdouble size);

#ifdef __cplusplus
}
#endif

#define RTUT_RGB 0
#define RTUT_RGBA 0
#define RTUT_SINGLE 0
#define RTUT_INDEX 1
#define RTUT_DOUBLE 2
#define RTUT_ACCUM 4
#define RTUT_ALPHA 8
#define RTUT_DEPTH 16
#define RTUT_STENCIL 32
#define RTUT_MULTISAMPLE 128
#define RTUT_STEREO 256
#define RTUT_LEFT_BUTTON 0
#define RTUT_MIDDLE_BUTTON 1
#define RTUT_RIGHT_BUTTON 2
#define RTUT_DOWN 0
#define RTUT_UP 1
#define RTUT_NOT_VISIBLE 0
#define RTUT_VISIBLE 1
#define RTUT_KEY_F1 1
#define RTUT_KEY_F2 2
#define RTUT_KEY_F3 3
#define RTUT_KEY_F4 4
#define RTUT_KEY_F5 5
#define RTUT_KEY_F6 6
#define RTUT_KEY_F7 7
#define RTUT_KEY_F8 8
#define RTUT_KEY_F9 9
#define RTUT_KEY_F10 10
#define RTUT_KEY_F11 11
#define RTUT_KEY_F12 12
#define RTUT_KEY_LEFT 100
#define RTUT_KEY_UP 101
#define RTUT_KEY_RIGHT 102
#define RTUT_KEY_DOWN 103
#define RTUT_KEY_PAGE_UP 104
#define RTUT_KEY_PAGE_DOWN 105
#define RTUT_KEY_HOME 106
#define RTUT_KEY_END 107
#define RTUT_KEY_INSERT 108
#define RTUT_WINDOW_WIDTH 102
#define RTUT_WINDOW_HEIGHT 103
#define RTUT_ELAPSED_TIME 700
#define RTUT_ACTIVE_SHIFT 1
#define RTUT_ACTIVE_CTRL 2
#define RTUT_ACTIVE_ALT 4

#define GLUT_RGB RTUT_RGB
#define GLUT_RGBA RTUT_RGBA
#define GLUT_SINGLE RTUT_SINGLE
#define GLUT_INDEX RTUT_INDEX
#define GLUT_DOUBLE RTUT_DOUBLE
#define GLUT_ACCUM RTUT_ACCUM
#define GLUT_ALPHA RTUT_ALPHA
#define GLUT_DEPTH RTUT_DEPTH
#define GLUT_STENCIL RTUT_STENCIL
#define GLUT_MULTISAMPLE RTUT_MULTISAMPLE
#define GLUT_STEREO RTUT_STEREO
#define GLUT_LEFT_BUTTON RTUT_LEFT_BUTTON
#define GLUT_MIDDLE_BUTTON RTUT_MIDDLE_BUTTON
#define GLUT_RIGHT_BUTTON RTUT_RIGHT_BUTTON
#define GLUT_DOWN RTUT_DOWN
#define GLUT_UP RTUT_UP
#define GLUT_NOT_VISIBLE RTUT_NOT_VISIBLE
#define GLUT_VISIBLE RTUT_VISIBLE
#define GLUT_KEY_F1 RTUT_KEY_F1
#define GLUT_KEY_F2 RTUT_KEY_F2
#define GLUT_KEY_F3 RTUT_KEY_F3
#define GLUT_KEY_F4 RTUT_KEY_F4
#define GLUT_KEY_F5 RTUT_KEY_F5
#define GLUT_KEY_F6 RTUT_KEY_F6
#define GLUT_KEY_F7 RTUT_KEY_F7
#define GLUT_KEY_F8 RTUT_KEY_F8
#define GLUT_KEY_F9 RTUT_KEY_F9
#define GLUT_KEY_F10 RTUT_KEY_F10
#define GLUT_KEY_F11 RTUT_KEY_F11
#define GLUT_KEY_F12 RTUT_KEY_F12
#define GLUT_KEY_LEFT RTUT_KEY_LEFT
#define GLUT_KEY_UP RTUT_KEY_UP
#define GLUT_KEY_RIGHT RTUT_KEY_RIGHT
#define GLUT_KEY_DOWN RTUT_KEY_DOWN
#define GLUT_KEY_PAGE_UP RTUT_KEY_PAGE_UP
#define GLUT_KEY_PAGE_DOWN RTUT_KEY_PAGE_DOWN
#define GLUT_KEY_HOME RTUT_KEY_HOME
#define GLUT_KEY_END RTUT_KEY_END
#define GLUT_KEY_INSERT RTUT_KEY_INSERT
#define GLUT_WINDOW_WIDTH RTUT_WINDOW_WIDTH
#define GLUT_WINDOW_HEIGHT RTUT_WINDOW_HEIGHT
#define GLUT_ELAPSED_TIME RTUT_ELAPSED_TIME
#define GLUT_ACTIVE_SHIFT RTUT_ACTIVE_SHIFT
#define GLUT_ACTIVE_CTRL RTUT_ACTIVE_CTRL
#define GLUT_ACTIVE_ALT RTUT_ACTIVE_ALT

#define glutInit rtutInit
#define glutInitDisplayMode rtutInitDisplayMode
#define glutInitWindowSize rtutInitWindowSize
#define glutInitWindowPosition rtutInitWindowPosition
#define glutCreateWindow rtutCreateWindow
#define glutDestroyWindow rtutDestroyWindow
#define glutSetWindowTitle rtutSetWindowTitle
#define glutReshapeWindow rtutReshapeWindow
#define glutFullScreen rtutFullScreen
#define glutDisplayFunc rtutDisplayFunc
#define glutReshapeFunc rtutReshapeFunc
#define glutIdleFunc rtutIdleFunc
#define glutKeyboardFunc rtutKeyboardFunc
#define glutKeyboardUpFunc rtutKeyboardUpFunc
#define glutSpecialFunc rtutSpecialFunc
#define glutSpecialUpFunc rtutSpecialUpFunc
#define glutIgnoreKeyRepeat rtutIgnoreKeyRepeat
#define glutMouseFunc rtutMouseFunc
#define glutMotionFunc rtutMotionFunc
#define glutPassiveMotionFunc rtutPassiveMotionFunc
#define glutVisibilityFunc rtutVisibilityFunc
#define glutTimerFunc rtutTimerFunc
#define glutPostRedisplay rtutPostRedisplay
#define glutSwapBuffers rtutSwapBuffers
#define glutMainLoop rtutMainLoop
#define glutLeaveMainLoop rtutLeaveMainLoop
#define glutFrames rtutFrames
#define glutGet rtutGet
#define glutGetModifiers rtutGetModifiers
#define glutSolidSphere rtutSolidSphere
#define glutWireSphere rtutWireSphere
#define glutSolidCube rtutSolidCube
#define glutWireCube rtutWireCube
#define glutSolidTorus rtutSolidTorus
#define glutWireTorus rtutWireTorus
#define glutSolidCone rtutSolidCone
#define glutWireCone rtutWireCone
#define glutSolidTetrahedron rtutSolidTetrahedron
#define glutWireTetrahedron rtutWireTetrahedron
#define glutSolidOctahedron rtutSolidOctahedron
#define glutWireOctahedron rtutWireOctahedron
#define glutSolidDodecahedron rtutSolidDodecahedron
#define glutWireDodecahedron rtutWireDodecahedron
#define glutSolidIcosahedron rtutSolidIcosahedron
#define glutWireIcosahedron rtutWireIcosahedron
#define glutSolidTeapot rtutSolidTeapot
#define glutWireTeapot rtutWireTeapot

#endif
