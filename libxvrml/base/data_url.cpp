// data_url.cpp: decodes data: URLs, whose bytes stand in the URL itself.
#include "base/data_url.h"

#include <fmt/format.h>

#include "base/percent.h"
#include "base64.h"

namespace xvrml {

bool isDataUrl(std::string_view url) {
  constexpr std::string_view scheme = "data:";
  if (url.size() < scheme.size()) return false;
  for (size_t i = 0; i < scheme.size(); ++i)
    if ((url[i] >= 'A' && url[i] <= 'Z' ? char(url[i] + 32) : url[i]) != scheme[i]) return false;
  return true;
}

// "data:[type][;parameter]...[;base64],bytes"
bool decodeDataUrl(std::string_view url, uint64_t most, DataUrl& out, std::string& why) {
  const size_t comma = url.find(',');
  if (!isDataUrl(url) || comma == url.npos) {
    why = "this is not a data: URL";
    return false;
  }
  std::string_view head = url.substr(5, comma - 5), body = url.substr(comma + 1);
  out.bytes.clear();
  out.type.clear();
  for (const char c : head.substr(0, head.find(';')))
    out.type += c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  if (body.size() > 3 * most) {
    why = fmt::format("a data: URL of more than {} bytes", most);
    return false;
  }
  if (!head.ends_with(";base64")) {
    out.bytes = percentDecoded(body); // here %00 is a byte like any other
  } else {
    uint32_t bits = 0;
    int count = 0;
    for (const char c : body) {
      if (c == '=' || c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
      const uint32_t digit = valueOfBase64(c);
      if (digit > 63) {
        why = "a data: URL that is not base64";
        return false;
      }
      bits = bits << 6 | digit;
      if ((count += 6) < 8) continue;
      count -= 8;
      out.bytes += char(bits >> count & 0xff);
    }
  }
  if (out.bytes.size() > most) {
    why = fmt::format("a data: URL of more than {} bytes", most);
    return false;
  }
  return true;
}

} // namespace xvrml
