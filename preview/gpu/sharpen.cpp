// Drawing one film into another. Depends on what its header names.
#include "preview/gpu/sharpen.h"

#include "base/error.h"

namespace nephele {

SharpenPass::SharpenPass()
    : program_(buildProgram("screen.vert", "sharpen.frag")), noVertices_(makeVertexArray()) {}

void SharpenPass::draw(const Film& from, const Film& to) const {
  NEPHELE_CHECK_EQ(from.width(), to.width());
  NEPHELE_CHECK_EQ(from.height(), to.height());
  to.bindAsTarget();
  from.bindForDisplay();
  glUseProgram(program_.name());
  glBindVertexArray(noVertices_.name());
  constexpr GLsizei kTriangleCorners = 3;
  glDrawArrays(GL_TRIANGLES, 0, kTriangleCorners);
  glDisable(GL_BLEND);
}

}  // namespace nephele
