#include "write/xml_escape.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "printable.h"

namespace xvrml {

void escapeXml(std::string& out, std::string_view text, std::string_view quotes) {
  while (!text.empty()) {
    const size_t length = printable_text::utf8Length(text);
    const auto byte = static_cast<unsigned char>(text[0]);
    if (length == 0) {
      fmt::format_to(std::back_inserter(out), "&#{};", byte);
    } else if (length == 1 && byte < 0x20) {
      if (byte == '\n' || byte == '\t' || byte == '\r')
        fmt::format_to(std::back_inserter(out), "&#{};", byte);
      else
        out += "\xef\xbf\xbd";
    } else if (text.starts_with("\xef\xbf\xbe") || text.starts_with("\xef\xbf\xbf")) {
      out += "\xef\xbf\xbd"; // U+FFFE and U+FFFF
    } else if (byte == '&' || byte == '<' || byte == '>') {
      out += byte == '&' ? "&amp;" : byte == '<' ? "&lt;" : "&gt;";
    } else if (quotes.find(text[0]) != quotes.npos) {
      out += byte == '"' ? "&quot;" : "&apos;";
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<size_t>(length, 1));
  }
}

} // namespace xvrml
