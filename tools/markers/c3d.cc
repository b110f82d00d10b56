#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>

#include "app/error.h"
#include "tools/markers/take.h"
#include "tools/markers/text.h"

// The format: "The C3D file format user guide", c3d.org.
namespace facewire::tools::markers {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::uint8_t kKey = 0x50;         // second byte of every C3D file
constexpr std::uint8_t kIntel = 84;         // little-endian, IEEE reals
constexpr std::size_t kManyFrames = 65535;  // what a 16-bit frame number can say

// Little-endian reads that never leave the file.
class Bytes {
 public:
  Bytes(const std::string& contents, const std::string& name) : contents_(contents), name_(name) {}

  std::size_t size() const { return contents_.size(); }
  const std::string& name() const { return name_; }
  [[noreturn]] void Refuse(const std::string& what) const {
    throw app::BadInput(name_ + ": " + what);
  }

  std::string Text(std::size_t at, std::size_t count) const {
    Check(at, count);
    return contents_.substr(at, count);
  }
  template <class T>
  T Get(std::size_t at) const {
    static_assert(std::is_trivially_copyable_v<T>);
    Check(at, sizeof(T));
    T value;
    std::memcpy(&value, contents_.data() + at, sizeof(T));
    return value;
  }

 private:
  void Check(std::size_t at, std::size_t count) const {
    if (at > contents_.size() || count > contents_.size() - at) {
      Refuse("cut short: byte " + std::to_string(at + count) + " is needed, it has " +
             std::to_string(contents_.size()));
    }
  }

  const std::string& contents_;
  const std::string& name_;
};

struct Parameter {
  int type = 0;  // -1 characters, 1 bytes, 2 integers, 4 reals
  std::vector<std::size_t> dimensions;
  std::size_t data = 0;   // position in the file
  std::size_t count = 1;  // product of the dimensions
};

// "GROUP:NAME" to parameter.
using Parameters = std::map<std::string, Parameter>;

Parameter ReadParameter(const Bytes& file, std::size_t at) {
  Parameter parameter;
  parameter.type = file.Get<std::int8_t>(at);
  const std::size_t dimensions = file.Get<std::uint8_t>(at + 1);
  for (std::size_t i = 0; i < dimensions; ++i) {
    parameter.dimensions.push_back(file.Get<std::uint8_t>(at + 2 + i));
    parameter.count *= parameter.dimensions.back();
  }
  parameter.data = at + 2 + dimensions;
  return parameter;
}

Parameters ReadParameters(const Bytes& file, std::size_t section) {
  // Groups are named by entries that may come after the parameters that belong to them.
  std::map<int, std::string> groups;
  std::vector<std::pair<int, std::pair<std::string, Parameter>>> found;
  std::size_t at = section + 4;
  for (;;) {
    const std::size_t letters =
        static_cast<std::size_t>(std::abs(file.Get<std::int8_t>(at)));  // < 0: locked
    const int group = file.Get<std::int8_t>(at + 1);
    if (letters == 0 || group == 0) break;
    const std::string name = file.Text(at + 2, letters);
    const std::size_t link = at + 2 + letters;
    if (group < 0) {
      groups[-group] = name;
    } else {
      found.push_back({group, {name, ReadParameter(file, link + 2)}});
    }
    const std::size_t step = file.Get<std::uint16_t>(link);
    if (step == 0) break;
    at = link + step;
  }
  Parameters parameters;
  for (const auto& [group, entry] : found)
    parameters[groups[group] + ":" + entry.first] = entry.second;
  return parameters;
}

double NumberOf(const Bytes& file, const Parameters& parameters, const std::string& key,
                double otherwise) {
  const auto found = parameters.find(key);
  if (found == parameters.end()) return otherwise;
  if (found->second.type == 4) return static_cast<double>(file.Get<float>(found->second.data));
  if (found->second.type == 2) return file.Get<std::uint16_t>(found->second.data);
  return otherwise;
}

// A parameter of texts: its first dimension is the length of one.
std::vector<std::string> TextsOf(const Bytes& file, const Parameters& parameters,
                                 const std::string& key) {
  std::vector<std::string> texts;
  const auto found = parameters.find(key);
  if (found == parameters.end() || found->second.type != -1 || found->second.dimensions.empty())
    return texts;
  const std::size_t length = found->second.dimensions[0];
  for (std::size_t i = 0; length > 0 && i < found->second.count / length; ++i) {
    texts.emplace_back(Trim(file.Text(found->second.data + i * length, length)));
  }
  return texts;
}

std::vector<std::string> NamesOf(const Bytes& file, const Parameters& parameters,
                                 std::size_t points) {
  std::vector<std::string> names = TextsOf(file, parameters, "POINT:LABELS");
  // One parameter holds 255 names; the rest are in LABELS2, LABELS3 ...
  for (int part = 2; names.size() < points; ++part) {
    const auto more = TextsOf(file, parameters, "POINT:LABELS" + std::to_string(part));
    if (more.empty()) break;
    names.insert(names.end(), more.begin(), more.end());
  }
  if (names.size() < points) {
    file.Refuse("names for " + std::to_string(names.size()) + " of its " + std::to_string(points) +
                " points");
  }
  names.resize(points);
  return names;
}

}  // namespace

