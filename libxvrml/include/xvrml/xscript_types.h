/* xscript_types.h: a table of the types of xscript.h, for script engines (C99, no library
 * needed). [any thread] */
#ifndef XVRML_XSCRIPT_TYPES_H
#define XVRML_XSCRIPT_TYPES_H

#include "xvrml/xscript.h"

#define XS_LAST_TYPE XS_MFVEC4F /* the type with the largest number */
#define XS_MOST_COMPONENTS 16

typedef struct XsTypeInfo {
  const char* name;   /* "MFVec3f" */
  XsType element;     /* element type of an MF type; an SF type itself */
  int32_t components; /* numbers per element, 1 to 16; 0: none (SFImage, SFNode, SFString) */
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
      {"MFBool", XS_SFBOOL, 1, sizeof(int32_t)},
      {"SFColorRGBA", XS_SFCOLORRGBA, 4, 4 * sizeof(float)},
      {"MFColorRGBA", XS_SFCOLORRGBA, 4, 4 * sizeof(float)},
      {"SFDouble", XS_SFDOUBLE, 1, sizeof(double)},
      {"MFDouble", XS_SFDOUBLE, 1, sizeof(double)},
      {"MFImage", XS_SFIMAGE, 0, sizeof(XsImage)},
      {"SFMatrix3d", XS_SFMATRIX3D, 9, 9 * sizeof(double)},
      {"MFMatrix3d", XS_SFMATRIX3D, 9, 9 * sizeof(double)},
      {"SFMatrix3f", XS_SFMATRIX3F, 9, 9 * sizeof(float)},
      {"MFMatrix3f", XS_SFMATRIX3F, 9, 9 * sizeof(float)},
      {"SFMatrix4d", XS_SFMATRIX4D, 16, 16 * sizeof(double)},
      {"MFMatrix4d", XS_SFMATRIX4D, 16, 16 * sizeof(double)},
      {"SFMatrix4f", XS_SFMATRIX4F, 16, 16 * sizeof(float)},
      {"MFMatrix4f", XS_SFMATRIX4F, 16, 16 * sizeof(float)},
      {"SFVec2d", XS_SFVEC2D, 2, 2 * sizeof(double)},
      {"MFVec2d", XS_SFVEC2D, 2, 2 * sizeof(double)},
      {"SFVec3d", XS_SFVEC3D, 3, 3 * sizeof(double)},
      {"MFVec3d", XS_SFVEC3D, 3, 3 * sizeof(double)},
      {"SFVec4d", XS_SFVEC4D, 4, 4 * sizeof(double)},
      {"MFVec4d", XS_SFVEC4D, 4, 4 * sizeof(double)},
      {"SFVec4f", XS_SFVEC4F, 4, 4 * sizeof(float)},
      {"MFVec4f", XS_SFVEC4F, 4, 4 * sizeof(float)},
  };
  return type >= XS_SFBOOL && type <= XS_LAST_TYPE ? &table[type - XS_SFBOOL] : NULL;
}

static inline int xsIsMany(XsType type) {
  const XsTypeInfo* info = xsTypeInfo(type);
  return info && info->element != type;
}

/* Whether the numbers of a type are doubles: SFTime, SFDouble, and tuples of doubles. */
static inline int xsHasDoubles(XsType type) {
  const XsTypeInfo* info = xsTypeInfo(type);
  return info && info->components > 0 &&
         info->bytes == (uint32_t)info->components * (uint32_t)sizeof(double);
}

#endif
