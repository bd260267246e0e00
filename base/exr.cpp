// Reading and writing float EXR files. Depends on base and OpenEXR.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <exception>

#include "base/error.h"
#include "base/files.h"
#include "base/picture.h"

namespace nephele {
namespace {

// A picture above this many pixels is taken for a damaged header: 16 times the largest that a render may ask
// for.
constexpr int64_t kMostPixels = int64_t{1} << 28;

Imf::Slice sliceOf(std::vector<float>& plane, const Imath::Box2i& window, int width) {
  return Imf::Slice::Make(Imf::FLOAT, plane.data(), window.min, width,
                          static_cast<int>(window.max.y - window.min.y + 1), sizeof(float),
                          sizeof(float) * static_cast<size_t>(width));
}

}  // namespace

size_t Picture::add(const std::string& name) {
  NEPHELE_CHECK_EQ(find(name), -1);
  names.push_back(name);
  planes.emplace_back(static_cast<size_t>(width) * static_cast<size_t>(height), 0.0f);
  return names.size() - 1;
}

int Picture::find(const std::string& name) const {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<int>(i);
  return -1;
}

void writeExr(const std::string& path, const Picture& picture) {
  NEPHELE_CHECK_GT(picture.width, 0);
  NEPHELE_CHECK_GT(picture.height, 0);
  NEPHELE_CHECK_EQ(picture.names.size(), picture.planes.size());
  Imf::Header header(picture.width, picture.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  for (size_t i = 0; i < picture.names.size(); ++i) {
    NEPHELE_CHECK_EQ(picture.planes[i].size(),
                     static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height));
    header.channels().insert(picture.names[i], Imf::Channel(Imf::FLOAT));
    // OpenEXR's frame buffer takes a pointer to non-const in both directions; writing only reads.
    auto& plane = const_cast<std::vector<float>&>(picture.planes[i]);
    buffer.insert(picture.names[i], sliceOf(plane, header.dataWindow(), picture.width));
  }
  writeWhole(path, [&](const std::string& temporary) {
    try {
      Imf::OutputFile file(temporary.c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(picture.height);
    } catch (const std::exception& error) {
      throw WorldError("cannot write '" + path + "': " + error.what());
    }
  });
}

Picture readExr(const std::string& path) {
  // Opening it ourselves tells a missing file from one that is no EXR.
  const std::string magic = readWhole(path).substr(0, 4);
  if (magic != std::string("\x76\x2f\x31\x01", 4)) throw InputError({path}, "is no EXR file");
  try {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1,
                  height = int64_t{window.max.y} - window.min.y + 1;
    if (width <= 0 || height <= 0 || width > kMostPixels / height)
      throw InputError(
          {path}, "has an unreadable size of " + std::to_string(width) + " by " + std::to_string(height));
    Picture picture;
    picture.width = static_cast<int>(width);
    picture.height = static_cast<int>(height);
    const Imf::ChannelList& channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
      if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
        throw InputError({path},
                         std::string("channel '") + channel.name() + "' is subsampled, which is not read");
      picture.add(channel.name());
    }
    Imf::FrameBuffer buffer;
    for (size_t i = 0; i < picture.names.size(); ++i)
      buffer.insert(picture.names[i], sliceOf(picture.planes[i], window, picture.width));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return picture;
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError({path}, std::string("cannot be read as EXR: ") + error.what());
  }
}

}  // namespace nephele
