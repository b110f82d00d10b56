#include "app/profile_file.h"

#include <cmath>
#include <cstdint>

#include "app/checked_file.h"
#include "app/error.h"

namespace facewire::app {
namespace {

using retarget::RegionConfig;

constexpr FileKind kProfile = {"FWPROFIL", 2, "profile", "make it again with facewire train"};
constexpr std::uint32_t kAverageUser = 1U << 0;
constexpr std::uint32_t kWeighted = 1U << 1;

std::string Quoted(const ShortName& name) { return "\"" + std::string(name.view()) + "\""; }

std::string Describe(const TrainingSet& training, Errc code,
                     const retarget::TrainingReport& report) {
  const auto row = [](std::size_t index) { return std::to_string(index + 1); };
  const rbf::FitReport& fit = report.fit;
  const nnls::NnlsReport& nnls = report.nnls;
  const std::string region = report.region < training.regions.size()
                                 ? "in region " + Quoted(training.regions[report.region].name) + " "
                                 : "";
  if (fit.duplicate_first && fit.duplicate_second)
    return region + "rows " + row(*fit.duplicate_first) + " and " + row(*fit.duplicate_second) +
           " have the same markers; leave one out, or allow smoothing";
  if (nnls.duplicate_first && nnls.duplicate_second)
    return region + "rows " + row(*nnls.duplicate_first) + " and " + row(*nnls.duplicate_second) +
           " have the same markers and other targets; leave one out, or allow smoothing";
  if (nnls.dependent_output) {
    const std::uint16_t signal = training.regions[report.region].outputs[*nnls.dependent_output];
    return region + "the rows do not tell what target " + Quoted(training.signals[signal]) +
           " moves from what those before it move; add a row that shows it alone, leave it out, "
           "or allow smoothing";
  }
  if (fit.dependent_sample)
    return region + "row " + row(*fit.dependent_sample) +
           " adds nothing to the rows before it; leave it out, allow smoothing, or use a larger "
           "epsilon";
  if (fit.tail_undetermined)
    return region +
           "the rows do not determine a linear tail; give more rows than coordinates, or use "
           "tail smoothing, or tail constant";
  if (code == Errc::kFull)
    return "too large: at most " + std::to_string(kMaxMarkers) + " markers, " +
           std::to_string(kMaxSignals) + " targets, " + std::to_string(kMaxTrainingSamples) +
           " rows and " + std::to_string(kMaxRegions) + " regions fit";
  return region + "cannot be solved (" + Name(code) + ")";
}

void WriteIndices(ByteWriter& out, std::span<const std::uint16_t> indices) {
  out.U16(static_cast<std::uint16_t>(indices.size()));
  for (const std::uint16_t i : indices) out.U16(i);
}

void WriteRegion(ByteWriter& out, const RegionConfig& region) {
  out.Text(region.name.view());
  out.U8(static_cast<std::uint8_t>(region.method));
  out.U8(static_cast<std::uint8_t>(region.rbf.kernel));
  out.U8(static_cast<std::uint8_t>(region.rbf.tail));
  out.U16(region.axes);
  out.F32(region.rbf.epsilon);
  out.F32(region.rbf.smoothing);
  out.F32(region.rbf.tail_smoothing);
  out.F32(region.nnls.ridge);
  out.F32(region.gap_gain);
  out.F32(region.dead_zone);
  WriteIndices(out, region.points.span());
  WriteIndices(out, region.origin.span());
  out.U16(static_cast<std::uint16_t>(region.gaps.size()));
  for (const RegionConfig::Gap& gap : region.gaps) {
    out.U16(gap.upper);
    out.U16(gap.lower);
  }
  WriteIndices(out, region.outputs.span());
  WriteIndices(out, region.ignores.span());
}

// A profile whose checksum is right and whose content is not: made by something else.
[[noreturn]] void Contradiction(const std::filesystem::path& path) {
  throw BadInput(path.string() + ": the profile contradicts itself; " +
                 std::string(kProfile.remedy));
}

class Parser {
 public:
  Parser(const std::filesystem::path& path, std::span<const std::byte> payload)
      : path_(path), in_(payload) {}

  TrainingSet Parse() {
    TrainingSet out;
    const std::uint32_t flags = in_.U32();
    const std::size_t samples = in_.U32();
    const std::size_t markers = in_.U16();
    const std::size_t signals = in_.U16();
    const std::size_t regions = in_.U16();
    Expect(in_.U16() == 0 && (flags & ~(kAverageUser | kWeighted)) == 0);
    out.neutral_sample = in_.U32();
    out.average_user = (flags & kAverageUser) != 0;
    // Before anything is allocated for them.
    Expect(in_.ok() && samples <= kMaxTrainingSamples && markers <= kMaxMarkers &&
           signals <= kMaxSignals && regions <= kMaxRegions);
    for (std::size_t i = 0; i < markers; ++i) out.markers.push_back(ReadName());
    for (std::size_t i = 0; i < signals; ++i) out.signals.push_back(ReadName());
    out.samples = ReadFloats(samples * 3 * markers);
    out.targets = ReadFloats(samples * signals);
    if ((flags & kWeighted) != 0) out.weights = ReadFloats(samples);
    for (std::size_t i = 0; i < regions; ++i) out.regions.push_back(ReadRegion());
    Expect(in_.ok() && in_.left() == 0);
    return out;
  }

