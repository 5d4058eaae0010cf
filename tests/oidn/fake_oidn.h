/* fake_oidn.h: The fake library counts these things, in its variable fakeOidnCounts. */
#pragma once

typedef struct {
  int devices, buffers, filters; /* made and not released */
  int runs;
  /* Settings of the last device and filter that were committed. */
  int threads, affinity, width, height, quality;
} FakeOidnCounts;
