// values.h: Parses option values strictly. Each function throws UsageError that says what was
// expected; readPose() throws Failure for a file. [any thread]
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/camera.h"
#include "libpicture/quality.h"
#include "libpicture/renderer.h"
#include "process/exit_codes.h"

namespace vv {

// The pictures of a sequence: first, first + step and so on up to last.
struct FrameRange {
  long long first = 0, last = 0, step = 1;
};

long long readInteger(std::string_view text, long long minimum, long long maximum);
// both limits are exclusive
double readNumber(std::string_view text, double minimum, double maximum);
// Reads a value that the library allows for a quality setting (RT_*): a name, if values have names;
// else a number.
double readQuality(RTenum quality, std::string_view text);
// The same for a real number, which may be a percentage.
double readShare(RTenum quality, std::string_view text);
double readSeconds(std::string_view text); // seconds from 0 to a million
// Parses a number of bytes or items, with the optional suffixes k, M, G (powers of 1024).
uint64_t readCount(std::string_view text);
bool readSwitch(std::string_view text); // on, off
void readSize(std::string_view text, int& width, int& height);
picture::Crop readCrop(std::string_view text);              // X,Y,WxH
std::array<int, 2> readSamplesOfTwo(std::string_view text); // N,M
// FX,FY,CX,CY in OpenCV's convention: the centre of the first pixel is at (0, 0)
picture::Intrinsics readIntrinsics(std::string_view text);
// 16 numbers by rows, or a file of them, after "opencv:" (the default) or "opengl:". file: gets the
// name of the file, if it is one.
picture::LookAt readPose(std::string_view text, std::string& file);
picture::LookAt readCamera(std::string_view text);
xvrml::Axis readAxis(std::string_view text);  // x, y or z, with an optional sign
FrameRange readFrames(std::string_view text); // A-B, A-B/STEP or A
std::vector<std::string_view> split(std::string_view text, char separator);

} // namespace vv
