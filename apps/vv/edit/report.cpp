#include "edit/report.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "base64.h"
#include "csv_field.h"
#include "html_page.h"

namespace vv {

namespace {

constexpr size_t mostFields = 40; // rows of the page; the table has all

using html::escaped;

std::string interval(double value, double halfWidth, bool sign = false) {
  return sign ? fmt::format("{:+.4g} ± {:.2g}", value, halfWidth)
              : fmt::format("{:.4g} ± {:.2g}", value, halfWidth);
}

const char* verdictOf(const Difference& change) {
  if (change.isSignificant) return "significant";
  return change.value == 0 && change.halfWidth == 0 ? "unchanged" : "not yet certain";
}

const char* stateOf(const Probe& probe) {
  switch (probe.state) {
  case Probe::State::waiting: return "not read yet";
  case Probe::State::hidden: return "not seen";
  case Probe::State::outside: return "outside of the picture";
  case Probe::State::otherView: return "of another view";
  default: return probe.now.trusted ? "trusted" : "not trusted";
  }
}

// Returns where a probe reads: the mean of a rectangle of the picture, or of points of the world,
// or a point of the world.
std::string placeOf(const Probe& probe) {
  if (!probe.area)
    return (probe.isMean() ? fmt::format("mean of {} x {} points about ", probe.sensor->columns,
                                         probe.sensor->rows)
                           : "") +
           fmt::format("{:.4g} {:.4g} {:.4g}", probe.point[0], probe.point[1], probe.point[2]);
  const PixelRectangle& pixels = probe.area->reading.pixels;
  return fmt::format("mean of {} x {} pixels at {}, {}", pixels.width, pixels.height, pixels.left,
                     pixels.top);
}

// Returns what a field belongs to: "LAMP  PointLight", or "PointLight" without a name.
std::string ownerOf(const xvrml::ChangedField& field) {
  if (field.type.empty()) return "the file";
  return field.name.empty() ? field.type : field.name + "  " + field.type;
}

const std::optional<Difference>& changeOf(const Report& report, size_t probe) {
  static const std::optional<Difference> none;
  return probe < report.changes.size() ? report.changes[probe] : none;
}

void addPictures(const Report& report, std::string& out) {
  out += report.pictures.size() > 1 ? "<div class=row>\n" : "<div>\n";
  for (const ReportPicture& one : report.pictures) {
    out += fmt::format("<figure><img alt=\"{}\" src=\"data:image/png;base64,", escaped(one.title));
    appendBase64(one.png, out);
    out += fmt::format("\">\n<figcaption>{}, {} x {} pixels</figcaption></figure>\n",
                       escaped(one.title), one.width, one.height);
  }
  out += "</div>\n";
  for (const ReportPicture& one : report.pictures)
    if (!one.command.empty())
      out += fmt::format("<p>To make this picture again{}:<br><code>{}</code></p>\n",
                         report.isUnsaved ? ", save the edits first" : "", escaped(one.command));
}

void addProbes(const Report& report, std::string& out) {
  if (report.probes.empty()) return;
  out += "<h2>Light at the probes</h2>\n<table><tr><th>probe<th>place<th><th class=n>before (A)"
         "<th class=n>now (B)<th class=n>B - A<th></tr>\n";
  for (size_t i = 0; i < report.probes.size(); ++i) {
    const Probe& probe = report.probes[i];
    const bool isRead = probe.state == Probe::State::read;
    const std::optional<Difference>& change = changeOf(report, i);
    const std::string before =
        change ? interval(probe.before.luminance, probe.before.luminanceHalfWidth) : "";
    const std::string now =
        isRead ? interval(probe.now.luminance, probe.now.luminanceHalfWidth) : "";
    const std::string verdict =
        change ? fmt::format("{}, {}", verdictOf(*change), stateOf(probe)) : stateOf(probe);
    out += fmt::format("<tr><td>{}<td>{}<td>{}, {}<td class=n>{}<td class=n>{}<td "
                       "class=n>{}<td>{}</tr>\n",
                       escaped(titleOf(probe)), placeOf(probe), quantityOf(probe), unitOf(probe),
                       before, now, change ? interval(change->value, change->halfWidth, true) : "",
                       verdict);
  }
  out += "</table>\n<p class=weak>± is half of the 95 % interval. A change is significant at 5 % "
         "for all probes together (Holm), if both intervals can be trusted.</p>\n";
}

void addFields(const Report& report, std::string& out) {
  out += "<h2>Edited since the file was read</h2>\n";
  if (report.fields.empty()) {
    out += "<p>No field differs.</p>\n";
    return;
  }
  out += "<table><tr><th>node<th>line<th>field<th>before<th>now</tr>\n";
  const size_t shown = std::min(report.fields.size(), mostFields);
  for (size_t i = 0; i < shown; ++i) {
    const xvrml::ChangedField& field = report.fields[i];
    out += fmt::format("<tr><td>{}<td>{}<td>{}<td><code>{}</code><td><code>{}</code></tr>\n",
                       escaped(ownerOf(field)), field.line > 0 ? std::to_string(field.line) : "",
                       escaped(field.field), escaped(field.before), escaped(field.now));
  }
  out += "</table>\n";
  if (shown < report.fields.size())
    out += fmt::format("<p class=weak>and {} more, which the table beside this page has.</p>\n",
                       report.fields.size() - shown);
}

} // namespace

std::string reportPage(const Report& report) {
  const std::string world = escaped(report.world);
  std::string out(html::head);
  out += fmt::format("<title>{} - report</title>\n</head>\n<body>\n<h1>{}</h1>\n<p "
                     "class=weak>{}. {}{}</p>\n",
                     world, world, escaped(report.program),
                     report.problems == 0   ? "No problems are known."
                     : report.problems == 1 ? "1 problem is known: vv --check shows it."
                                            : fmt::format("{} problems are known: vv --check "
                                                          "shows them.",
                                                          report.problems),
                     report.isUnsaved ? " The edits have not been saved." : "");
  addPictures(report, out);
  addProbes(report, out);
  addFields(report, out);
  return out + "</body>\n</html>\n";
}

std::string reportTable(const Report& report) {
  std::string out = "kind,name,field,x,y,z,before,before_half_width,now,now_half_width,difference,"
                    "difference_half_width,remark\n";
  for (const ReportPicture& one : report.pictures)
    out += fmt::format("picture,{},,{},{},,,,,,,,{}\n", csvField(one.title), one.width, one.height,
                       csvField(one.command));
  for (size_t i = 0; i < report.probes.size(); ++i) {
    const Probe& probe = report.probes[i];
    const std::optional<Difference>& change = changeOf(report, i);
    out += fmt::format("probe,{},{} in {},", csvField(titleOf(probe)), quantityOf(probe),
                       unitOf(probe));
    out += probe.area ? std::string(",,,")
                      : fmt::format("{:.9g},{:.9g},{:.9g},", probe.point[0], probe.point[1],
                                    probe.point[2]);
    out += change ? fmt::format("{:.9g},{:.9g},", probe.before.luminance,
                                probe.before.luminanceHalfWidth)
                  : ",,";
    out += probe.state == Probe::State::read
               ? fmt::format("{:.9g},{:.9g},", probe.now.luminance, probe.now.luminanceHalfWidth)
               : ",,";
    out += change ? fmt::format("{:.9g},{:.9g},", change->value, change->halfWidth) : ",,";
    std::string remark = change ? fmt::format("{}, ", verdictOf(*change)) : "";
    remark += stateOf(probe);
    if (probe.isMean()) remark += ", " + placeOf(probe);
    out += csvField(remark) + "\n";
  }
  for (const xvrml::ChangedField& field : report.fields)
    out += fmt::format("field,{},{},,,,{},,{},,,,{}\n", csvField(ownerOf(field)),
                       csvField(field.field), csvField(field.before), csvField(field.now),
                       field.line > 0 ? csvField(fmt::format("line {}", field.line)) : "");
  return out;
}

} // namespace vv
