// Point grids through OpenVDB. Depends on vdb_file.h, OpenVDB.
#include "volume/points.h"

#include <openvdb/openvdb.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointDataGrid.h>

#include "base/error.h"
#include "volume/vdb_file.h"

namespace nephele {
namespace {

namespace points = openvdb::points;
using openvdb::Vec3s;

/// What an attribute is called among columns: its own name, but for the two that have customs of their own.
std::string columnOf(const std::string& attribute) {
  if (attribute == "pscale") return "radius";
  return attribute == "vel" ? "v" : attribute;
}

void readLeaf(const points::PointDataTree::LeafNodeType& leaf, const openvdb::math::Transform& transform,
              PointColumns& columns) {
  const points::AttributeHandle<Vec3s> places(leaf.constAttributeArray("P"));
  for (auto index = leaf.beginIndexOn(); index; ++index) {
    const openvdb::Vec3d at =
        transform.indexToWorld(openvdb::Vec3d(places.get(*index)) + index.getCoord().asVec3d());
    columns["x"].push_back(float(at.x()));
    columns["y"].push_back(float(at.y()));
    columns["z"].push_back(float(at.z()));
  }
  for (const auto& [name, position] : leaf.attributeSet().descriptor().map()) {
    const points::AttributeArray& array = leaf.constAttributeArray(position);
    const std::string column = columnOf(name);
    if (column == "P") continue;
    if (array.hasValueType<float>()) {
      const points::AttributeHandle<float> values(array);
      for (auto index = leaf.beginIndexOn(); index; ++index) columns[column].push_back(values.get(*index));
    } else if (array.hasValueType<Vec3s>() && column == "v") {
      const points::AttributeHandle<Vec3s> values(array);
      for (auto index = leaf.beginIndexOn(); index; ++index)
        for (int axis = 0; axis < 3; ++axis)
          columns[std::string("v") + "xyz"[axis]].push_back(values.get(*index)[axis]);
    }
  }
}

template <class T>
void addAttribute(points::PointDataGrid& grid, const openvdb::tools::PointIndexGrid& order,
                  const std::string& name, const std::vector<T>& values) {
  points::appendAttribute<T>(grid.tree(), name);
  const points::PointAttributeVector<T> wrapped(values);
  points::populateAttribute(grid.tree(), order.tree(), name, wrapped);
}

}  // namespace

PointColumns readVdbPoints(const std::string& path) {
  const VdbContents contents = readVdb(path);
  PointColumns columns{{"x", {}}, {"y", {}}, {"z", {}}};
  bool any = false;
  for (const auto& base : *contents.grids) {
    const auto grid = openvdb::gridPtrCast<points::PointDataGrid>(base);
    if (!grid) continue;
    any = true;
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) readLeaf(*leaf, grid->transform(), columns);
  }
  if (!any) throw InputError({path}, "holds no grid of points");
  // A column that only some of the grids have says nothing about the rest.
  const size_t count = columns["x"].size();
  std::erase_if(columns, [count](const auto& column) { return column.second.size() != count; });
  return columns;
}

void writeVdbPoints(const std::string& path, const PointColumns& columns) {
  initializeOpenVdb();
  const auto& x = columns.at("x");
  std::vector<Vec3s> places;
  for (size_t n = 0; n < x.size(); ++n) places.emplace_back(x[n], columns.at("y")[n], columns.at("z")[n]);
  const points::PointAttributeVector<Vec3s> wrapped(places);
  constexpr int kPointsPerVoxel = 8;
  const double size = places.empty() ? 1.0 : double(points::computeVoxelSize(wrapped, kPointsPerVoxel));
  const auto transform = openvdb::math::Transform::createLinearTransform(size);
  const auto order =
      openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(wrapped, *transform);
  const auto grid =
      points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*order, wrapped, *transform);
  grid->setName("points");
  std::vector<Vec3s> velocities;
  if (!places.empty())
    for (const auto& [name, values] : columns) {
      if (name == "x" || name == "y" || name == "z" || name == "vy" || name == "vz" || values.empty())
        continue;
      if (name == "vx") {
        for (size_t n = 0; n < x.size(); ++n)
          velocities.emplace_back(values[n], columns.at("vy")[n], columns.at("vz")[n]);
        addAttribute(*grid, *order, "v", velocities);
      } else {
        addAttribute(*grid, *order, name == "radius" ? "pscale" : name, values);
      }
    }
  writeVdb(path, {grid}, Provenance{});
}

}  // namespace nephele
