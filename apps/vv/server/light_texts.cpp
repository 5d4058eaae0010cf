#include "server/light_texts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "as_json/json_line.h"
#include "base64.h"

namespace vv::server::edit {

using json::Json;
using json::jsonLine;

namespace {

const char* nameOf(Probe::State state) {
  switch (state) {
  case Probe::State::waiting: return "waiting";
  case Probe::State::hidden: return "hidden";
  case Probe::State::outside: return "outside";
  case Probe::State::otherView: return "other_view";
  case Probe::State::read: break;
  }
  return "read";
}

const char* nameOf(Comparison::Shown shown) {
  switch (shown) {
  case Comparison::Shown::a: return "a";
  case Comparison::Shown::wiper: return "wiper";
  case Comparison::Shown::difference: return "difference";
  case Comparison::Shown::present: break;
  }
  return "present";
}

} // namespace

std::string probesText(const Probes& probes) {
  const std::vector<std::optional<Difference>> changes = probes.differences();
  Json list = Json::array();
  for (size_t i = 0; i < changes.size(); ++i) {
    const Probe& probe = probes.all()[i];
    Json one = {{"number", probe.number}, {"state", nameOf(probe.state)}};
    if (!probe.name.empty()) one["name"] = probe.name;
    if (probe.area) one["area"] = true;
    if (!probe.seen.empty()) one["seen"] = probe.seen;
    if (probe.state == Probe::State::read) {
      one[quantityOf(probe)] = probe.now.luminance;
      one["half_width"] = probe.now.luminanceHalfWidth;
      one["trusted"] = probe.now.trusted;
      if (const MeanReading* const several = probe.several()) {
        one["least"] = several->least;
        one["most"] = several->most;
        one["uniformity"] = several->uniformity();
      }
    }
    if (changes[i]) {
      one["change"] = changes[i]->value;
      one["change_half_width"] = changes[i]->halfWidth;
      one["significant"] = changes[i]->isSignificant;
    }
    list.push_back(std::move(one));
  }
  return jsonLine({{"type", "probes"}, {"list", list}});
}

std::string marksText(const Probes& probes, const EditView& view) {
  Json marks = Json::array();
  const auto rounded = [](double place) { return std::round(place * 1e4) / 1e4; };
  for (const Probe& probe : probes.all()) {
    if (probe.area) {
      if (probe.area->view != view) continue;
      const Region& region = probe.area->region;
      marks.push_back({{"number", probe.number},
                       {"left", region.left},
                       {"bottom", region.bottom},
                       {"right", region.right},
                       {"top", region.top}});
      continue;
    }
    double x = 0, y = 0;
    if (!xvrml::projectPoint(view.camera, view.aspect, probe.point.data(), x, y) ||
        std::max(std::abs(x), std::abs(y)) >= 1)
      continue;
    marks.push_back({{"number", probe.number}, {"x", rounded(x)}, {"y", rounded(y)}});
  }
  return jsonLine({{"type", "marks"}, {"list", marks}});
}

std::string comparisonText(const Comparison& comparison, bool isLeaders,
                           const std::optional<Place>& pointer) {
  const ChangePicture* const changes = isLeaders ? comparison.changes() : nullptr;
  Json text = {{"type", "comparison"},
               {"kept", isLeaders && comparison.hasA()},
               {"complete", comparison.isComplete()},
               {"shown", nameOf(isLeaders ? comparison.shown() : Comparison::Shown::present)}};
  if (changes) {
    text["most"] = changes->most;
    text["least"] = changes->least;
    text["pixels"] = changes->changes.size();
    text["judged"] = changes->judged;
    text["significant"] = changes->significant;
    if (pointer) text["here"] = changes->at(pointer->x, pointer->y);
  }
  return jsonLine(text);
}

std::string pointerText(const PointerReading* pointer, bool isReadable) {
  Json text = {{"type", "pointer"}};
  if (!pointer || !pointer->seen) return jsonLine(text);
  text["x"] = pointer->x;
  text["y"] = pointer->y;
  text["seen"] = *pointer->seen;
  if (const auto& light = pointer->light) {
    text["luminance"] = light->luminance;
    text["half_width"] = light->luminanceHalfWidth;
    text["radiance"] = light->radiance;
    text["radiance_half_width"] = light->halfWidth;
    text["samples"] = light->samples;
    text["trusted"] = light->trusted;
  } else {
    text["readable"] = isReadable;
  }
  return jsonLine(text);
}

std::string coverText(int width, int height, std::string_view jpeg) {
  std::string text =
      fmt::format(R"({{"type":"cover","width":{},"height":{},"image":")", width, height);
  appendBase64(jpeg, text);
  return text + "\"}";
}

std::string progressText(const std::string& text) {
  return jsonLine({{"type", "progress"}, {"text", text}});
}

std::string reportText(std::span<const std::string> paths, std::span<const std::string> names) {
  Json files = Json::array();
  for (size_t i = 0; i < std::min(paths.size(), names.size()); ++i)
    files.push_back({{"path", paths[i]}, {"name", names[i]}});
  return jsonLine({{"type", "report"}, {"files", files}});
}

} // namespace vv::server::edit
