// Fronts of bakes, and which joint settings may be on one. Depends on cost_chart.h, base.
#include <algorithm>
#include <map>

#include "bake/cost_chart.h"
#include "base/front.h"

namespace nephele {
namespace {

constexpr std::pair<CostError, CostKind> kFronts[] = {
    {CostError::depth, CostKind::file},      {CostError::depth, CostKind::seconds},
    {CostError::depth, CostKind::memory},    {CostError::density, CostKind::file},
    {CostError::density, CostKind::seconds}, {CostError::density, CostKind::memory}};

/// `setting` with one kind of setting as in `other`.
void takeFrom(const CostPoint& other, Asset& setting) {
  if (other.sweep == "octaves") setting.mostOctaves = other.look.mostOctaves;
  if (other.sweep == "precision") setting.precision = other.look.precision;
  if (other.sweep == "density step") setting.densityStep = other.look.densityStep;
  if (other.sweep == "cutoff") setting.cutoff = other.look.cutoff;
}

/// What `to` costs over what `from` does.
double ratio(double to, double from) { return from > 0.0 ? to / from : 1.0; }

/// Costs multiply, errors add, as if the kinds had nothing to do with each other.
CostPoint with(const CostPoint& at, const CostPoint& change, const CostPoint& base) {
  CostPoint joint = at;
  joint.sweep = "joint";
  takeFrom(change, joint.look);
  joint.seconds *= ratio(change.seconds, base.seconds);
  joint.fileBytes = uint64_t(double(at.fileBytes) * ratio(double(change.fileBytes), double(base.fileBytes)));
  joint.gridBytes = uint64_t(double(at.gridBytes) * ratio(double(change.gridBytes), double(base.gridBytes)));
  joint.depthLargest = std::max(0.0, at.depthLargest + change.depthLargest - base.depthLargest);
  joint.densityRmse = std::max(0.0, at.densityRmse + change.densityRmse - base.densityRmse);
  return joint;
}

/// Whether the points hold the setting.
bool isMeasured(const std::vector<CostPoint>& points, const Asset& look) {
  return std::any_of(points.begin(), points.end(), [&](const CostPoint& p) {
    return p.look.voxelSize == look.voxelSize && p.look.precision == look.precision &&
           p.look.mostOctaves == look.mostOctaves && p.look.cutoff == look.cutoff &&
           p.look.densityStep == look.densityStep;
  });
}

}  // namespace

double costOf(const CostPoint& point, CostKind kind) {
  return kind == CostKind::file      ? double(point.fileBytes)
         : kind == CostKind::seconds ? point.seconds
                                     : double(point.gridBytes);
}

double errorOf(const CostPoint& point, CostError error) {
  return error == CostError::depth ? point.depthLargest : point.densityRmse;
}

std::vector<CostFront> costFronts(const std::vector<CostPoint>& points) {
  std::vector<CostFront> fronts;
  for (const auto& [error, cost] : kFronts) {
    std::vector<CostAndError> costs;
    std::vector<size_t> places;
    for (size_t i = 0; i < points.size(); ++i) {
      // A bake that misses all of the depth somewhere is cheap, and worth nothing.
      if (points[i].depthLargest >= 1.0) continue;
      costs.push_back({costOf(points[i], cost), errorOf(points[i], error)});
      places.push_back(i);
    }
    CostFront front{error, cost, paretoFront(costs, kWorthNaming), 0};
    front.knee = kneeOf(costs, front.points);
    for (size_t& point : front.points) point = places[point];
    fronts.push_back(front);
  }
  return fronts;
}

std::vector<CostPoint> jointSettings(const std::vector<CostPoint>& points) {
  if (points.empty()) return {};
  const CostPoint& base = points.front();
  // Each kind's changes at the finest voxels, and none of them.
  std::map<std::string, std::vector<const CostPoint*>> changes;
  for (const CostPoint& p : points)
    if (p.sweep != base.sweep && p.look.voxelSize == base.look.voxelSize) changes[p.sweep].push_back(&p);
  std::vector<CostPoint> expected;
  for (const CostPoint& p : points)
    if (p.sweep == base.sweep) expected.push_back(p);
  for (const auto& kind : changes) {
    const size_t before = expected.size();
    for (size_t n = 0; n < before; ++n)
      for (const CostPoint* change : kind.second) expected.push_back(with(expected[n], *change, base));
  }
  std::erase_if(expected, [&](const CostPoint& p) { return isMeasured(points, p.look); });
  std::vector<CostPoint> all = points;
  all.insert(all.end(), expected.begin(), expected.end());
  std::map<size_t, int> fronts;  // on how many each is
  for (const CostFront& front : costFronts(all))
    for (const size_t i : front.points)
      if (i >= points.size()) ++fronts[i];
  std::vector<std::pair<int, size_t>> order;
  for (const auto& [i, count] : fronts) order.emplace_back(-count, i);
  std::sort(order.begin(), order.end());
  std::vector<CostPoint> joint;
  for (const auto& one : order) joint.push_back(all[one.second]);
  return joint;
}

}  // namespace nephele
