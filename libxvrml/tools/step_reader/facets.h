// facets.h: divides the faces of a part into triangles. [one thread]
#pragma once

#include <TDF_Label.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFPrs_Style.hxx>

#include "model.h"

namespace xvrml::decoding {

class Facets {
 public:
  // chordError: millimetres between a triangle and the surface; 0: a part of each part's size.
  Facets(Model& model, double chordError) : model_(model), chordError_(chordError) {}
  // Returns the mesh of a part with a style; nothing if the part has no faces.
  std::optional<size_t> meshOf(const TDF_Label& part, const std::string& name,
                               const XCAFPrs_Style& style);

 private:
  size_t materialOf(const Model::Material& material);
  double chordErrorOf(const TopoDS_Shape& shape) const;

  Model& model_;
  const double chordError_;
};

} // namespace xvrml::decoding
