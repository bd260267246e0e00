// Points in files: CSV and PLY, read and written. Depends on base alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nephele {

/// Properties of points, one array each. x, y, z have one length; the others that too, or none where the file
/// does not give them.
struct PointSet {
  std::vector<float> x, y, z;
  std::vector<float> vx, vy, vz;  // all three or none
  std::vector<float> radius, density, life, temperature, age;
  std::vector<float> mass;  // density · 4/3 π radius³; written, not read

  size_t size() const { return x.size(); }

  struct Column {
    const char* name;
    std::vector<float> PointSet::*values;
  };
  static const std::vector<Column>& columns();
};

/// Reads a .csv (a line of column names, then a line of numbers a point, separated by commas) or a .ply
/// (element `vertex`, ascii or binary little-endian). x, y, z are needed; vx, vy, vz, radius, density, life,
/// temperature and age are read where they stand, other columns passed over. Throws InputError with file and,
/// in text, line: on what cannot be read, a column that is missing or there twice, a row that is short,
/// numbers that are not finite or beyond 1e9 in size, a radius or life of 0 or less, a density below 0.
PointSet readPointFile(const std::string& path);
PointSet parsePointCsv(const std::string& content, const std::string& path);
PointSet parsePointPly(const std::string& content, const std::string& path);

/// Refuses values as readPointFile() does; `lineOf(n)` is the line of point n, or 0.
void checkPoints(const PointSet& points, const std::string& path, int firstLine);

/// Writes a file that readPointFile() reads back to the same floats, whole or not at all. PLY is binary.
/// Throws WorldError.
void writePointCsv(const std::string& path, const PointSet& points);
void writePointPly(const std::string& path, const PointSet& points);

}  // namespace nephele
