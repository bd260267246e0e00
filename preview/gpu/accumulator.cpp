// Cutting pictures into short draws. Depends on gpu/march_pass.h.
#include "preview/gpu/accumulator.h"

#include <algorithm>
#include <chrono>

#include "preview/gpu/sub_pixels.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int64_t kFirstPiecePixels = 8192;
// Pieces end on multiples of these: drivers shade whole blocks of pixels, seen or not, and share tiles of
// 64 x 64 out to threads, so that a smaller piece would keep one thread busy.
constexpr int kBlockWidth = 128, kBlockHeight = 32;
constexpr int64_t kBlockPixels = int64_t{kBlockWidth} * kBlockHeight;
constexpr double kPieceSeconds = 0.05;  // watchdogs wait a second or more; a hand feels a tenth
constexpr double kMostGrowth = 4.0;  // from one piece to the next: empty sky may be followed by dense cloud

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Accumulator::Accumulator(int width, int height, unsigned samples, unsigned seed, float pixelEdge)
    : width_(width),
      height_(height),
      samples_(samples),
      seed_(seed),
      pixelEdge_(pixelEdge),
      piecePixels_(kFirstPiecePixels) {}

PixelRectangle Accumulator::next() const {
  if (x_ > 0 || piecePixels_ < int64_t{width_} * kBlockHeight) {
    const int64_t blocks = std::max<int64_t>(1, piecePixels_ / kBlockPixels);
    return {x_, y_, static_cast<int>(std::min<int64_t>(blocks * kBlockWidth, width_ - x_)),
            std::min(kBlockHeight, height_ - y_)};
  }
  const int64_t rows = piecePixels_ / (int64_t{width_} * kBlockHeight) * kBlockHeight;
  return {0, y_, width_, static_cast<int>(std::min<int64_t>(rows, height_ - y_))};
}

void Accumulator::moveOn(const PixelRectangle& drawn) {
  x_ = drawn.x + drawn.width;
  if (x_ < width_) return;
  x_ = 0;
  y_ += drawn.height;
  if (y_ < height_) return;
  y_ = 0;
  ++sample_;
}

bool Accumulator::advance(MarchPass& pass, const BrickAtlas& atlas, const Film& film, double seconds,
                          unsigned until) {
  const auto start = Clock::now();
  while (!done() && sample_ < until) {
    const PixelRectangle piece = next();
    const auto pieceStart = Clock::now();
    pass.draw(atlas, film, pixelEdge_ * subPixelOffset(sample_, seed_), sample_, piece);
    finishGl("marching");
    // 1e-6 s: a clock may stand still over an empty piece.
    const double growth = kPieceSeconds / std::max(secondsSince(pieceStart), 1e-6);
    const double pixels =
        static_cast<double>(int64_t{piece.width} * piece.height) * std::min(growth, kMostGrowth);
    piecePixels_ = std::max(kBlockPixels, static_cast<int64_t>(pixels));
    moveOn(piece);
    if (secondsSince(start) >= seconds) break;
  }
  return !done();
}

uint64_t Accumulator::pixelsDone() const {
  const int64_t band =
      std::min(kBlockHeight, height_ - y_);  // the rows of a piece that does not fill the width
  return static_cast<uint64_t>((int64_t{sample_} * height_ + y_) * width_ + x_ * band);
}

uint64_t Accumulator::pixelsTotal() const {
  return uint64_t{samples_} * static_cast<uint64_t>(width_) * static_cast<uint64_t>(height_);
}

}  // namespace nephele
