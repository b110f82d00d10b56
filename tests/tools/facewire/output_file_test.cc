#include "tools/facewire/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "app/error.h"

namespace facewire::tools {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class OutputFileTest : public testing::Test {
 protected:
  OutputFileTest() {
    std::string made = testing::TempDir() + "output_file_XXXXXX";
    folder_ = mkdtemp(made.data());
  }
  ~OutputFileTest() override { fs::remove_all(folder_); }

  std::string Path() const { return (folder_ / "out.jsonl").string(); }
  std::size_t FilesLeft() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static std::string Contents(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  fs::path folder_;
};

TEST_F(OutputFileTest, AppearsOnlyWithCommit) {
  OutputFile out(Path());
  out.Write("one\n");
  EXPECT_FALSE(fs::exists(Path()));
  out.Commit();
  EXPECT_EQ(Contents(Path()), "one\n");
  EXPECT_EQ(FilesLeft(), 1U);
}

TEST_F(OutputFileTest, LeavesNothingWithoutCommit) {
  { OutputFile(Path()).Write("half"); }
  EXPECT_EQ(FilesLeft(), 0U);
}

TEST_F(OutputFileTest, KeepsTheOlderFileUntilCommitAndItsPermissions) {
  std::ofstream(Path()) << "old";
  chmod(Path().c_str(), 0640);
  { OutputFile(Path()).Write("half"); }
  EXPECT_EQ(Contents(Path()), "old");
  OutputFile out(Path());
  out.Write("new");
  out.Commit();
  EXPECT_EQ(Contents(Path()), "new");
  EXPECT_EQ(fs::status(Path()).permissions(), fs::perms(0640));
}

TEST_F(OutputFileTest, LeavesNothingWhenASignalEndsTheProgram) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t child = fork();
    if (child == 0) {
      OutputFile out(Path());
      out.Write("half");
      std::raise(signal);
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    EXPECT_EQ(FilesLeft(), 0U) << signal;
  }
}

TEST_F(OutputFileTest, WritesStraightToWhatIsNoRegularFile) {
  OutputFile out("/dev/null");
  out.Write("gone");
  out.Commit();
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(OutputFileTest, SaysWhyItCannotBeWritten) {
  const auto error = [](const std::string& path) -> std::string {
    try {
      OutputFile out(path);
    } catch (const app::BadInput& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(error(folder_ / "no/such/f"), HasSubstr("no/such/f: its folder does not exist"));
  EXPECT_THAT(error(folder_), HasSubstr("it is a folder"));
}

TEST_F(OutputFileTest, ReportsAFullDisk) {
  OutputFile out("/dev/full");
  out.Write("x");
  EXPECT_THROW(out.Commit(), app::Failure);
}

}  // namespace
}  // namespace facewire::tools
