#ifndef FACEWIRE_APP_PROFILE_FILE_H_
#define FACEWIRE_APP_PROFILE_FILE_H_

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/retarget/expression_mapping.h"

namespace facewire::app {

// Everything that a .profile holds: the example pairs and how to fit them, not the fitted weights,
// so a profile stays good when the solver changes. Shapes as in retarget::Training.
struct TrainingSet {
  std::vector<ShortName> markers, signals;
  std::vector<float> samples, targets;
  std::vector<retarget::RegionConfig> regions;
  std::size_t neutral_sample = 0;
  bool average_user = false;
  std::vector<float> weights;

  retarget::Training view() const {
    return {markers, signals, samples, targets, regions, neutral_sample, average_user, weights};
  }
};

// A mapping that is ready to run, with all the memory it uses, allocated once.
class Profile {
 public:
  // Solves the mapping (well under a second for a full face). BadInput: one line that names the
  // region and the samples to blame; `source` starts the line.
  // `leave_one_out`: empty, or as training.targets.
  Profile(const TrainingSet& training, const std::string& source,
          std::span<float> leave_one_out = {});
  Profile(const Profile&) = delete;  // the mapping points into the block
  Profile& operator=(const Profile&) = delete;

  const retarget::ExpressionMapping& mapping() const { return mapping_; }
  std::size_t bytes() const { return block_.size() + sizeof(*this); }

 private:
  std::vector<std::byte> block_;
  retarget::ExpressionMapping mapping_;
};

// BadInput, one line: missing, not a profile, truncated, damaged, of another version, or Profile's.
TrainingSet ReadTrainingSet(const std::filesystem::path& path);
std::unique_ptr<Profile> LoadProfile(const std::filesystem::path& path);

// Atomically. Failure: cannot write.
void SaveProfile(const std::filesystem::path& path, const TrainingSet& training);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_PROFILE_FILE_H_
