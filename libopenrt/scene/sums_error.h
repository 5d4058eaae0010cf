// sums_error.h: the error that kept sums of a frame (render/frame/frame_sums.h) cannot be used. The
// message is for people. [any]
#pragma once

#include <stdexcept>

namespace openrt {

class SumsError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace openrt
