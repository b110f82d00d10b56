#include "app/neutral_file.h"

#include <cmath>

#include "app/checked_file.h"
#include "app/error.h"

namespace facewire::app {
namespace {

constexpr FileKind kNeutral = {"FWNEUTRL", 1, "neutral", "capture the neutral again"};

void Write(ByteWriter& out, Point3 p) {
  out.F32(p.x);
  out.F32(p.y);
  out.F32(p.z);
}

Point3 ReadPoint(ByteReader& in) {
  Point3 p;
  p.x = in.F32();
  p.y = in.F32();
  p.z = in.F32();
  return p;
}

bool IsFinite(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

retarget::Neutral LoadNeutral(const std::filesystem::path& path) {
  const std::vector<std::byte> payload = ReadSealed(kNeutral, path);
  ByteReader in(payload);
  retarget::Neutral neutral;
  neutral.count = in.U32();
  bool good = neutral.count > 0 && neutral.count <= kMaxLandmarks;
  for (float& value : neutral.camera_R_head) {
    value = in.F32();
    good = good && std::isfinite(value);
  }
  neutral.camera_t_head_cm = ReadPoint(in);
  good = good && IsFinite(neutral.camera_t_head_cm);
  for (std::size_t i = 0; good && i < neutral.count; ++i) {
    neutral.points_cm[i] = ReadPoint(in);
    good = IsFinite(neutral.points_cm[i]);
  }
  if (!good || !in.ok() || in.left() != 0)
    throw BadInput(path.string() + ": the neutral contradicts itself; " +
                   std::string(kNeutral.remedy));
  return neutral;
}

void SaveNeutral(const std::filesystem::path& path, const retarget::Neutral& neutral,
                 FileCalls& files) {
  ByteWriter out;
  out.U32(static_cast<std::uint32_t>(neutral.count));
  for (const float value : neutral.camera_R_head) out.F32(value);
  Write(out, neutral.camera_t_head_cm);
  for (std::size_t i = 0; i < neutral.count; ++i) Write(out, neutral.points_cm[i]);
  WriteFileAtomically(path, Seal(kNeutral, out.bytes()), files);
}

}  // namespace facewire::app
