#include <cstdint>
#include <limits>
#include <vector>

#include "core/landmarks.h"
#include "core/wire/landmark_part.h"
#include "core/wire/message.h"
#include "tests/core/wire/raw_frame.h"
#include "tests/core/wire/vector_line.h"

namespace facewire::wire {
namespace {

// A face of which every point is where no other is.
Landmarks SomeFace() {
  Landmarks face{.seq = 7,
                 .captured = Time(Duration(2'000'000)),
                 .width_px = 640,
                 .height_px = 480,
                 .presence = 1,
                 .count = kMaxLandmarks};
  for (std::size_t i = 0; i < face.count; ++i) {
    face.points_px[i].x = 100 + static_cast<float>(i) / 8;
    face.points_px[i].y = 50 - static_cast<float>(i) / 4;
  }
  return face;
}

// A frame of landmarks: frame_seq, captured, width and height are 0; then what is given.
Bytes RawPart(const Bytes& rest) {
  return RawFrame(kVersion, 0x16, 0, Bytes(16, std::byte{0}) + rest);
}

}  // namespace

void AddLandmarks(std::vector<Vector>& all) {
  const auto add = [&](const char* name, const char* about, const Message& message) {
    all.push_back({name, about, Line().Send(message)});
  };
  const auto raw = [&](const char* name, const char* about, const Bytes& stream) {
    all.push_back({name, about, stream});
  };
  const Landmarks face = SomeFace();
  add("landmarks", "The second part of a picture's landmarks: 160 bytes on the line",
      PartOf(face, kMaxLandmarksInPart));
  add("landmarks_no_face", "A picture without a face",
      PartOf(Landmarks{.seq = 8, .width_px = 1280, .height_px = 720}, 0));
  Landmarks far = face;
  constexpr float kFar = 1e6F;
  far.seq = std::numeric_limits<std::uint64_t>::max();
  far.captured = Time(Duration(-1));
  far.width_px = 100'000;
  far.points_px[0] = {-kFar, kFar, 0};
  far.points_px[1] = {std::numeric_limits<float>::quiet_NaN(), -0.0625F, 0};
  add("landmarks_extremes",
      "Points beyond what the numbers can tell, one that is none, a picture too wide to tell",
      PartOf(far, 0));
  Line line;
  Bytes picture;
  for (std::size_t first = 0; first < face.count; first += kMaxLandmarksInPart) {
    picture = picture + line.Send(PartOf(face, first));
  }
  raw("landmarks_picture", "All 478 landmarks of one picture, in 15 parts", picture);
  add("command_landmarks", "Landmarks of 30 pictures a second",
      Command{.id = 11, .code = CommandCode::kLandmarks, .value = 30});
  raw("malformed_landmarks_short", "A part that promises two points and holds one and a half",
      RawPart(MakeBytes({9, 0, 0, 0, 2, 1, 0, 2, 0, 3, 0})));
  raw("malformed_landmarks_count", "A part of 33 points",
      RawPart(MakeBytes({99, 0, 0, 0, 33}) + Bytes(132, std::byte{1})));
  raw("malformed_landmarks_total", "A face of 479 landmarks",
      RawPart(MakeBytes({0xDF, 1, 0, 0, 1}) + Bytes(4, std::byte{1})));
  raw("malformed_landmarks_beyond", "Landmarks 3 and 4 of a face that has four",
      RawPart(MakeBytes({4, 0, 3, 0, 2}) + Bytes(8, std::byte{1})));
}

}  // namespace facewire::wire
