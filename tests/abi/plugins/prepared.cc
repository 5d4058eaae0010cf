// prepared.cc: a surface that computes values from its parameters in prepare() and refuses some
// parameters.
#include <openrt/openrts.hpp>

namespace {

int alive = 0; // prepared and not yet released

struct Tripled : rts::Surface<Tripled> {
  rts::Param<float> gain{"gain", 1, "may not be negative"};
  float tripled;

  const char* prepare() {
    alive++;
    if (gain < 0) return "gain: negative";
    tripled += 3 * gain; // zero before
    return nullptr;
  }
  void release() { alive--; }
  rts::Shaded shade(const rts::Hit&) const { return {{tripled, float(alive), 0}, {}, {}}; }
};

} // namespace

RTS_PLUGIN(Tripled)

extern "C" RTS_EXPORT int preparedAndNotReleased() { return alive; }
