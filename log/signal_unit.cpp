#include "musclesim/log/signal_unit.h"

#include "columns.h"
#include "musclesim/base/error.h"

namespace musclesim {

std::string signalUnit(const std::string& signal_name) {
  try {
    return parseColumnName(signal_name).unit;
  } catch (const BadParameter&) {
    return "";
  }
}

}  // namespace musclesim
