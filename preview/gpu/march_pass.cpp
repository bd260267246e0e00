// Binding and drawing the march. Depends on what its header names.
#include "preview/gpu/march_pass.h"

namespace nephele {
namespace {

// Locations and bindings as shaders/march.frag declares them.
constexpr GLuint kParameterBinding = 0;
constexpr GLint kSubPixelLocation = 0, kSampleNumberLocation = 1, kTexelSizeLocation = 2, kSliceLocation = 3;
constexpr int kTriangleCorners = 3;

std::vector<std::string> definesFor(Filter filter, MarchWrites writes) {
  return {filter == Filter::exact ? "NPH_FILTER_EXACT 1" : "NPH_FILTER_EXACT 0",
          "NPH_VIEW " + std::to_string(static_cast<int>(writes))};
}

}  // namespace

MarchPass::MarchPass(Filter filter, const std::vector<TextChange>& changes, MarchWrites writes)
    : filter_(filter),
      program_(buildProgram("screen.vert", "march.frag", definesFor(filter, writes), changes)),
      parameters_(makeBuffer()),
      noVertices_(makeVertexArray()) {
  glNamedBufferStorage(parameters_.name(), sizeof(shared::MarchParameters), nullptr, GL_DYNAMIC_STORAGE_BIT);
  checkGl("making the parameter buffer");
}

void MarchPass::setParameters(const shared::MarchParameters& parameters) {
  glNamedBufferSubData(parameters_.name(), 0, sizeof parameters, &parameters);
}

void MarchPass::setSlice(int axis, float place) {
  glProgramUniform2f(program_.name(), kSliceLocation, static_cast<float>(axis), place);
}

void MarchPass::draw(const BrickAtlas& atlas, const Film& film, glm::vec2 subPixel, unsigned number,
                     const PixelRectangle& where) const {
  film.bindAsTarget();
  atlas.bind();
  sky_.bind();
  glUseProgram(program_.name());
  glBindVertexArray(noVertices_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kParameterBinding, parameters_.name());
  glUniform2f(kSubPixelLocation, subPixel.x, subPixel.y);
  glUniform1ui(kSampleNumberLocation, number);
  const glm::vec3 texel = 1.0f / glm::vec3(atlas.sizeTexels());
  if (filter_ == Filter::hardware) glUniform3f(kTexelSizeLocation, texel.x, texel.y, texel.z);
  glEnable(GL_SCISSOR_TEST);
  glScissor(where.x, where.y, where.width, where.height);
  glDrawArrays(GL_TRIANGLES, 0, kTriangleCorners);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

}  // namespace nephele
