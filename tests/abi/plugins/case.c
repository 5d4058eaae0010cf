/* case.c: one plug-in per macro CASE_... Each differs from a good one in a single point.
 * Exceptions, which are good: CASE_shorter_class and CASE_class_truncated, whose class structures
 * end earlier, as those of an older header would. */
#include <openrt/openrts.h>

#include <math.h>
#include <stddef.h>

#if defined(CASE_missing_symbol)
RTS_EXPORT const int somethingElse = 1;
#elif defined(CASE_small_symbol)
RTS_EXPORT const uint32_t rtsPlugin = RTS_MAGIC;
#else

typedef struct Parameters {
  float a, b;
} Parameters;

#if defined(CASE_parameter_outside)
#define SECOND                                                                                     \
  { "b", RTS_VEC3, offsetof(Parameters, b), {0}, 0, 0, "" }
#elif defined(CASE_parameter_far_outside)
#define SECOND                                                                                     \
  { "b", RTS_FLOAT, 0xfffffffcu, {0}, 0, 0, "" }
#elif defined(CASE_parameter_twice)
#define SECOND                                                                                     \
  { "a", RTS_FLOAT, offsetof(Parameters, b), {0}, 0, 0, "" }
#elif defined(CASE_parameter_overlap)
#define SECOND                                                                                     \
  { "b", RTS_FLOAT, offsetof(Parameters, a), {0}, 0, 0, "" }
#elif defined(CASE_parameter_unaligned)
#define SECOND                                                                                     \
  { "b", RTS_FLOAT, offsetof(Parameters, b) - 2, {0}, 0, 0, "" }
#elif defined(CASE_frequency_type)
#define SECOND                                                                                     \
  { "b", RTS_INT, offsetof(Parameters, b), {0}, 0, 0, "" }
#elif defined(CASE_parameter_type)
#define SECOND                                                                                     \
  { "b", (RtsType)99, offsetof(Parameters, b), {0}, 0, 0, "" }
#elif defined(CASE_parameter_unnamed)
#define SECOND                                                                                     \
  { "", RTS_FLOAT, offsetof(Parameters, b), {0}, 0, 0, "" }
#elif defined(CASE_parameter_default)
#define SECOND                                                                                     \
  { "b", RTS_FLOAT, offsetof(Parameters, b), {HUGE_VALF}, 0, 0, "" }
#elif defined(CASE_parameter_range)
#define SECOND                                                                                     \
  { "b", RTS_FLOAT, offsetof(Parameters, b), {0}, 2, 1, "" }
#else
#define SECOND                                                                                     \
  { "b", RTS_FLOAT, offsetof(Parameters, b), {0}, 0, 0, "" }
#endif
#if !defined(CASE_parameter_table)
static const RtsParam parameters[] = {{"a", RTS_FLOAT, offsetof(Parameters, a), {0}, 0, 0, ""},
                                      SECOND};
#endif

#if !defined(CASE_class_without_shade)
static void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) out->radiance[1][i] = 0.5f;
}
#endif
#if defined(CASE_frequency_value)
static const uint8_t frequency[] = {RTS_PER_VERTEX, 3};
#elif defined(CASE_frequency_type) || defined(CASE_frequency_size)
static const uint8_t frequency[] = {RTS_PER_VERTEX, RTS_PER_VERTEX};
#endif
static uint32_t traits(const RtsHost* host, const void* params) {
  (void)host;
  (void)params;
  return 0;
}
static void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                     float* const transmission[3]) {
  (void)host;
  (void)batch;
  (void)hits;
  (void)transmission;
}

static const RtsClass example = {
#if defined(CASE_shorter_class)
    .size = offsetof(RtsClass, transmit),
#elif defined(CASE_class_truncated)
    .size = offsetof(RtsClass, transmit) + 3, /* in the middle of a pointer */
#elif defined(CASE_class_too_small)
    .size = offsetof(RtsClass, params),
#elif defined(CASE_class_too_large)
    .size = sizeof(RtsClass) + 8,
#else
    .size = sizeof(RtsClass),
#endif
#if defined(CASE_class_kind)
    .kind = (RtsKind)7,
#else
    .kind = RTS_SURFACE,
#endif
#if !defined(CASE_class_unnamed)
    .name = "Example",
#endif
#if defined(CASE_frequency_size)
    .paramSize = 1 << 15,
#else
    .paramSize = sizeof(Parameters),
#endif
#if defined(CASE_parameter_count)
    .paramCount = 1000000,
#else
    .paramCount = 2,
#endif
#if !defined(CASE_parameter_table)
    .params = parameters,
#endif
    .traits = traits,
#if !defined(CASE_class_without_shade)
    .shade = shade,
#endif
    .transmit = transmit,
#if defined(CASE_frequency_value) || defined(CASE_frequency_type) || defined(CASE_frequency_size)
    .frequency = frequency,
#endif
};

static const RtsClass* const classes[] = {&example,
#if defined(CASE_class_twice)
                                          &example
#elif defined(CASE_class_empty)
                                          NULL
#endif
};

RTS_EXPORT const RtsPlugin rtsPlugin = {
#if defined(CASE_wrong_magic)
    0x12345678,
#else
    RTS_MAGIC,
#endif
#if defined(CASE_other_major)
    RTS_ABI_MAJOR + 1,
#else
    RTS_ABI_MAJOR,
#endif
#if defined(CASE_newer_minor)
    RTS_ABI_MINOR + 1,
#else
    RTS_ABI_MINOR,
#endif
#if defined(CASE_plugin_size)
    sizeof(RtsPlugin) + 16,
#else
    sizeof(RtsPlugin),
#endif
#if defined(CASE_no_classes)
    0,
#elif defined(CASE_many_classes)
    0xffffffffu,
#else
    sizeof(classes) / sizeof(*classes),
#endif
#if defined(CASE_class_table)
    NULL
#else
    classes
#endif
};
#endif
