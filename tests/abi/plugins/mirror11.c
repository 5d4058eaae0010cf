/* mirror11.c: a mirror built for ABI 1.1, which had no trait for mirrors. */
#include <openrt/openrts.h>

#include <stddef.h>

static void surface(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  RtsLobe* const lobe = host->lobe(batch, RTS_LOBE_REFLECTION);
  (void)out;
  for (uint32_t i = 0; i < hits->count; i++)
    for (int k = 0; k < 3; k++) lobe->weight[k][i] = 1;
}

static const RtsClass mirror = {.size = offsetof(RtsClass, frequency),
                                .kind = RTS_SURFACE,
                                .name = "Mirror11",
                                .text = "",
                                .surface = surface};
static const RtsClass* const classes[] = {&mirror};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, 1, 1, sizeof(RtsPlugin), 1, classes};
