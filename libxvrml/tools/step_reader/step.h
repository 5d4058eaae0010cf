// step.h: reads STEP files, for xvrml-step-reader. [one thread]
#pragma once

#include "tools/decoder/answer.h"

namespace xvrml::decoding {

// Loads what Open CASCADE needs; called before the cage.
void prepareStep();
// Answers with a binary glTF file. Throws std::exception with the reason if that is not possible.
void decodeStep(const Request& request, std::span<const uint8_t> file, Answer& answer);

} // namespace xvrml::decoding