Take ReadC3d(const std::string& contents, const std::string& name) {
  const Bytes file(contents, name);
  if (file.size() < kBlock || file.Get<std::uint8_t>(1) != kKey) file.Refuse("not a C3D file");
  const std::size_t section = (std::max<std::size_t>(file.Get<std::uint8_t>(0), 1) - 1) * kBlock;
  const auto processor = file.Get<std::uint8_t>(section + 3);
  if (processor != kIntel) {
    file.Refuse("written in the number format of processor type " + std::to_string(processor) +
                "; only type 84 (Intel) can be read: export it again as such");
  }
  const Parameters parameters = ReadParameters(file, section);
  const std::size_t points = file.Get<std::uint16_t>(2);
  const std::size_t analogue = file.Get<std::uint16_t>(4);
  const auto scale = static_cast<double>(file.Get<float>(12));
  const bool reals = scale < 0;
  const std::size_t data = (std::max<std::size_t>(file.Get<std::uint16_t>(16), 1) - 1) * kBlock;

  Take take;
  take.names = NamesOf(file, parameters, points);
  take.rate_hz = NumberOf(file, parameters, "POINT:RATE", static_cast<double>(file.Get<float>(20)));
  const auto units = TextsOf(file, parameters, "POINT:UNITS");
  const double cm = CentimetresPer(units.empty() || units[0].empty() ? "mm" : units[0], name);

  const std::size_t word = reals ? 4 : 2;
  const std::size_t frame_bytes = (points * 4 + analogue) * word;
  if (frame_bytes == 0) file.Refuse("it has no points");
  const std::size_t first = file.Get<std::uint16_t>(6);
  const std::size_t last = file.Get<std::uint16_t>(8);
  if (last < first) file.Refuse("its last frame comes before its first");
  std::size_t frames = last - first + 1;
  // A longer take than 16 bits can say ends where the file does.
  if (last == kManyFrames && data < file.size()) frames = (file.size() - data) / frame_bytes;

  if (data > file.size() || (file.size() - data) / frame_bytes < frames) {
    file.Refuse("cut short: " + std::to_string(frames) + " frames of " +
                std::to_string(frame_bytes) + " bytes are announced");
  }

  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<Point3> frame;
    for (std::size_t m = 0; m < points; ++m) {
      const std::size_t at = data + f * frame_bytes + m * 4 * word;
      double xyzw[4];
      for (std::size_t i = 0; i < 4; ++i) {
        xyzw[i] = reals ? static_cast<double>(file.Get<float>(at + i * word))
                        : file.Get<std::int16_t>(at + i * word);
      }
      // The fourth number is the residual: negative where the point was not seen.
      if (xyzw[3] < 0) {
        frame.push_back({NAN, NAN, NAN});
        continue;
      }
      const double unit = reals ? cm : cm * scale;
      frame.push_back({static_cast<float>(xyzw[0] * unit), static_cast<float>(xyzw[1] * unit),
                       static_cast<float>(xyzw[2] * unit)});
    }
    take.frames.push_back(std::move(frame));
  }
  return take;
}

}  // namespace facewire::tools::markers
