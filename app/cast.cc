#include "app/cast.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/error.h"
#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "core/wire/rig_description.h"

namespace facewire::app {
namespace {

constexpr std::size_t kAlignment = 64;

const retarget::ExpressionMapping* MappingOf(const std::unique_ptr<Profile>& profile) {
  return profile == nullptr ? nullptr : &profile->mapping();
}

// Null for an empty path. A camera shows landmarks, nobody's markers.
std::unique_ptr<Profile> LoadLiveProfile(const std::filesystem::path& path) {
  if (path.empty()) return nullptr;
  auto profile = LoadProfile(path);
  if (!profile->mapping().reads_landmarks()) {
    throw BadInput(path.string() + ": reads markers (\"" +
                   std::string(profile->mapping().markers().front().view()) +
                   "\", ...) that a camera does not show; train it with landmarks, lm0 to lm477");
  }
  return profile;
}

}  // namespace

std::size_t Cast::RequiredBytes() noexcept {
  return 2 * (retarget::Retargeter::RequiredBytes() + kAlignment);
}

void Cast::Load(const CharacterConfig& config, Arena& arena) {
  config_ = config;
  const std::size_t bytes = retarget::Retargeter::RequiredBytes();
  for (std::span<std::byte>& memory : memory_) {
    memory = {static_cast<std::byte*>(arena.Allocate(bytes, kAlignment)), bytes};
    if (memory.data() == nullptr) throw Failure("the block of memory is too small");
  }
  std::string problems;
  Collect(problems, [&] { profile_ = LoadLiveProfile(config.profile); });
  Collect(problems, [&] { personal_ = LoadLiveProfile(config.personal); });
  const bool have_profiles = problems.empty();
  Collect(problems, [&] {
    // Without a profile its signals are unknown, and complaining about each would hide the cause.
    if (have_profiles) {
      Build(config, running_);
    } else {
      (void)LoadServoRig(config.rig, LoadRig(config.rig));
    }
  });
  if (!problems.empty()) throw BadInput(problems);
}

void Cast::Build(const CharacterConfig& config, std::size_t which) {
  const std::vector<std::string> signals = SignalNames();
  const Rig rig = LoadRig(config.rig, &signals);
  const servo::ServoRig servos = LoadServoRig(config.rig, rig);
  Character& character = characters_[which].emplace();
  character.rig = rig;
  character.servos = servos;
  character.rig_id = wire::RigId(rig);
  Arena arena(memory_[which]);
  if (const Result<> ok = character.retargeter.Configure(character.rig, MappingOf(profile_), arena,
                                                         MappingOf(personal_));
      !ok) {
    throw Failure(config.rig.string() + ": " + Name(ok.error()));
  }
  if (const Result<> ok = character.mapper.Configure(servos, rig); !ok) {
    throw Failure(config.rig.string() + ": the servos: " + Name(ok.error()));
  }
  character.retargeter.SetBlend(config.blend);
}

Character& Cast::Prepare(const CharacterConfig& config) {
  const std::size_t idle = 1 - running_;
  Build(config, idle);
  if (config.blend == config_.blend)
    characters_[idle]->retargeter.SetBlend(running().retargeter.blend());
  return *characters_[idle];
}

void Cast::Switch(const CharacterConfig& config) {
  running_ = 1 - running_;
  config_.rig = config.rig;
  config_.blend = config.blend;
}

std::vector<std::string> Cast::SignalNames() const {
  std::vector<std::string> names;
  for (const auto* mapping : {MappingOf(profile_), MappingOf(personal_)}) {
    if (mapping == nullptr) continue;
    for (const ShortName& signal : mapping->signals()) names.emplace_back(signal.view());
  }
  return names;
}

std::string Cast::Summary() const {
  const Rig& rig = characters_[running_]->rig;
  std::string text = "rig      " + std::string(rig.name.view()) + ": " +
                     std::to_string(rig.bones.size()) + " bones, " +
                     std::to_string(rig.channels.size()) + " channels\n";
  text += "profile  " +
          (profile_ == nullptr
               ? "none: bones only"
               : config_.profile.string() + ": " +
                     std::to_string(profile_->mapping().signals().size()) + " signals") +
          "\n";
  text += "personal " + PersonalSummary() + "\n";
  return text;
}

std::string Cast::PersonalSummary() const {
  if (personal_ == nullptr) return "none";
  const auto own = personal_->mapping().signals();
  const auto shared = std::ranges::count_if(own, [&](const ShortName& signal) {
    return profile_ != nullptr && std::ranges::find(profile_->mapping().signals(), signal) !=
                                      profile_->mapping().signals().end();
  });
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), ": %zu signals, %zu of them shared, blend %.2f",
                own.size(), static_cast<std::size_t>(shared), static_cast<double>(config_.blend));
  return config_.personal.string() + text.data();
}

void Cast::AddTo(MemoryReport& report) const {
  report.parts.push_back({"characters", 2 * retarget::Retargeter::RequiredBytes(),
                          "two mappings: one runs, a reload builds the other"});
  report.parts.push_back(
      {"profile", profile_ == nullptr ? 0 : profile_->bytes(), "the expression mapping"});
  report.parts.push_back({"personal profile", personal_ == nullptr ? 0 : personal_->bytes(),
                          "the performer's own expression mapping"});
}

}  // namespace facewire::app
