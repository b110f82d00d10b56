#include "hal/libcamera/mapped_buffer.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <array>
#include <vector>

#include "hal/posix/unique_fd.h"

namespace facewire::hal::libcamera {
namespace {

using posix::UniqueFd;

// A file whose bytes count up.
UniqueFd Counting(std::size_t bytes) {
  UniqueFd fd(::memfd_create("planes", MFD_CLOEXEC));
  std::vector<std::uint8_t> data(bytes);
  for (std::size_t i = 0; i < bytes; ++i) data[i] = static_cast<std::uint8_t>(i % 251);
  EXPECT_EQ(::pwrite(fd.get(), data.data(), bytes, 0), static_cast<ssize_t>(bytes));
  return fd;
}

PixelLayout Nv12(int width_px, int height_px, unsigned stride_bytes = 0) {
  return *LayOut(PixelFormat::kNv12, width_px, height_px, stride_bytes);
}

TEST(MappedBuffer, APictureInOnePlaneIsSplitByItsLayout) {
  const UniqueFd fd = Counting(std::size_t{8} * 4 * 3 / 2);
  const PlaneExtent plane[] = {{fd.get(), 0, 48}};
  const Result<MappedBuffer> buffer = MappedBuffer::Map(plane);
  ASSERT_TRUE(buffer);
  const Result<ImageView> view = buffer->View(Nv12(8, 4));
  ASSERT_TRUE(view);
  EXPECT_EQ(view->planes[0].data[0], 0);
  EXPECT_EQ(view->planes[1].data[0], 32);
  EXPECT_EQ(view->planes[1].stride_bytes, 8);
}

TEST(MappedBuffer, PlanesOfOneFileAreWhereTheyAreSaidToBe) {
  const UniqueFd fd = Counting(100);
  const PlaneExtent planes[] = {{fd.get(), 0, 32}, {fd.get(), 64, 16}};  // with a gap
  const Result<MappedBuffer> buffer = MappedBuffer::Map(planes);
  ASSERT_TRUE(buffer);
  const Result<ImageView> view = buffer->View(Nv12(8, 4));
  ASSERT_TRUE(view);
  EXPECT_EQ(view->planes[0].data[31], 31);
  EXPECT_EQ(view->planes[1].data[0], 64);
}

TEST(MappedBuffer, PlanesMayLieInFilesOfTheirOwn) {
  const UniqueFd luma = Counting(32);
  const UniqueFd chroma = Counting(16);
  const PlaneExtent planes[] = {{luma.get(), 0, 32}, {chroma.get(), 0, 16}};
  const Result<MappedBuffer> buffer = MappedBuffer::Map(planes);
  ASSERT_TRUE(buffer);
  EXPECT_EQ(buffer->View(Nv12(8, 4))->planes[1].data[3], 3);
}

TEST(MappedBuffer, StaysReadableWhenItIsMoved) {
  const UniqueFd fd = Counting(48);
  const PlaneExtent plane[] = {{fd.get(), 0, 48}};
  MappedBuffer moved = std::move(*MappedBuffer::Map(plane));
  const MappedBuffer again = std::move(moved);
  again.BeginRead();
  EXPECT_EQ(again.plane(0)[47], 47);
  again.EndRead();
}

TEST(MappedBuffer, APictureThatDoesNotFitIsRefused) {
  const UniqueFd fd = Counting(48);
  const PlaneExtent whole[] = {{fd.get(), 0, 48}};
  EXPECT_EQ(MappedBuffer::Map(whole)->View(Nv12(8, 4, 16)).error(), Errc::kUnsupported);
  const PlaneExtent three[] = {{fd.get(), 0, 32}, {fd.get(), 32, 8}, {fd.get(), 40, 8}};
  EXPECT_EQ(MappedBuffer::Map(three)->View(Nv12(8, 4)).error(), Errc::kUnsupported);
  const PlaneExtent small[] = {{fd.get(), 0, 32}, {fd.get(), 32, 8}};
  EXPECT_EQ(MappedBuffer::Map(small)->View(Nv12(8, 4)).error(), Errc::kUnsupported);
}

TEST(MappedBuffer, WhatCannotBeMappedIsAnError) {
  EXPECT_EQ(MappedBuffer::Map({}).error(), Errc::kUnsupported);
  const PlaneExtent none[] = {{-1, 0, 48}};
  EXPECT_EQ(MappedBuffer::Map(none).error(), Errc::kIo);
  const UniqueFd fd = Counting(48);
  const std::array<PlaneExtent, 4> many = {
      {{fd.get(), 0, 8}, {fd.get(), 8, 8}, {fd.get(), 16, 8}, {fd.get(), 24, 8}}};
  EXPECT_EQ(MappedBuffer::Map(many).error(), Errc::kUnsupported);
}

TEST(PlaneBytes, SumUpToTheLayout) {
  const auto layout = LayOut(PixelFormat::kI420, 8, 4, 0);
  ASSERT_EQ(PlaneCount(*layout), 3U);
  EXPECT_EQ(PlaneBytes(*layout, 0), 32U);
  EXPECT_EQ(PlaneBytes(*layout, 1), 8U);
  EXPECT_EQ(PlaneBytes(*layout, 2), 8U);
}

}  // namespace
}  // namespace facewire::hal::libcamera
