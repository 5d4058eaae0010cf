// luminaires.h: The lights of the class Luminaire as a report and glare ratings need them: where
// they stand, their flux, and their intensity and luminous opening as an eye sees them. [any
// thread]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "libpicture/vec.h"
#include "xvrml/mapper.h"
#include "xvrml/world.h"

namespace photometry {
class Photometry;
}

namespace picture {

// A luminaire as it is seen from a point.
struct SeenLuminaire {
  Vec towards;          // unit vector from the point to the photometric centre
  double distance = 0;  // metres
  double intensity = 0; // candela
  double area = 0;      // projected area of the luminous opening, m2; 0: unknown
};

class Luminaire {
 public:
  // Reads a light at its place. A light of another class is none.
  static std::vector<Luminaire> read(const std::vector<xvrml::SensorInfo>& lights,
                                     const xvrml::World& world);

  std::string name;    // DEF name, may be empty
  std::string file;    // the URL of its profile, may be empty
  std::string problem; // why it is not known how the luminaire shines; empty: it is known
  double flux = 0;     // lumen, with all factors
  double maintenance = 1;
  Vec place; // the photometric centre in the world

  // Returns whether its file says what of it shines. [only if there is no problem]
  bool hasOpening() const;
  // Returns how it is seen from a point of the world. [only if there is no problem]
  SeenLuminaire from(Vec point) const;

 private:
  struct Options;
  void readLight(const xvrml::SensorInfo& light, const xvrml::World& world);
  void readProfile(const std::string& text, const Options& options);
  std::shared_ptr<const photometry::Photometry> photometry_;
  Vec axis_, zero_, ninety_; // the photometric axes in the world
  double factor_ = 1;        // multiplies the intensities of the file
};

} // namespace picture
