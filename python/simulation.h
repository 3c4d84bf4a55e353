/// The class Simulation of the Python module.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "bindings.h"
#include "conversions.h"
#include "musclesim/log/recorder.h"
#include "musclesim/log/recording.h"
#include "musclesim/simulation/run_loop.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim::python {

class Interruption;

/// Everything from which a simulation can be built again.
struct Model {
  std::string robot;
  SimulationOptions options;
  std::optional<std::string> initial_state;  ///< none: the robot's own
  py::object force_law;                      ///< None: the parameters'
};

/// One run under a controller.
struct RunArguments {
  py::object controller;  ///< a name, as controllerFrom, or None: as in the program
  std::optional<double> duration_s;
  std::optional<std::string> record;  ///< file of the recording; none: in memory only
  std::optional<double> record_interval_s;
  std::optional<std::string> task;
  std::optional<Vector> target_mm;
  std::optional<double> decision_interval_s;
  std::string commands, targets, channels;  ///< files, and what to move; empty: none
  bool interpolate = false;
};

/// A simulation that can begin anew and be closed. Its arrays belong to Python and outlive it. Calls from two threads at once, and calls of
/// a controller or force law back into the simulation that asks it, are refused.
class PythonSimulation {
 public:
  explicit PythonSimulation(Model model);
  ~PythonSimulation();
  PythonSimulation(const PythonSimulation&) = delete;
  PythonSimulation& operator=(const PythonSimulation&) = delete;

  /// The world as it is: built, or stepped so far. Throws BadParameter once closed.
  Simulation& open();
  void close();
  bool isClosed() const { return !simulation_; }

  py::array start(const py::object& command, const std::optional<std::string>& initial_state, const std::optional<std::uint64_t>& seed);
  /// Sets the pressures that hold from now on.
  py::array command(const py::object& pressures);
  py::array step(const py::object& pressures, long count);
  py::array observe();
  Recording run(RunArguments arguments);

  /// Views into the array of readings.
  py::array part(const std::string& begin);
  const Model& model() const { return model_; }

 private:
  class Use;
  class Heed;
  void build();
  void begin(const std::string& initial_state);
  void requireWhole() const;
  void readAll();
  RecordingInfo describe(const std::string& initial_state, const RunArguments& arguments);
  void runInto(Recording& recording, Recorder* recorder, Controller& controller, const RunLoop& times, const std::string& initial_state);

  Model model_;
  std::unique_ptr<Simulation> simulation_;
  py::array_t<double> readings_;
  double* reading_ = nullptr;
  Action command_;
  bool was_started_ = false;       ///< the next start builds the world anew
  bool left_within_step_ = false;  ///< an exception of Python left the world between two times
  std::atomic<bool> in_use_ = false;
  Interruption* interruption_ = nullptr;
};

}  // namespace musclesim::python
