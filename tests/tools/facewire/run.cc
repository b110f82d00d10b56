#include "tests/tools/facewire/run.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace facewire::tools {
namespace {

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

Outcome RunFacewire(const std::vector<std::string>& arguments) {
  const Scratch scratch;
  std::string command = Quoted(FACEWIRE_TOOL);
  for (const std::string& argument : arguments) command += " " + Quoted(argument);
  command +=
      " >" + Quoted(scratch.Path("out")) + " 2>" + Quoted(scratch.Path("err")) + " </dev/null";
  const int status = std::system(command.c_str());
  Outcome outcome;
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  outcome.out = ReadFile(scratch.Path("out"));
  outcome.err = ReadFile(scratch.Path("err"));
  return outcome;
}

Scratch::Scratch() {
  std::string made = testing::TempDir() + "facewire_cli_XXXXXX";
  folder_ = mkdtemp(made.data());
}

Scratch::~Scratch() { std::filesystem::remove_all(folder_); }

std::string Scratch::Write(const std::string& name, const std::string& contents) const {
  std::ofstream(Path(name), std::ios::binary) << contents;
  return Path(name);
}

std::string Scratch::Read(const std::string& name) const { return ReadFile(Path(name)); }

std::size_t Scratch::Files() const {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_),
                                                std::filesystem::directory_iterator()));
}

std::string ShortClip(const Scratch& scratch, int frames) {
  const std::string path = scratch.Path("clip.avi");
  cv::VideoCapture in(FACEWIRE_ASSETS "/footage/franck.mp4");
  EXPECT_TRUE(in.isOpened()) << "the footage is missing: run tools/setup";
  cv::VideoWriter out;
  cv::Mat picture;
  for (int i = 0; i < frames && in.read(picture); ++i) {
    if (i == 0) out.open(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 24, picture.size());
    out.write(picture);
  }
  return path;
}

}  // namespace facewire::tools
