#include <CLI/CLI.hpp>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/error.h"
#include "app/profile_file.h"
#include "app/rig_file.h"
#include "core/limit/limiter.h"
#include "core/retarget/retargeter.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/marker_layout.h"
#include "tools/facewire/neutral_taker.h"
#include "tools/facewire/novelty_report.h"
#include "tools/facewire/performance.h"
#include "tools/facewire/pose_writer.h"

namespace facewire::tools {
namespace {

struct RetargetOptions {
  FaceOptions face;  // with the input, also when that is a marker file
  std::string rig;
  std::string profile;
  std::string personal;
  float blend_percent = 100;
  std::string neutral;
  std::string out;
  std::vector<std::string> rigid;
};

// None for markers without one: then only the geometry mapping moves the character.
std::unique_ptr<app::Profile> OpenProfile(const RetargetOptions& options) {
  if (!options.profile.empty()) return app::LoadProfile(options.profile);
  if (IsMarkerFile(options.face.input)) return nullptr;
  const std::filesystem::path installed = FACEWIRE_INSTALLED_SHARE "/average.profile";
  return app::LoadProfile(
      std::filesystem::exists(installed) ? installed : FACEWIRE_SOURCE_SHARE "/average.profile");
}

// A rig, a profile and a neutral, put together: what turns faces into poses.
class Character {
 public:
  Character(const RetargetOptions& options, Rig rig) : rig_(rig), profile_(OpenProfile(options)) {
    if (!options.personal.empty()) personal_ = app::LoadProfile(options.personal);
    const retarget::ExpressionMapping* personal =
        personal_ == nullptr ? nullptr : &personal_->mapping();
    if (const auto unknown = retarget::FirstUnknownSignal(rig_, mapping(), personal)) {
      throw app::BadInput(
          options.rig + ": the signal " + std::string(unknown->view()) + " is driven by, but " +
          (profile_ ? "the profile does not give it"
                    : "there is none without --profile, a profile that was trained with markers of "
                      "the same names"));
    }
    if (IsMarkerFile(options.face.input)) {
      layout_ = LayOutMarkers(mapping(), rig_);
      if (layout_.names.empty()) {
        throw app::BadInput(
            options.rig + ": no bone has a marker, and there is no --profile; nothing would move");
      }
    }
    memory_.resize(retarget::Retargeter::RequiredBytes());
    arena_.emplace(std::span(memory_));
    const Result<> configured = retargeter_.Configure(rig_, mapping(), *arena_, personal);
    if (!configured && configured.error() == Errc::kUnsupported) {
      throw app::BadInput(options.personal +
                          ": reads markers that the profile does not have; train it with some of "
                          "the profile's markers");
    }
    Check(configured, options.rig);
    retargeter_.SetBlend(options.blend_percent / 100);
    Check(limiter_.Configure(rig_), options.rig);
  }
  Character(const Character&) = delete;
  Character& operator=(const Character&) = delete;

  const Rig& rig() const { return rig_; }
  const MarkerLayout& layout() const { return layout_; }  // of a marker file

  void Use(const retarget::Neutral& neutral) {
    if (!retargeter_.SetNeutral(neutral)) {
      throw app::BadInput(
          "the frames of the neutral do not show a face that can be used; --neutral A:B names "
          "others");
    }
  }

  // What the profile's training lacks for the frames written so far.
  std::vector<std::string> MissingPoses() const {
    std::vector<std::string_view> names;
    for (std::size_t r = 0; mapping() != nullptr && r < mapping()->region_count(); ++r)
      names.push_back(mapping()->region_name(r));
    return report_.Lines(names);
  }

  void Write(const PerformanceFrame& moment, PoseWriter& writer) {
    if (!moment.face) {
      was_lost_ = true;
      writer.WriteLost(moment.frame, moment.t_us);
      return;
    }
    const RigPose wish = retargeter_.Update(*moment.face);
    report_.Add(moment.frame, moment.t_us, retargeter_.novelty());
    // A face that appears is where it is; the speed limits hold from there.
    if (was_lost_) limiter_.Reset(wish);
    was_lost_ = false;
    HeadMotion head{};
    const auto signals = retargeter_.signals().last(head.size());
    std::copy(signals.begin(), signals.end(), head.begin());
    writer.Write(moment.frame, moment.t_us, head,
                 limiter_.Update(wish, Time{Duration{moment.t_us}}));
  }

