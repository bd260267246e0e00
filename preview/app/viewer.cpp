// Lanes, volume and display pass of the window. Depends on gpu, scene and volume/bricks.h.
#include "preview/app/viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "preview/behind.h"
#include "preview/gpu/camera_rays.h"

namespace nephele {
namespace {

// As shaders/display.frag declares them.
enum DisplayLocation : GLint { kBottom = 0, kTop = 1, kWindowSize = 3, kExposure = 4, kScale = 7 };
constexpr GLuint kParameterBinding = 0;

void setRgb(GLint location, const Rgb& rgb) {
  glUniform3f(location, static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]));
}

}  // namespace

Viewer::Viewer(Filter filter, unsigned seed, uint64_t vramBytes)
    : filter_(filter), seed_(seed), limits_{vramBytes, 0}, noVertices_(makeVertexArray()) {
  for (GlBuffer& parameters : displayParameters_) {
    parameters = makeBuffer();
    glNamedBufferStorage(parameters.name(), sizeof(shared::MarchParameters), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  checkGl("making the display's parameters");
  passFor(View::radiance);
}

void Viewer::setVolume(std::shared_ptr<const BrickVolume> bricks) {
  seen_.reset();  // two volumes at once may be more than the GPU holds
  std::optional<BrickAtlas> live = std::exchange(live_, std::nullopt);
  std::swap(bricks_, bricks);
  try {
    seen_.emplace(*bricks_, filter_, limits_, true);
    if (lanes_[0]) toolsFor(*lanes_[0], false);
  } catch (const std::exception&) {
    std::swap(bricks_, bricks);
    seen_.reset();
    if (live) live_.emplace(std::move(*live));
    if (bricks_) seen_.emplace(*bricks_, filter_, limits_, true);
    throw;
  }
}

void Viewer::setLiveVolume(std::shared_ptr<const BrickVolume> bricks) {
  BrickAtlas atlas(*bricks, filter_, Texel::r32f);
  seen_.reset();
  live_.reset();
  live_.emplace(std::move(atlas));
  bricks_ = std::move(bricks);
}

void Viewer::endSplit() {
  lanes_[1].reset();
  if (seen_) seen_->forget(1);
}

MarchPass& Viewer::passFor(View view) {
  const MarchWrites writes = rowOf(view).writes;
  auto& pass = passes_[static_cast<size_t>(writes)];
  if (!pass) pass.emplace(filter_, std::vector<TextChange>{}, writes);
  return *pass;
}

const GlProgram& Viewer::displayFor(const LaneRequest& request, const Scene& shown) {
  const bool radiance = request.show == View::radiance;
  // Behind other views stands nothing, so that they share a program.
  const Behind behind = radiance ? behindOf(shown) : Behind::nothing;
  const bool map = behind == Behind::sky && shown.environment.kind == Environment::Kind::exr;
  GlProgram& built = displays_[{request.show, behind, map}];
  if (built.name() == 0)
    built = buildProgram("screen.vert", "display.frag",
                         {"NPH_SHOWN " + std::to_string(static_cast<int>(request.show)),
                          "NPH_BEHIND " + std::to_string(static_cast<int>(behind)),
                          std::string("NPH_MAP ") + (map ? "true" : "false")});
  return built;
}

LaneTools Viewer::toolsFor(const Lane& lane, bool moving) {
  const LaneRequest& r = lane.request();
  const size_t which = lanes_[1] && &lane == &*lanes_[1] ? 1 : 0;
  const BrickAtlas& atlas = live_ ? *live_ : seen_->atlasFor(which, r.view, r.width, r.height, moving);
  MarchPass& pass = passFor(r.show);
  if (r.show == View::slice) pass.setSlice(r.slice.axis, slicePlace(r.slice, *bricks_, atlas.layout().frame));
  pass.setEnvironment(r.view.environmentMap);
  pass.useCache(which);
  if (!sharpen_) sharpen_.emplace();
  return {*bricks_, atlas, pass, *sharpen_, seed_};
}

void Viewer::restart(Side side, const LaneRequest& request) {
  auto& lane = lanes_[static_cast<size_t>(side)];
  if (!lane) lane.emplace();
  lane->restart(request);
}

bool Viewer::work(double seconds) {
  bool drawn = false;
  for (size_t i = 0; i < lanes_.size(); ++i) {
    auto& lane = lanes_[i];
    if (!lane || !lane->quickNeeded()) continue;
    const LaneRequest& r = lane->request();
    const shared::MarchParameters parameters =
        marchParameters(r.view, *bricks_, r.width, r.height, seed_, true);
    glNamedBufferSubData(displayParameters_[i].name(), 0, sizeof parameters, &parameters);
    lane->drawQuick(toolsFor(*lane, true));
    drawn = true;
  }
  if (drawn) return true;
  // The side that has fewer samples goes on, so that both get better together.
  Lane* next = nullptr;
  for (auto& lane : lanes_) {
    if (lane && lane->unfinished() && (next == nullptr || lane->stats().samples < next->stats().samples))
      next = &*lane;
  }
  if (next == nullptr) return false;
  next->work(toolsFor(*next, false), seconds, goal_);
  return std::any_of(lanes_.begin(), lanes_.end(),
                     [](const auto& lane) { return lane && lane->unfinished(); });
}

void Viewer::showSide(size_t side, const Shown& shown, const Screen& screen) {
  const Lane& lane = *lanes_[side];
  const Film* film = lane.best();
  if (film == nullptr) return;
  MarchPass& pass = passFor(View::radiance);  // it holds the sky
  pass.setEnvironment(lane.request().view.environmentMap);
  pass.useCache(lanes_[1] && &lane == &*lanes_[1] ? 1 : 0);
  pass.bindEnvironment();
  glBindBufferBase(GL_UNIFORM_BUFFER, kParameterBinding, displayParameters_[side].name());
  film->bindForDisplay();
  glUseProgram(displayFor(lane.request(), shown.scene).name());
  glBindVertexArray(noVertices_.name());
  const BackdropColours colours = shown.scene.backdrop.value_or(BackdropColours{});
  setRgb(kBottom, colours.bottom);
  setRgb(kTop, colours.top);
  glUniform2f(kWindowSize, static_cast<float>(screen.width), static_cast<float>(screen.height));
  glUniform1f(kExposure, static_cast<float>(std::exp2(shown.exposureEv)));
  glUniform1f(kScale, static_cast<float>(lane.stats().scale));
  constexpr GLsizei kTriangleCorners = 3;
  glDrawArrays(GL_TRIANGLES, 0, kTriangleCorners);
}

void Viewer::show(const Screen& screen, const std::array<Shown, kSideCount>& shown) {
  glBindFramebuffer(GL_FRAMEBUFFER, screen.framebuffer);
  glViewport(0, 0, screen.width, screen.height);
  const int column = static_cast<int>(std::lround(screen.divider * screen.width));
  glEnable(GL_SCISSOR_TEST);
  for (size_t i = 0; i < lanes_.size(); ++i) {
    const bool left = i == static_cast<size_t>(Side::kept);
    if (!lanes_[i]) continue;
    if (left)
      glScissor(0, 0, column, screen.height);
    else
      glScissor(column, 0, screen.width - column, screen.height);
    showSide(i, shown[i], screen);
  }
  glDisable(GL_SCISSOR_TEST);
  checkGl("showing the picture");
}

Picture Viewer::read() const {
  const Film* film = lanes_[0] ? lanes_[0]->best() : nullptr;
  return film != nullptr ? film->read().picture : Film(1, 1).read().picture;
}

double Viewer::depthAt(double x, double y) const {
  const Film* film = lanes_[0] ? lanes_[0]->best() : nullptr;
  if (film == nullptr || !(x >= 0.0 && x < 1.0 && y >= 0.0 && y < 1.0)) return 0.0;
  return film->depthAt(static_cast<int>(x * film->width()), static_cast<int>(y * film->height()));
}

LaneStats Viewer::stats(Side side) const {
  const auto& lane = lanes_[static_cast<size_t>(side)];
  return lane ? lane->stats() : LaneStats{};
}

uint64_t Viewer::volumeBytes() const {
  uint64_t bytes = (seen_ ? seen_->gpuBytes() : 0) + (live_ ? live_->gpuBytes() : 0);
  for (const auto& pass : passes_) bytes += pass ? pass->gpuBytes() : 0;
  return bytes;
}

uint64_t Viewer::gpuBytes() const {
  uint64_t bytes = volumeBytes();
  for (const auto& lane : lanes_) bytes += lane ? lane->gpuBytes() : 0;
  return bytes;
}

}  // namespace nephele
