#include <fmt/format.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <utility>

#include "controllers.h"
#include "musclesim/base/error.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/force_law.h"

namespace musclesim::python {

namespace {

/// What a subclass in Python overrides. The caller need not have Python's lock.
class ForceLawOfPython : public ForceLaw {
 public:
  double tensionN(double pressure_ratio, double length_mm) const override {
    const py::gil_scoped_acquire lock;
    const py::function override = py::get_override(static_cast<const ForceLaw*>(this), "tension_N");
    if (!override) throw BadParameter("a subclass of ForceLaw must define tension_N(pressure, length_mm)");
    const py::object tension = override(pressure_ratio, length_mm);
    try {
      return tension.cast<double>();
    } catch (const py::cast_error&) {
      throw BadParameter(name() + ".tension_N", py::repr(tension).cast<std::string>(), "be a number");
    }
  }
  double stiffnessNPerMm(double pressure_ratio, double length_mm) const override {
    PYBIND11_OVERRIDE_NAME(double, ForceLaw, "stiffness_N_per_mm", stiffnessNPerMm, pressure_ratio, length_mm);
  }
  std::optional<double> restLengthMm() const override {
    PYBIND11_OVERRIDE_NAME(std::optional<double>, ForceLaw, "rest_length_mm", restLengthMm, );
  }
  /// The name of the Python class.
  std::string name() const override {
    const py::gil_scoped_acquire lock;
    return py::str(py::type::handle_of(py::cast(this)).attr("__name__")).cast<std::string>();
  }
};

/// Passes on to the C++ part of a Python object, and keeps that object.
class HeldForceLaw final : public ForceLaw {
 public:
  explicit HeldForceLaw(py::object owner) : owner_(std::move(owner)), law_(owner_.cast<const ForceLaw&>()) {}
  ~HeldForceLaw() override {
    const py::gil_scoped_acquire lock;
    owner_ = py::object();
  }
  HeldForceLaw(const HeldForceLaw&) = delete;
  HeldForceLaw& operator=(const HeldForceLaw&) = delete;

  double tensionN(double pressure_ratio, double length_mm) const override { return law_.tensionN(pressure_ratio, length_mm); }
  double formulaN(double pressure_ratio, double length_mm) const override { return law_.formulaN(pressure_ratio, length_mm); }
  double stiffnessNPerMm(double pressure_ratio, double length_mm) const override { return law_.stiffnessNPerMm(pressure_ratio, length_mm); }
  std::string name() const override { return law_.name(); }
  std::optional<double> restLengthMm() const override { return law_.restLengthMm(); }
  std::optional<double> contractedLengthMm() const override { return law_.contractedLengthMm(); }

 private:
  py::object owner_;
  const ForceLaw& law_;
};

}  // namespace

void setForceLaws(Robot& robot, const py::object& force_law) {
  if (force_law.is_none()) return;
  for (int i = 0; i < robot.actuatorCount(); ++i) {
    Actuator& muscle = *robot.actuators()[static_cast<std::size_t>(i)];
    py::object law = force_law;
    if (!py::isinstance<ForceLaw>(law) && PyCallable_Check(law.ptr())) law = law(i, muscle.minimumLengthMm(), muscle.maximumLengthMm());
    if (!py::isinstance<ForceLaw>(law))
      throw BadParameter("force_law", py::repr(law).cast<std::string>(),
                         "be an object of a subclass of ForceLaw, or a function (muscle, minimum_length_mm, maximum_length_mm) of one");
    muscle.setForceLaw(std::make_unique<HeldForceLaw>(std::move(law)));
  }
}

void bindForceLaws(py::module_& module) {
  py::class_<ForceLaw, ForceLawOfPython>(
      module, "ForceLaw",
      "Tension of a muscle over pressure and length. A subclass defines tension_N(pressure, length_mm) and, if it likes,\n"
      "stiffness_N_per_mm(pressure, length_mm) (default: a central difference) and rest_length_mm() (default: None).")
      .def(py::init<>())
      .def("tension_N", &ForceLaw::tensionN, py::arg("pressure"), py::arg("length_mm"),
           "Tension in N, pulling positive, at a pressure (fraction of full scale) and a length in mm.")
      .def("stiffness_N_per_mm", &ForceLaw::stiffnessNPerMm, py::arg("pressure"), py::arg("length_mm"), "dF/dl in N/mm.")
      .def("rest_length_mm", &ForceLaw::restLengthMm, "Length in mm of the muscle at rest; None if the law has none.")
      .def_property_readonly("name", &ForceLaw::name, "Name of the law.");
  py::class_<BraunForceLaw, ForceLaw>(module, "BraunForceLaw", "Eq. 1, the law that muscles have unless told otherwise.")
      .def(py::init<double, double>(), py::arg("minimum_length_mm"), py::arg("maximum_length_mm"));
}

}  // namespace musclesim::python
