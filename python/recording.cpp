#include "musclesim/log/recording.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "conversions.h"
#include "musclesim/base/error.h"

namespace musclesim::python {

namespace {

/// A column of the dict that becomes a recording.
struct NamedNumbers {
  std::string name;
  Numbers values;
};

std::vector<NamedNumbers> columnsFrom(const py::dict& arrays) {
  std::vector<NamedNumbers> columns;
  for (const auto& [key, values] : arrays) {
    const auto name = py::str(key).cast<std::string>();
    if (name.empty() || name.find_first_of(",\"#\r\n") != std::string::npos)
      throw BadParameter("column name", name, "be as in a recording");
    columns.push_back({name, numbersFrom(values, name)});
  }
  if (columns.empty()) throw BadParameter("a recording needs columns: time_s and the commands at least");
  for (const NamedNumbers& column : columns)
    if (column.values.size() != columns.front().values.size())
      throw BadParameter(column.name, fmt::format("shape ({},)", column.values.size()),
                         fmt::format("be ({},), as {}", columns.front().values.size(), columns.front().name));
  return columns;
}

void append(std::string& text, const std::string& name, double value) {
  if (std::isnan(value)) return;
  if (std::isinf(value)) throw BadParameter(name, fmt::format("{}", value), "be finite, or NaN where nothing was measured");
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// A file's text: the strict reader is then the only place that knows what a recording may hold. It keeps every bit.
std::string csvTextOf(const std::vector<NamedNumbers>& columns) {
  std::string text;
  for (const NamedNumbers& column : columns) text += (text.empty() ? "" : ",") + column.name;
  for (py::ssize_t row = 0; row < columns.front().values.size(); ++row) {
    text += '\n';
    for (const NamedNumbers& column : columns) {
      if (&column != &columns.front()) text += ',';
      append(text, column.name, column.values.data()[row]);
    }
  }
  return text + '\n';
}

Recording recordingFrom(const py::dict& arrays, const std::string& robot, const py::kwargs& members) {
  py::dict sidecar;
  sidecar["format"] = "musclesim-recording-1";
  sidecar["robot"] = robot;
  for (const auto& [name, value] : members) sidecar[name] = value;
  const std::string text = csvTextOf(columnsFrom(arrays));
  Recording recording = parseRecording(text, "arrays", toJson(sidecar), "sidecar members");
  recording.file.clear();
  return recording;
}

std::vector<std::string> namesOf(const Recording& recording) {
  std::vector<std::string> names = {"time_s"};
  for (const Signal& signal : recording.signals) names.push_back(signal.name);
  return names;
}

py::array_t<double> columnOf(const py::object& self, const std::string& name) {
  const auto& recording = self.cast<const Recording&>();
  if (name == "time_s") return viewOf(recording.time_s, self);
  if (const Signal* signal = recording.find(name)) return viewOf(signal->values, self);
  const std::vector<std::string> names = namesOf(recording);
  const std::string nearest = nearestName(name, names);
  throw py::key_error(fmt::format("there is no column {}{}; the columns are {}", name,
                                  nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest), fmt::join(names, ", ")));
}

py::dict toDict(const py::object& self) {
  py::dict arrays;
  for (const std::string& name : namesOf(self.cast<const Recording&>())) arrays[py::str(name)] = columnOf(self, name);
  return arrays;
}

std::string textOf(const Recording& recording) {
  return fmt::format("<musclesim.Recording of {}: {} rows, {} signals>", recording.info.robot, recording.time_s.size(),
                     recording.signals.size());
}

}  // namespace

void bindRecording(py::module_& module) {
  py::class_<Recording>(module, "Recording",
                        "What was commanded and measured in one run: columns over time. recording[\"length_0_mm\"] is a read-only array.")
      .def_static(
          "read",
          [](const std::filesystem::path& file, std::vector<std::string> ignore) {
            return readRecording(file.string(), {std::move(ignore)});
          },
          py::arg("file"), py::arg("ignore_columns") = std::vector<std::string>(),
          "Reads NAME.csv with NAME.json beside it, strictly. Units become mm, deg, N and fractions of full scale.")
      .def_static(
          "from_dict", &recordingFrom, py::arg("arrays"), py::arg("robot"),
          "A recording from columns in memory.\n\n"
          "arrays: {name: array of shape (rows,)}: time_s (s, increasing), command_<i> per muscle, and what was measured; NaN: not\n"
          "measured. Names and units are those of a recording's columns: length_0_mm, pressure_0_kPa, angle_elbow_deg, ...\n"
          "robot and further arguments: the sidecar's members: physics, initial_state, robot_parameters, noise_std, ...\n"
          "Recording.from_dict(recording.to_dict(), **recording.info) gives the same recording. Raises BadParameter or BadFile.")
      .def(
          "write", [](const Recording& recording, const std::filesystem::path& file) { writeRecording(recording, file.string()); },
          py::arg("file"), py::call_guard<py::gil_scoped_release>(),
          "Writes NAME.csv and NAME.json; existing files are replaced. Every bit is kept.")
      .def("to_dict", &toDict, "All columns by name, time_s first: read-only arrays of shape (rows,), without copies.")
      .def("keys", &namesOf, "Names of all columns, time_s first.")
      .def("__iter__", [](const Recording& r) { return py::iter(py::cast(namesOf(r))); })
      .def(
          "__reduce__",
          [](const py::object& self) {
            const py::object rebuilt = py::module_::import("musclesim.recording").attr("_rebuilt");
            return py::make_tuple(rebuilt, py::make_tuple(self.attr("to_dict")(), self.attr("info")));
          },
          "For copies and other processes; the copy has no file.")
      .def("__getitem__", &columnOf, py::arg("name"), "A column: a read-only array of shape (rows,), in mm, deg, N or fractions.")
      .def("__contains__", [](const Recording& r, const std::string& name) { return name == "time_s" || r.find(name) != nullptr; })
      .def("__len__", [](const Recording& r) { return r.time_s.size(); })
      .def("__repr__", &textOf)
      .def_property_readonly(
          "robot", [](const Recording& r) { return r.info.robot; }, "Name or file of the robot.")
      .def_property_readonly(
          "info", [](const Recording& r) { return fromJson(sidecarText(r.info)); },
          "The sidecar's members as a dict: robot, physics, seed, ...")
      .def_readonly("notes", &Recording::notes, "Remarks of the reader: what it converted, skipped or found unusual.")
      .def_readonly("file", &Recording::file, "The file it was read from; empty if it was made in memory.");
}

}  // namespace musclesim::python
