// Files of points: both ways, and what is refused with its line.
#include "particles/point_file.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

PointSet some() {
  PointSet p;
  p.x = {0.1f, 2.0f, -3.25f};
  p.y = {1e-7f, 5.0f, 6.0f};
  p.z = {7.0f, 8.0f, 1e8f};
  p.vx = p.vy = p.vz = {1.0f, 0.0f, -1.0f / 3.0f};
  p.radius = {0.1f, 0.2f, 0.3f};
  return p;
}

void expectSame(const PointSet& a, const PointSet& b) {
  for (const PointSet::Column& column : PointSet::columns())
    EXPECT_EQ(a.*column.values, b.*column.values) << column.name;
}

TEST(PointFile, ComesBackAsItWasWritten) {
  const ScratchFolder folder;
  writePointCsv(folder.file("a.csv"), some());
  writePointPly(folder.file("a.ply"), some());
  expectSame(readPointFile(folder.file("a.csv")), some());
  expectSame(readPointFile(folder.file("a.ply")), some());
  writePointCsv(folder.file("none.csv"), {});
  EXPECT_EQ(readPointFile(folder.file("none.csv")).size(), 0u);
}

TEST(PointFile, ReadsAsciiPlyAndOtherColumns) {
  const PointSet p = parsePointPly(
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty double y\n"
      "property uchar red\nproperty float z\nend_header\n1 2 255 3\n4 5 0 6\n",
      "p.ply");
  EXPECT_EQ(p.z, (std::vector<float>{3.0f, 6.0f}));
  EXPECT_EQ(parsePointCsv("z, name ,x,y\r\n1,a,2,3\r\n", "p.csv").x, std::vector<float>{2.0f});
}

void expectRefusal(const std::string& csv, const std::string& sentence) {
  try {
    parsePointCsv(csv, "p.csv");
    ADD_FAILURE() << "accepted; expected: " << sentence;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
  }
}

TEST(PointFile, RefusesWithTheLine) {
  expectRefusal("x,z\n1,2\n", "p.csv:1: error: has no column 'y'");
  expectRefusal("", "p.csv:1: error: has no column 'x'");
  expectRefusal("x,y,z\n1,2,3\n1,2\n", "p.csv:3: error: has 2 columns where the first line names 3");
  expectRefusal("x,y,z\n1,two,3\n", "p.csv:2: error: column 'y' has 'two'");
  expectRefusal("x,y,z\n1,nan,3\n", "p.csv:2: error: point 0 has the y nan");
  expectRefusal("x,y,z\n1,2,3\n1,2,1e30\n", "p.csv:3: error: point 1 has the z 1e+30");
  expectRefusal("x,y,z\n1,2,1e300\n", "p.csv:2: error: point 0 has the z inf");
  expectRefusal("x,y,z,radius\n1,2,3,0\n", "p.csv:2: error: point 0 has the radius 0");
  expectRefusal("x,y,z,life\n1,2,3,-1\n", "p.csv:2: error: point 0 has the life -1");
  expectRefusal("x,y,z,vx\n1,2,3,0\n", "p.csv:1: error: has no column 'vy'");
  expectRefusal("x,x,y,z\n1,2,3,4\n", "p.csv:1: error: names the column 'x' twice");
  expectRefusal("x,y,z,name,name,life,life\n1,2,3,a,b,1,1\n",
                "p.csv:1: error: names the column 'life' twice");
  expectRefusal("x,y,z\n1,2,3\n\n1,2,3\n", "p.csv:3: error: is an empty line");
  const ScratchFolder folder;
  writePointPly(folder.file("a.ply"), some());
  std::ifstream in(folder.file("a.ply"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THROW(parsePointPly(whole.substr(0, whole.size() - 1), "p.ply"), InputError);
}

}  // namespace
}  // namespace nephele
