#ifndef FACEWIRE_APP_FOLLOWER_H_
#define FACEWIRE_APP_FOLLOWER_H_

#include "app/character.h"
#include "core/frame_path/frame_path.h"

namespace facewire::app {

// What turns pictures into rig poses, as the service sees it: the frame path, or a test's script.
class Follower {
 public:
  virtual ~Follower() = default;
  // As FramePath::Update.
  virtual Result<Followed> Follow(const Frame& frame) noexcept = 0;
  // Forgets the face: pictures were missed.
  virtual void Forget() noexcept = 0;
  // Drives this character from now on; borrowed.
  virtual void Use(Character& character, const filter::FilterConfig& filter) noexcept = 0;
};

class FramePathFollower final : public Follower {
 public:
  explicit FramePathFollower(FramePath& path) noexcept : path_(path) {}
  Result<Followed> Follow(const Frame& frame) noexcept override { return path_.Update(frame); }
  void Forget() noexcept override { path_.Reset(); }
  void Use(Character& character, const filter::FilterConfig& filter) noexcept override {
    path_.Use(character.retargeter);
    path_.Use(filter);
  }

 private:
  FramePath& path_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_FOLLOWER_H_
