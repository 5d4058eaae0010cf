// light_texts.h: Writes the light that the editor of a page shows as JSON: probes and where they
// are in the picture, A and what has changed since, reports. Pure functions. docs/serve.md lists
// the messages. [the browser's thread]
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "edit/comparison.h"
#include "edit/probes.h"
#include "server/edit_command.h"

namespace vv::server::edit {

std::string probesText(const Probes& probes);
// Returns where the probes are in the picture of this view.
std::string marksText(const Probes& probes, const EditView& view);
// isLeaders: the page shows the picture that is compared. pointer: where the change is wanted.
std::string comparisonText(const Comparison& comparison, bool isLeaders,
                           const std::optional<Place>& pointer);
// pointer: null: the page's pointer does not rest. isReadable: the picture has error bars.
std::string pointerText(const PointerReading* pointer, bool isReadable);
// Returns a picture that covers the present one. jpeg: the bytes of its file.
std::string coverText(int width, int height, std::string_view jpeg);
// text: how far a report is.
std::string progressText(const std::string& text);
// Tells a page where the files of its report can be fetched.
std::string reportText(std::span<const std::string> paths, std::span<const std::string> names);

} // namespace vv::server::edit
