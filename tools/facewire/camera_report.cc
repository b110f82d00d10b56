#include "tools/facewire/camera_report.h"

#include <algorithm>

#include "tools/facewire/json.h"

namespace facewire::tools {
namespace {

constexpr int kDecimals = 2;  // of a rate: 29.97

bool HasReadableMode(const hal::CameraInfo& camera) {
  return std::ranges::any_of(camera.modes, &hal::CameraMode::readable);
}

std::string Padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

std::string SizeText(const hal::CameraMode& mode) {
  if (mode.width_px == 0) return "any size";
  return std::to_string(mode.width_px) + "x" + std::to_string(mode.height_px);
}

std::string RateText(const hal::CameraMode& mode) {
  if (mode.fps.empty()) return "rate not listed";
  std::string text;
  for (const double fps : mode.fps) {
    if (!text.empty()) text += mode.fps_range ? " down to " : ", ";
    json::AppendNumber(text, fps, kDecimals);
  }
  return text + " fps";
}

}  // namespace

std::string ProblemOf(const hal::CameraInfo& camera) {
  if (camera.problem == Errc::kBusy) {
    return "in use by " + (camera.holder.empty() ? "another program" : camera.holder);
  }
  if (camera.problem == Errc::kPermission) return "no permission";
  if (camera.problem) return "cannot be opened";
  if (!HasReadableMode(camera)) return "has no format that facewire reads";
  return "";
}

std::string FixOf(const hal::CameraInfo& camera) {
  if (camera.problem == Errc::kBusy) return "end that program first";
  if (camera.problem == Errc::kPermission) {
    return "sudo usermod -aG video $USER, then log in again";
  }
  if (camera.problem) return "unplug it and plug it in again; dmesg shows what the system thinks";
  if (!HasReadableMode(camera)) return "use another of its nodes, or another camera";
  return "";
}

std::string CameraTable(const std::vector<hal::CameraInfo>& cameras) {
  std::string text;
  for (const hal::CameraInfo& camera : cameras) {
    if (!text.empty()) text += '\n';
    text += (camera.name.empty() ? "a camera" : camera.name);
    if (!camera.node.empty()) text += " (now " + camera.node + ")";
    text += "\n  device = \"" + camera.address + "\"\n";
    if (const std::string problem = ProblemOf(camera); !problem.empty()) {
      text += "  " + problem + "\n  -> " + FixOf(camera) + '\n';
    }
    for (const hal::CameraMode& mode : camera.modes) {
      text += "  " + Padded(mode.format, 6) + ' ' + Padded(SizeText(mode), 10) + ' ' +
              RateText(mode) + (mode.readable ? "\n" : "  (not read by facewire)\n");
    }
  }
  return text;
}

std::string CameraJson(const std::vector<hal::CameraInfo>& cameras) {
  std::string text;
  for (const hal::CameraInfo& camera : cameras) {
    const auto member = [&text](const char* before, const std::string& value) {
      text += before;
      json::AppendString(text, value);
    };
    member("{\"address\":", camera.address);
    member(",\"node\":", camera.node);
    member(",\"name\":", camera.name);
    member(",\"problem\":", ProblemOf(camera));
    member(",\"fix\":", FixOf(camera));
    text += ",\"modes\":[";
    for (const hal::CameraMode& mode : camera.modes) {
      if (text.back() != '[') text += ',';
      member("{\"format\":", mode.format);
      text += std::string(",\"readable\":") + (mode.readable ? "true" : "false");
      text += ",\"width_px\":" + std::to_string(mode.width_px);
      text += ",\"height_px\":" + std::to_string(mode.height_px) + ",\"fps\":[";
      for (const double fps : mode.fps) {
        if (text.back() != '[') text += ',';
        json::AppendNumber(text, fps, kDecimals);
      }
      text += std::string("],\"fps_range\":") + (mode.fps_range ? "true}" : "false}");
    }
    text += "]}\n";
  }
  return text;
}

}  // namespace facewire::tools
