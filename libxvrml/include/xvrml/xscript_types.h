/* xscript_types.h: a table of the 20 types of xscript.h, for script engines (C99, no library
 * needed). [any thread] */
#ifndef XVRML_XSCRIPT_TYPES_H
#define XVRML_XSCRIPT_TYPES_H

#include "xvrml/xscript.h"

typedef struct XsTypeInfo {
  const char* name;   /* "MFVec3f" */
  XsType element;     /* element type of an MF type; an SF type itself */
  int32_t components; /* numbers per element, 1 to 4; 0: not a number (SFImage, SFNode, SFString) */
  uint32_t bytes;     /* size of an element in XsValue's array */
} XsTypeInfo;

/* Returns NULL for a number that is no type. */
static inline const XsTypeInfo* xsTypeInfo(XsType type) {
  static const XsTypeInfo table[] = {
      {"SFBool", XS_SFBOOL, 1, sizeof(int32_t)},
      {"SFColor", XS_SFCOLOR, 3, 3 * sizeof(float)},
      {"SFFloat", XS_SFFLOAT, 1, sizeof(float)},
      {"SFImage", XS_SFIMAGE, 0, sizeof(XsImage)},
      {"SFInt32", XS_SFINT32, 1, sizeof(int32_t)},
      {"SFNode", XS_SFNODE, 0, sizeof(XsNode)},
      {"SFRotation", XS_SFROTATION, 4, 4 * sizeof(float)},
      {"SFString", XS_SFSTRING, 0, sizeof(XsString)},
      {"SFTime", XS_SFTIME, 1, sizeof(double)},
      {"SFVec2f", XS_SFVEC2F, 2, 2 * sizeof(float)},
      {"SFVec3f", XS_SFVEC3F, 3, 3 * sizeof(float)},
      {"MFColor", XS_SFCOLOR, 3, 3 * sizeof(float)},
      {"MFFloat", XS_SFFLOAT, 1, sizeof(float)},
      {"MFInt32", XS_SFINT32, 1, sizeof(int32_t)},
      {"MFNode", XS_SFNODE, 0, sizeof(XsNode)},
      {"MFRotation", XS_SFROTATION, 4, 4 * sizeof(float)},
      {"MFString", XS_SFSTRING, 0, sizeof(XsString)},
      {"MFTime", XS_SFTIME, 1, sizeof(double)},
      {"MFVec2f", XS_SFVEC2F, 2, 2 * sizeof(float)},
      {"MFVec3f", XS_SFVEC3F, 3, 3 * sizeof(float)},
  };
  return type >= XS_SFBOOL && type <= XS_MFVEC3F ? &table[type - XS_SFBOOL] : NULL;
}

static inline int xsIsMany(XsType type) { return type >= XS_MFCOLOR && type <= XS_MFVEC3F; }

#endif