 private:
  void Expect(bool good) const {
    if (!good) Contradiction(path_);
  }

  ShortName ReadName() {
    const auto name = ShortName::From(in_.Text());
    Expect(name.has_value());
    return name.value_or(ShortName{});
  }

  std::vector<float> ReadFloats(std::size_t count) {
    Expect(in_.left() >= count * sizeof(float));
    std::vector<float> values(count);
    for (float& value : values) {
      value = in_.F32();
      Expect(std::isfinite(value));
    }
    return values;
  }

  template <std::size_t N>
  void ReadIndices(InlineVector<std::uint16_t, N>& out) {
    const std::size_t count = in_.U16();
    for (std::size_t i = 0; i < count; ++i) Expect(in_.ok() && out.try_push(in_.U16()));
  }

  RegionConfig ReadRegion() {
    RegionConfig region;
    region.name = ReadName();
    const std::uint8_t method = in_.U8();
    const std::uint8_t kernel = in_.U8();
    const std::uint8_t tail = in_.U8();
    Expect(method < retarget::kMethodCount && kernel < rbf::kKernelCount && tail < rbf::kTailCount);
    region.method = static_cast<retarget::Method>(method);
    region.rbf.kernel = static_cast<rbf::Kernel>(kernel);
    region.rbf.tail = static_cast<rbf::Tail>(tail);
    region.axes = in_.U16();
    region.rbf.epsilon = in_.F32();
    region.rbf.smoothing = in_.F32();
    region.rbf.tail_smoothing = in_.F32();
    region.nnls.ridge = in_.F32();
    region.gap_gain = in_.F32();
    region.dead_zone = in_.F32();
    ReadIndices(region.points);
    ReadIndices(region.origin);
    const std::size_t gaps = in_.U16();
    for (std::size_t i = 0; i < gaps; ++i) {
      const std::uint16_t upper = in_.U16();
      Expect(in_.ok() && region.gaps.try_push({upper, in_.U16()}));
    }
    ReadIndices(region.outputs);
    ReadIndices(region.ignores);
    return region;
  }

  std::filesystem::path path_;
  ByteReader in_;
};

}  // namespace

Profile::Profile(const TrainingSet& training, const std::string& source,
                 std::span<float> leave_one_out) {
  const retarget::Training view = training.view();
  if (auto checked = retarget::ExpressionMapping::Check(view); !checked)
    throw BadInput(
        source + ": " +
        Describe(training, checked.error(), {.region = SIZE_MAX, .fit = {}, .nnls = {}}));
  block_.resize(retarget::ExpressionMapping::RequiredBytes(view));
  std::vector<std::byte> workspace(retarget::ExpressionMapping::WorkspaceBytes(view));
  Arena arena(block_);
  retarget::TrainingReport report;
  if (auto solved = mapping_.Configure(view, arena, workspace, report, leave_one_out); !solved)
    throw BadInput(source + ": " + Describe(training, solved.error(), report));
}

TrainingSet ReadTrainingSet(const std::filesystem::path& path) {
  const std::vector<std::byte> payload = ReadSealed(kProfile, path);
  return Parser(path, payload).Parse();
}

std::unique_ptr<Profile> LoadProfile(const std::filesystem::path& path) {
  return std::make_unique<Profile>(ReadTrainingSet(path), path.string());
}

void SaveProfile(const std::filesystem::path& path, const TrainingSet& training) {
  ByteWriter out;
  out.U32((training.average_user ? kAverageUser : 0) | (training.weights.empty() ? 0 : kWeighted));
  out.U32(static_cast<std::uint32_t>(training.view().sample_count()));
  out.U16(static_cast<std::uint16_t>(training.markers.size()));
  out.U16(static_cast<std::uint16_t>(training.signals.size()));
  out.U16(static_cast<std::uint16_t>(training.regions.size()));
  out.U16(0);
  out.U32(static_cast<std::uint32_t>(training.neutral_sample));
  for (const ShortName& name : training.markers) out.Text(name.view());
  for (const ShortName& name : training.signals) out.Text(name.view());
  for (const float value : training.samples) out.F32(value);
  for (const float value : training.targets) out.F32(value);
  for (const float value : training.weights) out.F32(value);
  for (const RegionConfig& region : training.regions) WriteRegion(out, region);
  WriteFileAtomically(path, Seal(kProfile, out.bytes()));
}

}  // namespace facewire::app
