/* openrt.h: the OpenRT application programming interface (C99).
 *
 * OpenRT is a ray tracing API in OpenGL's manner. One context holds one scene; a context is current
 * on a thread. Objects, instances, shaders, textures and lights are named by ids other than 0 and
 * live until they are deleted. Edits gather in the pending scene. rtSwapBuffers and rtRender commit
 * all of them at once.
 *
 * This header includes the parts:
 *   openrt/context.h    errors, contexts and their configuration
 *   openrt/geometry.h   primitives, arrays, matrices, objects and instances
 *   openrt/shader.h     shaders, their parameters and roles, textures
 *   openrt/frame.h      frames, quality settings, pixels, error bars, statistics
 *   openrt/sums.h       sums of frames, which are continued or added
 *   openrt/worker.h     the workers of a cluster
 *   openrt/query.h      ray queries and picking
 *
 * Conventions
 *  - Coordinates are right-handed. Matrices are 4x4, column-major, and act on column vectors.
 *    Angles are in degrees. Colours are linear.
 *  - The library copies arrays before the call returns.
 *  - A call that fails changes nothing and records an error (see rtGetError). A call that returns
 * an id then returns 0.
 *  - A tag tells on which thread a function may be called. [context-thread]: on a thread on which
 *    the context is current; two threads must not do so at the same time. [any-thread]: on any
 *    thread at any time while the context lives.
 */
#ifndef OPENRT_OPENRT_H
#define OPENRT_OPENRT_H

#include "openrt/context.h"
#include "openrt/frame.h"
#include "openrt/geometry.h"
#include "openrt/query.h"
#include "openrt/shader.h"
#include "openrt/sums.h"
#include "openrt/worker.h"

#endif