 private:
  const retarget::ExpressionMapping* mapping() const {
    return profile_ ? &profile_->mapping() : nullptr;
  }
  static void Check(const Result<>& result, const std::string& what) {
    if (!result) throw app::Failure(what + ": " + Name(result.error()));
  }

  Rig rig_;
  std::unique_ptr<app::Profile> profile_;   // or none
  std::unique_ptr<app::Profile> personal_;  // or none
  MarkerLayout layout_;
  std::vector<std::byte> memory_;
  std::optional<Arena> arena_;
  retarget::Retargeter retargeter_;
  limit::Limiter limiter_;
  NoveltyReport report_;
  bool was_lost_ = true;
};

void Retarget(const RetargetOptions& options) {
  if (IsLive(options.face.input)) {
    throw app::BadInput(options.face.input +
                        ": retarget takes a recording; facewired drives a character live");
  }
  NeutralTaker taker("--neutral", options.neutral);
  const auto character = std::make_unique<Character>(options, app::LoadRig(options.rig));
  const auto performance = IsMarkerFile(options.face.input)
                               ? OpenMarkers(options.face.input, character->layout(), options.rigid)
                               : OpenVideo(options.face);
  const auto writer = OpenPoseWriter(options.out, character->rig());

  // Frames wait until the neutral is known, and are written from the first one on.
  std::deque<PerformanceFrame> waiting;
  bool has_neutral = false;
  std::size_t frames = 0;
  std::size_t faces = 0;
  std::int64_t last_us = 0;
  const auto take_neutral = [&] {
    character->Use(taker.Take());
    has_neutral = true;
    for (const PerformanceFrame& moment : waiting) character->Write(moment, *writer);
    waiting.clear();
  };
  while (const auto moment = performance->Next()) {
    ++frames;
    faces += moment->face ? 1 : 0;
    last_us = moment->t_us;
    if (has_neutral) {
      character->Write(*moment, *writer);
      continue;
    }
    waiting.push_back(*moment);
    if (taker.Add(*moment)) take_neutral();
  }
  if (!has_neutral) take_neutral();
  writer->Commit();
  // Animators set their scene to this before they import.
  const double rate_hz =
      last_us > 0 ? 1e6 * static_cast<double>(frames - 1) / static_cast<double>(last_us) : 0;
  std::fprintf(stderr, "facewire retarget: %zu frames, %.4g a second, a face in %zu\n", frames,
               rate_hz, faces);
  for (const std::string& line : character->MissingPoses())
    std::fprintf(stderr, "facewire retarget: %s\n", line.c_str());
}

}  // namespace

void AddRetarget(CLI::App& facewire) {
  auto options = std::make_shared<RetargetOptions>();
  CLI::App* command =
      facewire.add_subcommand("retarget", "Drive a character from a recording and write its poses");
  command
      ->add_option("INPUT", options->face.input,
                   "A video, or recorded markers: .csv (NAME_x,NAME_y,NAME_z; cm), .trc or .c3d")
      ->required();
  command->add_option("--rig", options->rig, "The character")->required();
  command->add_option(
      "--profile", options->profile,
      "The trained mapping; unless named, for videos the shipped one, and for markers none: "
      "then bones follow the markers that the rig names");
  CLI::Option* personal = command->add_option(
      "--personal", options->personal,
      "A profile of the performer's own poses, blended over the other by the names of signals");
  command
      ->add_option("--blend", options->blend_percent,
                   "How much it counts, in percent: 0 (not at all) to 100, the default")
      ->check(CLI::Range(0.0, 100.0))
      ->needs(personal);
  command->add_option(
      "--neutral", options->neutral,
      "A:B, the face at rest is the median of frames A to B-1; else of the first two seconds");
  command
      ->add_option("--out", options->out,
                   "The file to write: .glb for a glTF animation, .csv for CSV, else JSON lines")
      ->required();
  command
      ->add_option(
          "--rigid", options->rigid,
          "Markers that only follow the head, to take its motion out; without, there is none in")
      ->delimiter(',');
  AddFaceOptions(*command, options->face);
  command->callback([options] { Retarget(*options); });
}

}  // namespace facewire::tools
