// json_commas.h: the commas of a text of JSON of which parts have been replaced. [any thread]
#pragma once

#include <string>
#include <string_view>

namespace xvrml {

// Returns a text with a comma between any two members or elements that follow each other, and with
// no other commas. A text that has them already is returned as it is.
std::string withCommas(std::string_view text);

} // namespace xvrml
