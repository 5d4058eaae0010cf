// live_appear.h: measures how long moving pictures stand still when much appears at once: a mesh of
// two million triangles, as many in an ElevationGrid, and thousands of Shapes. Used by bench_live.
// [one thread, the browser's]
#pragma once

// Prints, for each of these, the longest time between two pictures, the parts of it that the
// browser and the mapper take, and how long it takes until all is seen. The viewer walks and turns
// meanwhile, as in a window. Returns false if something has not appeared.
bool measureAppearance(int threads);
