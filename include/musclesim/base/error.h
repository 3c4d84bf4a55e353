/// The exceptions of musclesim: one class per exit status of the program.
#pragma once

#include <stdexcept>
#include <string>

namespace musclesim {

/// Base of all errors of this library. The message is written for the user: it names what is wrong, where, and what is allowed.
class Error : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The caller made a mistake: an option, a parameter or an argument is not allowed (exit status 2).
class BadParameter : public Error {
 public:
  using Error::Error;
  /// "name = value: must be allowed", for example "rig.load_kg = -3 kg: must lie in 0 .. 1000 kg".
  BadParameter(const std::string& name, const std::string& value, const std::string& allowed)
      : Error(name + " = " + value + ": must " + allowed) {}
};

/// A file that cannot be understood (exit status 3). Lines and columns count from 1; 0 means "the file as a whole".
class BadFile : public Error {
 public:
  BadFile(const std::string& file, int line, int column, const std::string& what);
  explicit BadFile(const std::string& file, const std::string& what) : BadFile(file, 0, 0, what) {}
  const std::string& file() const { return file_; }
  int line() const { return line_; }
  int column() const { return column_; }

 private:
  std::string file_;
  int line_, column_;
};

/// The simulation diverged: a value is not finite or beyond what a physical system can have (exit status 4).
class Diverged : public Error {
 public:
  Diverged(double time_s, const std::string& where, const std::string& what);
  double time_s() const { return time_s_; }
  const std::string& where() const { return where_; }  ///< body, joint or actuator

 private:
  double time_s_;
  std::string where_;
};

/// The caller asked a simulation to stop within a step (exit status 130 or 143).
class Interrupted : public Error {
  using Error::Error;
};

/// Reading or writing failed for reasons outside the file's contents (exit status 5).
class IoError : public Error {
  using Error::Error;
};

/// ODE reported an internal error or a failed assertion. Code that knows time and place rethrows it as Diverged.
class OdeFault : public Error {
  using Error::Error;
};

}  // namespace musclesim
