#include "app/networks.h"

#include <openssl/evp.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "app/error.h"

namespace facewire::app {
namespace {

struct PinnedFile {
  const char* name;
  std::uintmax_t bytes;
  std::string_view sha256;  // lower-case hexadecimal
};

constexpr PinnedFile kDetector = {
    "face_detection_short_range.tflite", 229032,
    "3bc182eb9f33925d9e58b5c8d59308a760f4adea8f282370e428c51212c26633"};
constexpr PinnedFile kMesh = {"face_landmark.tflite", 1241896,
                              "c603fa6149219a3e9487dc9abd7a0c24474c77263273d24868378cdf40aa26d1"};
constexpr PinnedFile kAttention = {
    "face_landmark_with_attention.tflite", 2495952,
    "883b7411747bac657c30c462d305d312e9dec6adbf8b85e2f5d8d722fca9455d"};

constexpr const char* kRemedy = "; tools/setup fetches the right one";

std::string Sha256(const std::vector<std::byte>& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw Failure("libcrypto cannot compute a SHA-256");
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (unsigned i = 0; i < size; ++i) {
    hex += kDigits[digest[i] >> 4];
    hex += kDigits[digest[i] & 0xf];
  }
  return hex;
}

std::vector<std::byte> ReadPinned(const std::filesystem::path& folder, const PinnedFile& pinned) {
  const std::filesystem::path path = folder / pinned.name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw BadInput("network file " + path.string() + " is missing" + kRemedy);
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size != pinned.bytes) {
    throw BadInput("network file " + path.string() + " has " + std::to_string(size) +
                   " bytes instead of " + std::to_string(pinned.bytes) +
                   (size < pinned.bytes ? " (truncated)" : "") + kRemedy);
  }
  std::vector<std::byte> bytes(pinned.bytes);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (error || !file) {
    throw BadInput("network file " + path.string() + " cannot be read; check its permissions");
  }
  const std::string sha256 = Sha256(bytes);
  if (sha256 != pinned.sha256) {
    throw BadInput("network file " + path.string() + " has SHA-256 " + sha256 + " instead of " +
                   std::string(pinned.sha256) + kRemedy);
  }
  return bytes;
}

}  // namespace

Networks LoadNetworks(const std::filesystem::path& folder, track::Model model) {
  Networks networks;
  networks.detector = ReadPinned(folder, kDetector);
  networks.landmarks = ReadPinned(folder, model == track::Model::kAttention ? kAttention : kMesh);
  return networks;
}

}  // namespace facewire::app
