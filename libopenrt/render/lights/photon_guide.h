// photon_guide.h: the directions in which the light of emissive shapes and of the sun reaches
// non-specular surfaces by way of mirrors and smooth glass. Light paths leave photons on those
// surfaces; the photons around a point say where such light comes from, and camera paths sample
// directions from them: H. W. Jensen, "Importance Driven Path Tracing using the Photon Map", 1995.
// Only the sampling depends on the photons, not the expected value of the picture. Built between
// frames, read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/vec3.h"

namespace openrt {

// The end of a light path at its first non-specular surface, in render space.
struct Photon {
  Vec3f position;
  Vec3f direction; // unit, towards the specular surface that the light has come from
  float power;     // its largest colour
  // Lengths of the last ray and of the whole path from the emitter.
  float last, total;
};

class PhotonGuide {
 public:
  // Stays empty if there are too few photons to learn from.
  explicit PhotonGuide(std::vector<Photon> photons);
  bool empty() const { return cells_.empty(); }
  uint32_t cells() const { return uint32_t(cells_.size()); }
  // Sets which share of the hits in each cell sends a guided ray, in [0, 1]. Forgets the photons of
  // the cells whose share is 0. Without a call all hits send one.
  void setShares(const std::vector<float>& shares);
  float share(uint32_t cell) const { return cells_[cell].share; }

  // Returns the cell with the photons around a point; `none` if there are none nearby.
  static constexpr uint32_t none = ~0u;
  uint32_t find(const Vec3f& position) const;
  // Samples a unit direction in which light reaches a point of a cell. pick, u, v: numbers in
  // [0, 1). Returns its solid-angle pdf times the share of the cell; 0: none was sampled.
  float sample(uint32_t cell, const Vec3f& position, float pick, float u, float v,
               Vec3f& direction) const;
  // Returns what sample() returns for a direction.
  float pdf(uint32_t cell, const Vec3f& position, const Vec3f& direction) const;

 private:
  // Each photon of a cell is a lobe of directions around the one in which light from its focus
  // arrives. So the lobes of a cell follow from the point at which they are looked up. The lobes of
  // all cells, cell by cell:
  std::vector<float> focus_[3];
  std::vector<float> side_;   // 1: light comes from the focus; -1: it goes to a focus further on
  std::vector<float> spread_; // the spread of the lobe
  std::vector<float> probability_; // selection probability of the lobe within its cell
  struct Cell {
    uint32_t begin, end; // the range of its lobes
    Vec3f low, high;     // where the photons are taken as valid
    float share = 1;     // the share of the hits that send a guided ray
  };
  struct Node { // inner node of a kd-tree; a child below 0 is the cell with the number ~child
    int32_t child[2];
    uint32_t axis;
    float split;
  };
  int32_t build(std::vector<Photon>& photons, uint32_t begin, uint32_t end);
  int32_t addCell(const std::vector<Photon>& photons, uint32_t begin, uint32_t end);

  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
};

} // namespace openrt
