// What moves in an asset, and what its loop asks of that. Depends on pipeline_loop.h.
#include "bake/pipeline_loop.h"

#include <set>
#include <tuple>
#include <utility>

namespace nephele {
namespace {

/// Every field of a spec once, however often it is shared.
template <class Visit>
void forEachSpec(const FieldSpec& spec, std::set<const FieldSpec*>& seen, const Visit& visit) {
  if (!seen.insert(&spec).second) return;
  visit(spec);
  for (const auto& [name, children] : spec.children)
    for (const FieldSpecPtr& child : children) forEachSpec(*child, seen, visit);
}

struct PlaceOrder {
  bool operator()(const SourceLocation& a, const SourceLocation& b) const {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  }
};

/// The asset's own fields that move, with their motion.
std::vector<std::pair<const FieldSpec*, Motion>> motionsOf(const Asset& asset) {
  std::vector<std::pair<const FieldSpec*, Motion>> list;
  std::set<const FieldSpec*> seen;
  const auto take = [&](const FieldSpec& spec) {
    if (spec.row->motion) list.emplace_back(&spec, spec.row->motion(Arguments(spec.values)));
  };
  if (asset.density) forEachSpec(*asset.density, seen, take);
  // Components of one curl move alike: the first stands for all.
  std::set<SourceLocation, PlaceOrder> places;
  for (const FieldSpecPtr& component : asset.velocityFields)
    if (component)
      forEachSpec(*component, seen, [&](const FieldSpec& spec) {
        if (places.insert(spec.where).second) take(spec);
      });
  return list;
}

}  // namespace

Loop loopOf(const Asset& asset, int64_t frame) { return {*asset.loopFrames, frame, asset.fps}; }

void checkLoop(const Asset& asset, Diagnostics& out) {
  if (!asset.loopFrames) return;
  for (const auto& [spec, motion] : motionsOf(asset))
    for (const auto& [parameter, sentence] : loopComplaints(motion, loopOf(asset, 0))) {
      const auto place = spec->places.find(parameter);
      out.add(place == spec->places.end() ? spec->where : place->second, sentence);
    }
}

std::vector<LoopNote> loopNotesOf(const Asset& asset) {
  std::vector<LoopNote> notes;
  if (!asset.loopFrames) return notes;
  for (const auto& [spec, motion] : motionsOf(asset))
    for (LoopNote& note : loopNotes(motion, loopOf(asset, 0), spec->row->name))
      notes.push_back(std::move(note));
  return notes;
}

}  // namespace nephele
