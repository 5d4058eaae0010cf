// limits.h: The limits of vv serve: what one page, and all together, may cost. docs/limits.md has
// the same table; unit_server compares them. [any thread]
#pragma once

#include <cstddef>
#include <string_view>

namespace vv::server {

struct Limit {
  std::string_view name;
  int value;
  std::string_view text;
};

inline constexpr int maxViewers = 16;
inline constexpr int maxMessageBytes = 4096;
inline constexpr int maxMessagesPerSecond = 300;
inline constexpr int maxMessageBurst = 600;
inline constexpr int maxPictureSide = 4096;
inline constexpr int maxPicturePixels = 4'194'304;
inline constexpr int maxViewPixels = 8'388'608;
inline constexpr int maxPreviewPixels = 2'097'152;
inline constexpr int minTokenLength = 16;
inline constexpr int maxTokenLength = 128;
inline constexpr int maxDownloads = 8;
inline constexpr int maxDownloadSeconds = 60;
inline constexpr int maxRequests = 64;
inline constexpr int maxIdleConnections = 48;
inline constexpr int maxOpensPerMinute = 6;
inline constexpr int maxOpenBurst = 4;
inline constexpr int maxEditors = 8;
inline constexpr int maxEditBytes = 65'536;
inline constexpr int maxEditDepth = 8;
inline constexpr int maxEditValues = 20'000;
inline constexpr int maxEditsOfStep = 100;
inline constexpr int maxRowsShown = 500;
inline constexpr int maxValueBytes = 32'768;
inline constexpr int maxSheetBytes = 262'144;
inline constexpr int maxNodeNumbers = 30'000;
inline constexpr int maxProbes = 50;
inline constexpr int maxComparedPixels = 2'097'152;
inline constexpr int maxProblemsShown = 200;
inline constexpr int maxLooksShown = 300;
inline constexpr int maxImportBytes = 33'554'432;

inline constexpr Limit limits[] = {
    {"maxViewers", maxViewers, "pages that are connected at a time"},
    {"maxMessageBytes", maxMessageBytes, "bytes of one message of a page"},
    {"maxMessagesPerSecond", maxMessagesPerSecond, "messages of one page per second, on average"},
    {"maxMessageBurst", maxMessageBurst, "messages of one page at once"},
    {"maxPictureSide", maxPictureSide, "pixels of a picture's side; a larger page scales it"},
    {"maxPicturePixels", maxPicturePixels, "pixels of a picture; a larger page scales it"},
    {"maxViewPixels", maxViewPixels, "pixels of the pictures of all views; they share them evenly"},
    {"maxPreviewPixels", maxPreviewPixels,
     "pixels of the previews of all views; they share them evenly"},
    {"minTokenLength", minTokenLength, "shortest token, in characters"},
    {"maxTokenLength", maxTokenLength, "longest token, in characters"},
    {"maxDownloads", maxDownloads,
     "saved pictures that wait to be fetched, of which the oldest one goes; and that become files"},
    {"maxDownloadSeconds", maxDownloadSeconds, "seconds for which a saved picture can be fetched"},
    {"maxRequests", maxRequests, "HTTP connections at a time"},
    {"maxIdleConnections", maxIdleConnections,
     "HTTP connections without a request; one more ends the one that has been idle for longest"},
    {"maxOpensPerMinute", maxOpensPerMinute,
     "pages of the web that a world opens per minute, on average"},
    {"maxOpenBurst", maxOpenBurst, "pages of the web that a world opens at once"},
    {"maxEditors", maxEditors, "pages that have the editor open at a time"},
    {"maxEditBytes", maxEditBytes, "bytes of one message that edits the world"},
    {"maxEditDepth", maxEditDepth, "arrays and objects within each other in such a message"},
    {"maxEditValues", maxEditValues, "values in such a message"},
    {"maxEditsOfStep", maxEditsOfStep, "edits of one step"},
    {"maxRowsShown", maxRowsShown, "rows of the outline that a page gets at once"},
    {"maxValueBytes", maxValueBytes, "bytes of a field's value; longer ones are not shown"},
    {"maxSheetBytes", maxSheetBytes, "bytes of the fields of a node; further ones are not shown"},
    {"maxNodeNumbers", maxNodeNumbers, "nodes that a page can name; older ones are forgotten"},
    {"maxProbes", maxProbes, "probes of the light"},
    {"maxComparedPixels", maxComparedPixels, "pixels of a picture whose changes since A are shown"},
    {"maxProblemsShown", maxProblemsShown, "messages about the world that a page gets"},
    {"maxLooksShown", maxLooksShown,
     "looks that a page can choose from; the user's own come first"},
    {"maxImportBytes", maxImportBytes, "bytes of a file that a page puts into the world"},
};

} // namespace vv::server
