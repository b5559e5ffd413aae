// The robot's tree, and arrays of Python bound to it, as the kernels read them.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "arrays.hpp"

namespace plantar {

// The tree with its own storage, and the arrays of one batch bound to it.
class TreeObject {
 public:
  TreeObject(const std::vector<int>& parents, const std::vector<bool>& slides, const std::vector<Packed>& axes,
             const std::vector<Packed>& frames, bool floating) {
    if (floating) {
      Link root = {};
      root.parent = -1;
      root.joint = Joint::root;
      links_.push_back(root);
    }
    const std::size_t n = parents.size();
    if (slides.size() != n || axes.size() != n || frames.size() != n)
      throw std::invalid_argument("every joint needs a parent, a kind, an axis and a frame");
    for (std::size_t i = 0; i < n; ++i) {
      Link link = {};
      link.parent = parents[i] + (floating ? 1 : 0);
      if (parents[i] < -1 || parents[i] >= static_cast<int>(i)) throw std::invalid_argument("parents come first");
      if (axes[i].shape(0) != 3) throw std::invalid_argument("an axis is three numbers");
      std::copy_n(axes[i].data(), 3, link.axis);
      link.placement = frame(frames[i]);
      const double* r = link.placement.rotation;
      link.turned = !(r[0] == 1.0 && r[4] == 1.0 && r[8] == 1.0);
      link.joint = slides[i]               ? Joint::prismatic
                   : link.axis[0] == 1.0   ? Joint::revolute_x
                   : link.axis[1] == 1.0   ? Joint::revolute_y
                   : link.axis[2] == 1.0   ? Joint::revolute_z
                                           : Joint::revolute;
      links_.push_back(link);
    }
    if (links_.empty()) throw std::invalid_argument("a tree without links");
    tree_ = {links_.data(), static_cast<std::int32_t>(links_.size()), floating};
  }

  TreeObject(const TreeObject& other) : links_(other.links_), tree_(other.tree_) { tree_.links = links_.data(); }
  TreeObject& operator=(const TreeObject&) = delete;

  const Tree& tree() const { return tree_; }
  std::size_t joints() const { return links_.size() - tree_.first_joint(); }

 private:
  std::vector<Link> links_;
  Tree tree_ = {};
};

// base: (N, 9); position, velocity, acceleration: (N, joints). The columns live as long as this object.
struct BoundMotion {
  std::size_t samples;
  std::vector<Column> columns;
  Motion motion = {};

  BoundMotion(const TreeObject& tree, const Matrix& base, const Matrix& q, const Matrix& v, const Matrix& a)
      : samples(base.shape(0)) {
    plantar::columns(base, samples, motion.base);
    const std::size_t n = tree.joints();
    for (const Matrix* m : {&q, &v, &a}) {
      if (m->shape(0) != samples || m->shape(1) != n) throw std::invalid_argument("an array of the wrong shape");
      for (std::size_t k = 0; k < n; ++k)
        columns.push_back({m->data() + static_cast<std::ptrdiff_t>(k) * m->stride(1), m->stride(0)});
    }
    motion.position = columns.data();
    motion.velocity = columns.data() + n;
    motion.acceleration = columns.data() + 2 * n;
  }
};

inline std::vector<std::uint32_t> kept_masks(const TreeObject& tree, const std::vector<unsigned>& kept) {
  if (kept.size() != static_cast<std::size_t>(tree.tree().n_links)) throw std::invalid_argument("one mask a link");
  return {kept.begin(), kept.end()};
}

}  // namespace plantar
