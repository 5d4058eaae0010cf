// fields.h: the curves and surfaces of NURBS nodes (ISO/IEC 19775-1 clause 27), with what the
// standard says for fields that do not fit. Pure functions; any thread.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/faults.h"
#include "geometry/nurbs/spline.h"
#include "xvrml/nodes.h"

namespace xvrml {

// They return nothing, and note a fault, if there is no such curve or surface. A node without
// control points is no fault.
std::optional<RationalCurve> curveOf(const nodes::NurbsCurve& node, Faults& faults);
std::optional<RationalCurve> curveOf(const nodes::NurbsCurve2D& node, Faults& faults);
std::optional<RationalCurve> curveOf(const nodes::NurbsPositionInterpolator& node, Faults& faults);
std::optional<RationalCurve> curveOf(const nodes::NurbsOrientationInterpolator& node,
                                     Faults& faults);
std::optional<RationalSurface> surfaceOf(const nodes::NurbsPatchSurface& node, Faults& faults);
std::optional<RationalSurface> surfaceOf(const nodes::NurbsTrimmedSurface& node, Faults& faults);
std::optional<RationalSurface> surfaceOf(const nodes::NurbsSurfaceInterpolator& node,
                                         Faults& faults);

// Return the surface in the plane z = 0 that gives the texture coordinates of a surface at the same
// fractions of its parameters; nothing for the whole texture.
std::optional<RationalSurface> texturePatchOf(const nodes::NurbsPatchSurface& node, Faults& faults);
std::optional<RationalSurface> texturePatchOf(const nodes::NurbsTrimmedSurface& node,
                                              Faults& faults);

// A curve of the plane as the points that are drawn of it, in the order of its parameter.
struct PlaneCurve {
  std::vector<V2d> points;
  std::vector<V2d> tangents;     // derivatives by the parameter; empty: corners at all points
  std::vector<double> fractions; // the parts of the range of the parameter before the points
};
// Returns the points of a NurbsCurve2D, two where it may bend, or a ContourPolyline2D. most: the
// greatest number of steps. Returns no points for another node, and where there is a fault.
PlaneCurve planeCurveOf(const NodeRef& node, uint64_t most, Faults& faults);

// Returns the number of steps by a field `tessellation` and the number of control points.
uint64_t stepsOf(int32_t tessellation, size_t controlPoints);

} // namespace xvrml
