/* queries.h: the former name of openrt/query.h, for programs that were written for it. */
#ifndef OPENRT_QUERIES_H
#define OPENRT_QUERIES_H

#include "openrt/query.h"

#endif
