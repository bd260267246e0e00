// A tree of boxes over numbered items, so that a query looks only at what is near. Depends on field.h.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/fields/field.h"

namespace nephele {

/// Immutable once built; queries may run on any number of threads. The same boxes give the same tree.
class BoxTree {
 public:
  /// Over items 0 … boxes.size() − 1. No boxes give a tree that finds nothing.
  explicit BoxTree(const std::vector<Box>& boxes);

  /// Calls visit(item) for every item all of whose enclosing boxes pass enter(box), in a fixed order. The
  /// item's own box is not asked for.
  template <class Enter, class Visit>
  void forEach(const Enter& enter, const Visit& visit) const;

  /// min(best, least measure(item, best so far)). `bound(box)` is at most the measure of every item in the
  /// box; where it reaches what is known already, the box is passed over.
  template <class Bound, class Measure>
  double least(double best, const Bound& bound, const Measure& measure) const;

 private:
  /// Leaves hold items_[first, first + count); the others (count 0) children nodes_[first], nodes_[first+1].
  struct Node {
    Box box;
    uint32_t first = 0, count = 0;
  };
  // Halving 2^32 items down to leaves of 4 takes 30 steps, each of which leaves one node behind.
  static constexpr int kStack = 64;

  void split(uint32_t node, uint32_t from, uint32_t to, const std::vector<Box>& boxes);

  std::vector<Node> nodes_;
  std::vector<uint32_t> items_;
};

template <class Enter, class Visit>
void BoxTree::forEach(const Enter& enter, const Visit& visit) const {
  if (nodes_.empty()) return;
  uint32_t stack[kStack];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!enter(node.box)) continue;
    for (uint32_t n = 0; n < node.count; ++n) visit(items_[node.first + n]);
    if (node.count > 0) continue;
    stack[depth++] = node.first + 1;
    stack[depth++] = node.first;
  }
}

template <class Bound, class Measure>
double BoxTree::least(double best, const Bound& bound, const Measure& measure) const {
  if (nodes_.empty()) return best;
  struct Waiting {
    uint32_t node;
    double bound;
  };
  Waiting stack[kStack];
  int depth = 0;
  stack[depth++] = {0, bound(nodes_.front().box)};
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (next.bound >= best) continue;
    const Node& node = nodes_[next.node];
    for (uint32_t n = 0; n < node.count; ++n) best = std::min(best, measure(items_[node.first + n], best));
    if (node.count > 0) continue;
    const Waiting a{node.first, bound(nodes_[node.first].box)},
        b{node.first + 1, bound(nodes_[node.first + 1].box)};
    // The nearer one is looked at first: it is likely to settle the other.
    stack[depth++] = a.bound <= b.bound ? b : a;
    stack[depth++] = a.bound <= b.bound ? a : b;
  }
  return best;
}

}  // namespace nephele
