// html_page.h: The parts that pages of reports share: a head that lets nothing be loaded or run,
// and texts that are shown as they are. [any thread]
#pragma once

#include <string>
#include <string_view>

#include "printable.h"

namespace html {

// Begins a page for A4 up to its <title>. The page runs no program and loads nothing, whatever the
// texts in it are.
inline constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<style>
@page { size: A4; margin: 15mm }
body { font: 10pt/1.35 sans-serif; color: #111; background: #fff; max-width: 180mm; margin: 1em auto }
h1 { font-size: 15pt; margin: 0 0 .2em } h2 { font-size: 11pt; margin: 1.1em 0 .3em }
img, svg { max-width: 100%; max-height: 95mm; display: block }
table { border-collapse: collapse; width: 100% }
th, td { text-align: left; vertical-align: top; padding: .15em .6em .15em 0; border-bottom: 1px solid #ccc }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums }
code { font: 8.5pt/1.3 monospace; white-space: pre-wrap; overflow-wrap: anywhere }
figure { margin: 0 0 .6em } .row figure { display: inline-block; width: 48%; margin-right: 1% } .weak { color: #555 }
</style>
)";

// Returns a text that a page shows as it is.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : printable(text)) {
    switch (c) {
    case '&': out += "&amp;"; break;
    case '<': out += "&lt;"; break;
    case '>': out += "&gt;"; break;
    case '"': out += "&quot;"; break;
    case '\'': out += "&#39;"; break;
    default: out += c;
    }
  }
  return out;
}

} // namespace html
