#include "report/measure_page.h"

#include <fmt/format.h>

#include "html_page.h"
#include "report/describe.h"
#include "report/isolux.h"

namespace vv {

namespace {

using html::escaped;
using picture::Luminaire;
using picture::Measurement;

constexpr size_t mostLuminaires = 200; // rows of the page

std::string withUnit(double value, const char* unit) {
  return fmt::format("{:.4g}{}{}", value, *unit ? " " : "", unit);
}

void addRow(const char* name, const std::string& value, std::string& out) {
  out += fmt::format("<tr><td>{}<td class=n>{}</tr>\n", name, value);
}

void addSensor(const Measurement& m, const Promise& promise, std::string& out) {
  const picture::QuantityInfo& info = picture::infoOf(m.sensor.quantity);
  const MeasurementSummary all(m);
  out += fmt::format("<h2>{}: {}</h2>\n", escaped(m.sensor.name), info.name);
  if (all.points == 0) {
    out += "<p>No reading was finished.</p>\n";
    return;
  }
  out += isoluxPicture(m);
  out += "<table>\n";
  addRow(
      all.points > 1 ? "mean, 95 % interval" : "reading, 95 % interval",
      fmt::format("{:.4g} ± {:.2g}{}{}", all.mean, all.halfWidth, *info.unit ? " " : "", info.unit),
      out);
  if (all.points > 1) {
    addRow("least", withUnit(all.least, info.unit), out);
    addRow("most", withUnit(all.most, info.unit), out);
    addRow("uniformity (least over mean)", fmt::format("{:.3g}", all.uniformity()), out);
  }
  if (m.outdoors > 0) {
    addRow("daylight factor", fmt::format("{:.3g} %", 100 * all.mean / m.outdoors), out);
    addRow("horizontal illuminance outdoors", withUnit(m.outdoors, "lx"), out);
  }
  addRow("points",
         fmt::format("{} x {}, {} trusted", m.sensor.columns, m.sensor.rows,
                     all.trusted == all.points ? "all" : std::to_string(all.trusted)),
         out);
  out += "</table>\n";
  for (const std::string& warning : measurementWarnings(m, promise))
    out += fmt::format("<p>{}.</p>\n", escaped(warning));
}

void addLuminaires(const std::vector<Luminaire>& luminaires, std::string& out) {
  if (luminaires.empty()) return;
  out += "<h2>Luminaires</h2>\n<table><tr><th>name<th>file<th class=n>flux, lm<th "
         "class=n>maintenance<th class=n>place, m</tr>\n";
  double sum = 0;
  for (size_t i = 0; i < luminaires.size(); ++i) {
    const Luminaire& one = luminaires[i];
    sum += one.flux;
    if (i >= mostLuminaires) continue;
    out += fmt::format("<tr><td>{}<td>{}<td class=n>{}<td class=n>{:.3g}<td class=n>{:.4g} {:.4g} "
                       "{:.4g}</tr>\n",
                       escaped(one.name), escaped(one.file),
                       one.problem.empty() ? fmt::format("{:.4g}", one.flux) : escaped(one.problem),
                       one.maintenance, one.place.x, one.place.y, one.place.z);
  }
  out += fmt::format("<tr><td>{} in all<td><td class=n>{:.4g}<td><td></tr>\n</table>\n<p "
                     "class=weak>The flux has the maintenance factor in it.</p>\n",
                     luminaires.size(), sum);
}

} // namespace

std::string measurementsPage(const std::vector<Measurement>& sensors, const MeasurePage& page) {
  const std::string world = escaped(page.world);
  std::string out(html::head);
  out += fmt::format("<title>{} - light</title>\n</head>\n<body>\n<h1>{}</h1>\n<p "
                     "class=weak>Measured by vv {}. ± is half of the 95 % interval.{}</p>\n",
                     world, world, escaped(version()),
                     page.sky.empty() ? "" : " Sky: " + escaped(page.sky) + ".");
  for (const Measurement& m : sensors) addSensor(m, page.promise, out);
  addLuminaires(page.luminaires, out);
  out += fmt::format("<h2>To measure again</h2>\n<p><code>{}</code></p>\n</body>\n</html>\n",
                     escaped(page.command));
  return out;
}

} // namespace vv
