#include "libpicture/luminaires.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>

#include "plugins/shaders/eulumdat.h"
#include "plugins/shaders/ies.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"

namespace picture {

namespace {

Vec column(const double matrix[16], int i) {
  return {matrix[4 * i], matrix[4 * i + 1], matrix[4 * i + 2]};
}

// Returns whether a matrix turns, mirrors and moves only. Intensities in a scaled node are not
// those of the file.
bool isRigid(const double m[16]) {
  constexpr double rounding = 1e-4;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k <= i; ++k)
      if (!(std::abs(dot(column(m, i), column(m, k)) - (i == k)) < rounding)) return false;
  return true;
}

Vec turned(const double m[16], Vec v) {
  return column(m, 0) * v.x + column(m, 1) * v.y + column(m, 2) * v.z;
}

Vec unit(Vec v, Vec otherwise) {
  const double l = length(v);
  return l > 0 && std::isfinite(l) ? v / l : otherwise;
}

// Reads the text that the first readable URL names. Returns false if there is none.
bool readText(const xvrml::ShaderOption& option, const xvrml::Node& shader,
              const xvrml::World& world, std::string& text) {
  constexpr size_t longest = 1 << 24; // as for the parameter of the shader
  std::vector<std::string> urls{option.text};
  urls.insert(urls.end(), option.otherUrls.begin(), option.otherUrls.end());
  const std::string& base = shader.source.file ? *shader.source.file : world.path;
  for (const std::string& url : urls) {
    const xvrml::ResolvedUrl resolved = xvrml::resolveUrl(url, base, world.options);
    if (!resolved.error.empty()) continue;
    std::ifstream file(resolved.path, std::ios::binary);
    text.resize(longest);
    file.read(text.data(), std::streamsize(longest));
    text.resize(size_t(file.gcount()));
    if (!text.empty()) return true;
  }
  return false;
}

} // namespace

// The parameters of the class Luminaire (plugins/shaders/luminaire.cpp), with its defaults.
struct Luminaire::Options {
  std::string text; // the profile
  double intensity = 1, lumen = 0, maintenance = 1, tilt = 0, colour = 1;
  Vec location, direction{0, 0, -1}, reference{1, 0, 0};

  void set(const xvrml::ShaderOption& option) {
    const std::vector<float>& n = option.numbers;
    const auto number = [&](double& to) { to = n.size() == 1 ? double(n[0]) : to; };
    const auto vector = [&](Vec& to) {
      if (n.size() == 3) to = {double(n[0]), double(n[1]), double(n[2])};
    };
    if (option.name == "intensity") number(intensity);
    if (option.name == "lumen") number(lumen);
    if (option.name == "maintenance") number(maintenance);
    if (option.name == "tilt") number(tilt);
    if (option.name == "location") vector(location);
    if (option.name == "direction") vector(direction);
    if (option.name == "reference") vector(reference);
    if (option.name == "color" && n.size() == 3)
      colour = .2126 * double(n[0]) + .7152 * double(n[1]) + .0722 * double(n[2]);
  }
};

std::vector<Luminaire> Luminaire::read(const std::vector<xvrml::SensorInfo>& lights,
                                       const xvrml::World& world) {
  std::vector<Luminaire> out;
  for (const xvrml::SensorInfo& light : lights) {
    const auto& node = static_cast<const xvrml::nodes::ORTLight&>(*light.node);
    const auto* shader =
        xvrml::nodeCast<xvrml::nodes::ORTShader>(xvrml::renderedNode(node.shader.get()));
    if (shader && shader->name == "Luminaire") out.emplace_back().readLight(light, world);
  }
  return out;
}

void Luminaire::readLight(const xvrml::SensorInfo& light, const xvrml::World& world) {
  const auto& node = static_cast<const xvrml::nodes::ORTLight&>(*light.node);
  const auto& shader =
      static_cast<const xvrml::nodes::ORTShader&>(*xvrml::renderedNode(node.shader.get()));
  name = light.name;
  Options options;
  for (const xvrml::ShaderOption& option : xvrml::shaderOptions(shader)) {
    options.set(option);
    if (option.name != "profile") continue;
    const bool isFile = option.type == xvrml::ShaderOption::Type::file;
    if (isFile) file = option.text;
    if (!isFile)
      options.text = option.text;
    else if (!readText(option, shader, world, options.text))
      problem = "its file cannot be read";
  }
  const double* m = light.matrix;
  place = turned(m, options.location) + column(m, 3);
  maintenance = options.maintenance;
  // as the shader does it, in the coordinates of the node
  const Vec down = unit(options.direction, {0, 0, -1});
  const Vec other = std::abs(down.x) < .9 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  const Vec given = options.reference + down * -dot(options.reference, down);
  const Vec zero =
      length(given) > 1e-6 * length(options.reference) ? given : other + down * -dot(other, down);
  axis_ = turned(m, down);
  zero_ = turned(m, unit(zero, other));
  ninety_ = turned(m, cross(unit(zero, other), down));
  if (problem.empty() && !isRigid(m)) problem = "it stands in a scaled coordinate system";
  if (problem.empty()) readProfile(options.text, options);
}

void Luminaire::readProfile(const std::string& text, const Options& options) {
  auto made = std::make_shared<photometry::Photometry>();
  int line = 0;
  if (text.empty() && options.lumen > 0) {
    made->vertical = {0, 180};
    made->horizontal = {0};
    made->candela = {1, 1};
  } else if (eulumdat::looksLike(text) ? eulumdat::parse(text, *made, line)
                                       : ies::parse(text, *made, line, options.tilt)) {
    problem = "its profile cannot be used";
    return;
  }
  const double own = made->flux();
  factor_ = options.intensity * options.maintenance * options.colour;
  if (options.lumen > 0 && own > 0) factor_ *= options.lumen / own;
  flux = own * factor_;
  photometry_ = std::move(made);
}

bool Luminaire::hasOpening() const {
  return photometry_->opening.exists();
}

SeenLuminaire Luminaire::from(Vec point) const {
  SeenLuminaire seen;
  const Vec way = place + point * -1;
  seen.distance = length(way);
  if (!(seen.distance > 0)) return seen;
  seen.towards = way / seen.distance;
  const Vec out = seen.towards * -1;
  const double axis = dot(out, axis_), zero = dot(out, zero_), ninety = dot(out, ninety_);
  seen.intensity = double(photometry_->towards(axis, zero, ninety)) * factor_;
  seen.area = photometry_->opening.projected(axis, zero, ninety);
  return seen;
}

} // namespace picture
