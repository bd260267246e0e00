// Small pictures made ready for a larger window. Depends on gpu/film.h and gpu/shader.h.
#pragma once

#include "preview/gpu/film.h"
#include "preview/gpu/shader.h"

namespace nephele {

/// The pass of shaders/sharpen.frag: compiled when made.
class SharpenPass {
 public:
  SharpenPass();
  /// Writes `from` into `to`, of the same size and cleared before, so that linear mixing between the pixels
  /// of `to` comes nearer to the large picture. Sums stay sums of as many samples; depth and costs are
  /// copied.
  void draw(const Film& from, const Film& to) const;

 private:
  GlProgram program_;
  GlVertexArray noVertices_;
};

}  // namespace nephele
