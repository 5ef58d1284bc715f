// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "io/byte_cursor.hpp"
#include "io/exr_layout.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/read_file.hpp"

namespace tofsmith {
namespace {

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::byte> content, const char* file)
      : Imf::IStream(file), content_(content) {}

  bool read(char into[], int count) override {
    const auto wanted = static_cast<std::uint64_t>(std::max(count, 0));
    if (position_ > content_.size() || content_.size() - position_ < wanted)
      throw IoError(fmt::format("{}: byte {}", fileName(), content_.size()),
                    "the file ends here; expected more of the image");
    std::memcpy(into, content_.data() + position_, wanted);
    position_ += wanted;
    return position_ < content_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> content_;
  std::uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("EXR image") {}

  void write(const char from[], int count) override {
    const auto bytes = static_cast<std::uint64_t>(std::max(count, 0));
    content.resize(std::max<std::uint64_t>(content.size(), position_ + bytes));
    std::memcpy(content.data() + position_, from, bytes);
    position_ += bytes;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::vector<std::byte> content;

 private:
  std::uint64_t position_ = 0;
};

ExrPlanes read_planes(Imf::InputFile& input) {
  const Imath::Box2i window = input.header().dataWindow();
  ExrPlanes planes;
  Imf::FrameBuffer frame;
  const Imf::ChannelList& channels = input.header().channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    Image<float>& plane = planes[channel.name()] =
        Image<float>(window.max.y - window.min.y + 1, window.max.x - window.min.x + 1);
    frame.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, plane.pixels.data(), window));
  }
  input.setFrameBuffer(frame);
  input.readPixels(window.min.y, window.max.y);
  return planes;
}

void check(const ExrPlanes& planes) {
  require(!planes.empty(), "planes", "{}", "must have at least one");
  const Image<float>& first = planes.begin()->second;
  for (const auto& [name, plane] : planes) {
    require(!name.empty(), "channel name", "''", "must not be empty");
    require(plane.height >= 1 && plane.width >= 1, name,
            fmt::format("{} x {}", plane.height, plane.width), "must have pixels");
    require(
        plane.height == first.height && plane.width == first.width, name,
        fmt::format("{} x {}", plane.height, plane.width),
        fmt::format("must be as large as the other planes, {} x {}", first.height, first.width));
  }
}

}  // namespace

ExrPlanes parse_exr(std::span<const std::byte> content, std::string_view file) {
  check_exr_layout(content, file);
  const std::string name(file);
  try {
    MemoryInput stream(content, name.c_str());
    Imf::InputFile input(stream);
    return read_planes(input);
  } catch (const IoError&) {
    throw;
  } catch (const std::exception& error) {
    throw IoError(file, fmt::format("damaged OpenEXR image: {}", error.what()));
  }
}

ExrPlanes read_exr(const std::filesystem::path& path) {
  return parse_exr(read_binary_file(path), path.string());
}

std::vector<std::byte> serialize_exr(const ExrPlanes& planes) {
  check(planes);
  const Image<float>& first = planes.begin()->second;
  Imf::Header header(first.width, first.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  for (const auto& [name, plane] : planes) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, plane.pixels.data(), header.dataWindow()));
  }
  MemoryOutput stream;
  try {
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(frame);
    output.writePixels(first.height);
  } catch (const std::exception& error) {
    throw IoError("EXR image", error.what());
  }
  return std::move(stream.content);
}

void write_exr(const std::filesystem::path& path, const ExrPlanes& planes, OutputPolicy policy) {
  AtomicFile file(path, policy);
  file.write(serialize_exr(planes));
  file.commit();
}

}  // namespace tofsmith
