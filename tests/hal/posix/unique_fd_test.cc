#include "hal/posix/unique_fd.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <type_traits>

namespace facewire::hal::posix {
namespace {

static_assert(!std::is_copy_constructible_v<UniqueFd>);
static_assert(!std::is_convertible_v<int, UniqueFd>);

bool IsOpen(int fd) { return ::fcntl(fd, F_GETFD) >= 0; }
int OpenNull() { return ::open("/dev/null", O_RDONLY | O_CLOEXEC); }

TEST(UniqueFd, ClosesWhenItGoes) {
  const int fd = OpenNull();
  {
    const UniqueFd owner(fd);
    EXPECT_TRUE(owner);
    EXPECT_TRUE(IsOpen(fd));
  }
  EXPECT_FALSE(IsOpen(fd));
}

TEST(UniqueFd, MovingLeavesTheSourceEmptyAndClosesTheOldTarget) {
  const int first = OpenNull();
  const int second = OpenNull();
  UniqueFd from(first);
  UniqueFd to(second);
  to = std::move(from);
  EXPECT_FALSE(from);  // NOLINT(bugprone-use-after-move): what this test is about
  EXPECT_EQ(to.get(), first);
  EXPECT_FALSE(IsOpen(second));
}

TEST(UniqueFd, ReleaseLeavesTheFileOpen) {
  UniqueFd owner(OpenNull());
  const int fd = owner.Release();
  EXPECT_FALSE(owner);
  EXPECT_TRUE(IsOpen(fd));
  ::close(fd);
}

}  // namespace
}  // namespace facewire::hal::posix
