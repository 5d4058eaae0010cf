// cxx17.cc: uses the shader SDK's C header alone, in C++17, with a class table as a plug-in author
// would write it.
#include <openrt/openrts.h>

#include <cstddef>

namespace {

struct Parameters {
  float color[3];
};
const RtsParam parameters[] = {
    {"color", RTS_COLOR, offsetof(Parameters, color), {1, 1, 1}, 0, 1, "the colour"}};

void shade(const RtsHost*, RtsBatch*, const RtsHits* hits, RtsShading* out) {
  for (uint32_t i = 0; i < hits->count; i++)
    for (int k = 0; k < 3; k++)
      out->radiance[k][i] = static_cast<const Parameters*>(hits->params[i])->color[k];
}

RtsClass makeClass() {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_SURFACE;
  c.name = "Flat";
  c.paramSize = sizeof(Parameters);
  c.paramCount = 1;
  c.params = parameters;
  c.shade = shade;
  return c;
}

} // namespace

int main() {
  const RtsClass flat = makeClass();
  const Parameters values{{0.25f, 0.5f, 0.75f}};
  const void* params[RTS_LANES];
  float radiance[3][RTS_LANES] = {};
  for (auto& p : params) p = &values;
  RtsHits hits{};
  hits.count = 2;
  hits.params = params;
  RtsShading out{};
  for (int k = 0; k < 3; k++) out.radiance[k] = radiance[k];
  flat.shade(nullptr, nullptr, &hits, &out);
  return radiance[0][1] == 0.25f && radiance[2][1] == 0.75f && radiance[0][2] == 0 ? 0 : 1;
}
