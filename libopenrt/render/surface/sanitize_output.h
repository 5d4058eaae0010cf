// sanitize_output.h: detects faulty shader output: numbers that are not finite and, in diagnostic
// mode, lobes that the class's traits do not declare. Bad numbers are replaced at once; faults are
// counted (wave/faults.h). [render]
#pragma once

#include <initializer_list>

#include "render/wave/batch.h"

namespace openrt {

// Replaces numbers that are not finite by 0 and counts the points concerned. arrays: n floats each;
// null arrays are skipped.
void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, uint32_t n,
                    std::initializer_list<float*> arrays);
// The same for the output of `surface`. A lobe with a number that is not finite gets weight 0.
void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, const RtsSurface& out);
// The same for the output of `shade`.
void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, const RtsShading& out);

} // namespace openrt
