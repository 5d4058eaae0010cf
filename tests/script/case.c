/* case.c: one script plug-in per macro CASE_... Each differs from a good one in a single point. The
 * scheme is "broken:". */
#include <xvrml/xscript.h>

#if defined(CASE_missing_symbol)
XS_EXPORT const int somethingElse = 1;
#elif defined(CASE_small_symbol)
XS_EXPORT const uint32_t xsPlugin = XS_MAGIC;
#else

static XsResult create(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made) {
  (void)host;
  (void)info;
  *made = 1;
  return XS_OK;
}
static void destroy(XsInterpreter interpreter) { (void)interpreter; }

static const char* const schemes[] = {"broken", 0};
static const XsEngine engine = {
#if defined(CASE_engine_size)
    .size = 40,
#else
    .size = sizeof(XsEngine),
#endif
    .name = "broken",
    .schemes = schemes,
#if !defined(CASE_no_create)
    .create = create,
#endif
    .destroy = destroy};
static const XsEngine* const engines[] = {&engine};

#if defined(CASE_wrong_magic)
#define MAGIC 0x12345678u
#else
#define MAGIC XS_MAGIC
#endif
#if defined(CASE_other_major)
#define MAJOR (XS_ABI_MAJOR + 1)
#else
#define MAJOR XS_ABI_MAJOR
#endif
#if defined(CASE_newer_minor)
#define MINOR (XS_ABI_MINOR + 1)
#else
#define MINOR XS_ABI_MINOR
#endif
#if defined(CASE_plugin_size)
#define SIZE 8
#else
#define SIZE sizeof(XsPlugin)
#endif
XS_EXPORT const XsPlugin xsPlugin = {MAGIC, MAJOR, MINOR, SIZE, 1, engines};
#if defined(CASE_no_create)
XsResult (*const unused)(const XsHost*, const XsScriptInfo*, XsInterpreter*) = create;
#endif
#endif
