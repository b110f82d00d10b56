#include "tools/facewire/open_service.h"

#include <grp.h>
#include <sys/stat.h>

#include "app/devices.h"
#include "app/error.h"

namespace facewire::tools {
namespace {

// The group that the service's socket belongs to; the folder may hide it, but then it is the usual
// one.
std::string GroupOf(const std::string& path) {
  struct stat node {};
  const group* entry = ::stat(path.c_str(), &node) == 0 ? ::getgrgid(node.st_gid) : nullptr;
  return entry == nullptr ? "facewire" : entry->gr_name;
}

}  // namespace

std::unique_ptr<hal::SerialPort> OpenService(const std::string& where, int baud) {
  auto port = app::MakeSerialPort(where, baud);
  const Result<> opened = port->Open();
  if (opened) return port;
  if (opened.error() == Errc::kNotFound) {
    throw app::BadInput("no service is at " + where +
                        "; start facewired, or give its control socket, or the port of a device");
  }
  if (opened.error() == Errc::kPermission) {
    throw app::BadInput("no permission for " + where +
                        "; add yourself to its group: sudo usermod -aG " + GroupOf(where) +
                        " $USER, then log in again");
  }
  throw app::BadInput(app::DescribeSerialError(opened.error(), where, baud));
}

}  // namespace facewire::tools
