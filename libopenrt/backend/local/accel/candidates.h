// candidates.h: finds every box that a ray may touch, so that an exact test (crossing.h) misses
// nothing. Embree traverses the boxes in single precision; they are padded by more than it rounds.
// Built between frames; then immutable.
#pragma once

#include <functional>

#include "backend/local/accel/embree_device.h"
#include "scene/matrix.h"

namespace openrt {

struct Span {
  Vec3d low, high;
};

// A line o + t d in the frame of a CandidateScene, in which everything lies within [-1, 1]^3.
struct FrameRay {
  Vec3d origin, direction;
  double near, far;
};

// How to search a body for what a ray may meet.
enum class Search {
  none,  // the ray passes the body
  boxes, // the boxes along the ray hold all candidates
  all    // rounding is too large for the boxes: everything in the body is a candidate
};

// Below these numbers all are tried, without a CandidateScene.
inline constexpr uint32_t fewTriangles = 12, fewSurfaces = 6;

// Returns the power of two that brings a length below 1; 1 for a length that has none.
double unitOf(double length);

// Receives the boxes that a ray may touch, in no particular order.
class CandidateVisitor {
 public:
  virtual ~CandidateVisitor() = default;
  // Returns the t from which on further boxes are of no interest; below `near` to end the search.
  virtual double visit(uint32_t box) = 0;
};

class CandidateScene {
 public:
  using BoxOf = std::function<Span(uint32_t box)>;
  // The boxes lie within [-1, 1]^3. boxOf is called from several threads, and not afterwards.
  CandidateScene(const EmbreeDevice& device, uint32_t count, const BoxOf& boxOf);
  ~CandidateScene() { rtcReleaseScene(scene_); }
  CandidateScene(const CandidateScene&) = delete;
  CandidateScene& operator=(const CandidateScene&) = delete;

  // Calls the visitor for every box that the ray touches between near and far, and for a few that
  // it passes within 1e-6. Coordinates of the origin above 2^30 are too large for that promise.
  // [any thread]
  void visit(const FrameRay& ray, CandidateVisitor& visitor) const;
  // Calls the visitor for every box within a distance of a point, and for a few beyond. The visitor
  // returns the distance that still interests it. [any thread]
  void visitNear(const Vec3d& point, double distance, CandidateVisitor& visitor) const;

 private:
  RTCScene scene_ = nullptr;
};

// Returns whether the ray comes within a distance of 2 of the origin of the frame, and the t at
// which it enters and leaves that ball.
bool clipToBall(const FrameRay& ray, double& enter, double& leave);

} // namespace openrt
