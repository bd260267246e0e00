// Contexts that are lost: whatever a driver that was reset hands out is an error, never a picture.
#include <gtest/gtest.h>

#include <string>

#include "preview/method.h"
#include "preview/resolve.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

GLenum GLAD_API_PTR guilty() { return GL_GUILTY_CONTEXT_RESET; }
GLenum GLAD_API_PTR innocent() { return GL_INNOCENT_CONTEXT_RESET; }

/// Puts `status` in place of the driver's answer while it lives.
class FakeStatus {
 public:
  explicit FakeStatus(PFNGLGETGRAPHICSRESETSTATUSPROC status) : driver_(glad_glGetGraphicsResetStatus) {
    glad_glGetGraphicsResetStatus = status;
  }
  ~FakeStatus() { glad_glGetGraphicsResetStatus = driver_; }
  FakeStatus(const FakeStatus&) = delete;
  FakeStatus& operator=(const FakeStatus&) = delete;

 private:
  PFNGLGETGRAPHICSRESETSTATUSPROC driver_;
};

template <class Act>
std::string sentenceOf(Act&& act) {
  try {
    act();
  } catch (const WorldError& error) {
    return error.what();
  }
  return "no error";
}

TEST(GlContext, TellsOfResetsWhereTheDriverDoes) {
  needContext();
  GLint strategy = 0;
  glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
  if (strategy != GL_LOSE_CONTEXT_ON_RESET) GTEST_SKIP() << "this driver does not tell";
  EXPECT_EQ(glGetGraphicsResetStatus(), GLenum{GL_NO_ERROR});
  EXPECT_NO_THROW(requireKeptContext("drawing"));
}

TEST(GlContext, ALossIsASentence) {
  needContext();
  {
    const FakeStatus fake(guilty);
    const std::string said = sentenceOf([] { requireKeptContext("drawing"); });
    EXPECT_NE(said.find("drawing: the graphics driver ("), std::string::npos) << said;
    EXPECT_NE(said.find("was reset by what was drawn here"), std::string::npos) << said;
  }
  {
    // Whatever else a driver complains of then, the loss is what matters.
    const FakeStatus fake(innocent);
    glBindTexture(0, 0);
    const std::string said = sentenceOf([] { checkGl("drawing"); });
    EXPECT_NE(said.find("was reset by another program"), std::string::npos) << said;
  }
  EXPECT_EQ(sentenceOf([] { checkGl("drawing"); }), "no error");
}

TEST(GlContext, APictureByALostContextIsNone) {
  const BrickVolume bricks =
      volumeOf(glm::ivec3(16), glm::ivec3(-8), glm::dmat4(1.0),
               [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(0.0), 7.0); });
  constexpr int kSize = 16;
  ViewedScene view;
  view.camera = frameCamera(bricks, glm::dvec3(0, 0, 1), 0.6, 1.0);
  view.medium = {{1.5, 1.5, 1.5}, {0.5, 0.5, 0.5}, 0.3};
  PictureRequest request;
  request.width = request.height = kSize;
  request.samples = 1;
  request.quiet = true;
  const std::unique_ptr<Method> method = findMethod("march").make({});
  method->setVolume(bricks);
  PictureCost cost;
  EXPECT_EQ(method->render(view, request, cost).width, kSize);
  const FakeStatus fake(guilty);
  EXPECT_THROW(method->render(view, request, cost), WorldError);
}

}  // namespace
}  // namespace nephele::testing_gl
