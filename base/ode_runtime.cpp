#include "ode_runtime.h"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <mutex>

#include "musclesim/base/error.h"

namespace musclesim::ode_runtime {

namespace {

std::string formatted(const char* format, va_list arguments) {
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

[[noreturn]] void throwError(int number, const char* format, va_list arguments) {
  throw OdeFault("ODE error " + std::to_string(number) + ": " + formatted(format, arguments));
}

[[noreturn]] void throwDebug(int number, const char* format, va_list arguments) {
  throw OdeFault("ODE assertion " + std::to_string(number) + ": " + formatted(format, arguments));
}

void countMessage(int, const char* format, va_list arguments) {
  auto& messages = messagesOfThread();
  ++messages.count;
  messages.last = formatted(format, arguments);
}

}  // namespace

Messages& messagesOfThread() {
  thread_local Messages messages;
  return messages;
}

void prepareThread() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (!dCheckConfiguration("ODE_double_precision")) throw OdeFault("ODE was built with single precision; double precision is needed");
    if (!dInitODE2(0)) throw OdeFault("ODE cannot be initialised");
    dSetErrorHandler(throwError);
    dSetDebugHandler(throwDebug);
    dSetMessageHandler(countMessage);
  });
  thread_local const bool allocated = dAllocateODEDataForThread(dAllocateMaskAll) != 0;
  if (!allocated) throw OdeFault("ODE cannot allocate its data for this thread");
}

}  // namespace musclesim::ode_runtime
