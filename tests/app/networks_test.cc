#include "app/networks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "app/error.h"

namespace facewire::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using track::Model;

constexpr const char* kAttention = "face_landmark_with_attention.tflite";
constexpr const char* kDetector = "face_detection_short_range.tflite";

// A folder with copies of the real files, which each test spoils in its own way.
class NetworksTest : public testing::Test {
 protected:
  NetworksTest() {
    std::string pattern = testing::TempDir() + "/networks.XXXXXX";
    folder_ = mkdtemp(pattern.data());
    for (const char* name : {kDetector, kAttention, "face_landmark.tflite"}) {
      std::filesystem::copy_file(std::filesystem::path(FACEWIRE_ASSETS) / "networks" / name,
                                 folder_ / name);
      std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
    }
  }
  ~NetworksTest() override { std::filesystem::remove_all(folder_); }

  std::string MessageOf(Model model = Model::kAttention) const {
    try {
      LoadNetworks(folder_, model);
    } catch (const BadInput& e) {
      return e.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(NetworksTest, LoadsTheFilesOfEachModel) {
  const Networks attention = LoadNetworks(folder_, Model::kAttention);
  EXPECT_EQ(attention.detector.size(), 229032U);
  EXPECT_EQ(attention.landmarks.size(), 2495952U);
  EXPECT_EQ(LoadNetworks(folder_, Model::kMesh).landmarks.size(), 1241896U);
}

TEST_F(NetworksTest, ViewsWhatItLoaded) {
  const Networks networks = LoadNetworks(folder_, Model::kMesh);
  EXPECT_EQ(networks.files().detector.data(), networks.detector.data());
  EXPECT_EQ(networks.files().landmarks.size(), networks.landmarks.size());
}

TEST_F(NetworksTest, DoesNotNeedTheFileOfTheOtherModel) {
  std::filesystem::remove(folder_ / kAttention);
  EXPECT_EQ(MessageOf(Model::kMesh), "no error");
}

TEST_F(NetworksTest, NamesAMissingFileAndWhoFetchesIt) {
  std::filesystem::remove(folder_ / kAttention);
  EXPECT_THAT(MessageOf(), AllOf(HasSubstr((folder_ / kAttention).string()), HasSubstr("missing"),
                                 HasSubstr("tools/setup"), Not(HasSubstr("\n"))));
}

TEST_F(NetworksTest, NamesAMissingFolder) {
  std::filesystem::remove_all(folder_);
  EXPECT_THAT(MessageOf(), AllOf(HasSubstr(kDetector), HasSubstr("missing")));
}

TEST_F(NetworksTest, AFolderInPlaceOfAFileIsMissing) {
  std::filesystem::remove(folder_ / kAttention);
  std::filesystem::create_directory(folder_ / kAttention);
  EXPECT_THAT(MessageOf(), HasSubstr("missing"));
}

TEST_F(NetworksTest, TellsBothSizesOfATruncatedFile) {
  std::filesystem::resize_file(folder_ / kAttention, 1000);
  EXPECT_THAT(MessageOf(),
              AllOf(HasSubstr(kAttention), HasSubstr("1000 bytes"), HasSubstr("2495952"),
                    HasSubstr("truncated"), HasSubstr("tools/setup")));
}

TEST_F(NetworksTest, RefusesAFileThatIsTooLong) {
  std::filesystem::resize_file(folder_ / kDetector, 229033);
  EXPECT_THAT(MessageOf(),
              AllOf(HasSubstr(kDetector), HasSubstr("229033 bytes"), Not(HasSubstr("truncated"))));
}

TEST_F(NetworksTest, TellsBothChecksumsOfAChangedFile) {
  std::fstream file(folder_ / kDetector, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(100000);
  const char old = static_cast<char>(file.peek());
  file.seekp(100000);
  file.put(static_cast<char>(old ^ 1));
  file.close();
  EXPECT_THAT(MessageOf(),
              AllOf(HasSubstr(kDetector), HasSubstr("SHA-256"),
                    HasSubstr("instead of "
                              "3bc182eb9f33925d9e58b5c8d59308a760f4adea8f282370e428c51212c26633"),
                    HasSubstr("tools/setup"), Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace facewire::app
