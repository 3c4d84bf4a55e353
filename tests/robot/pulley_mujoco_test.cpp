/// The way past a pulley against the spatial tendons of the simulator MuJoCo, whose side sites have the meaning of side points.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "log/log_fixture.h"
#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/pulley.h"

namespace musclesim {
namespace {

/// Points a and b on bodies that move along x, y and z; a sphere, a cylinder and a side point of the environment. Their places are not
/// those of their bodies, because MuJoCo would take that as constant.
constexpr const char* model_xml = R"(<mujoco>
  <default><joint type="slide"/><site pos="0.1 0.2 0.3"/></default>
  <worldbody>
    <body><joint axis="1 0 0"/><joint axis="0 1 0"/><joint axis="0 0 1"/><geom size="0.01"/><site name="a"/></body>
    <body><joint axis="1 0 0"/><joint axis="0 1 0"/><joint axis="0 0 1"/><geom size="0.01"/><site name="b"/></body>
    <geom name="cylinder" type="cylinder" size="0.1 0.1" pos="0.1 0.2 0.3" euler="10 20 30"/>
    <geom name="sphere" type="sphere" size="0.1" pos="0.1 0.2 0.3"/>
    <site name="side"/>
  </worldbody>
  <tendon>
    <spatial><site site="a"/><geom geom="cylinder"/><site site="b"/></spatial>
    <spatial><site site="a"/><geom geom="sphere"/><site site="b"/></spatial>
    <spatial><site site="a"/><geom geom="cylinder" sidesite="side"/><site site="b"/></spatial>
  </tendon>
</mujoco>)";

enum Tendon { over_cylinder, over_sphere, over_cylinder_with_side };

class MujocoTendons : public ::testing::Test {
 protected:
  MujocoTendons() {
    const TemporaryFolder folder;  // of this process alone: tests run side by side
    const std::string file = folder.file("tendons.xml");
    std::ofstream(file) << model_xml;
    std::array<char, 500> error{};
    model.reset(mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
    if (!model) throw std::runtime_error(error.data());
    data.reset(mj_makeData(model.get()));
  }

  void place(int type, mjtNum* places, const char* name, const Vector& point_mm) const {
    Eigen::Map<Eigen::Vector3d>(places + 3 * mj_name2id(model.get(), type, name)) = point_mm / mm_per_m;
  }
  /// Lays all tendons from a to b past the pulley, once as a cylinder, once as a sphere.
  void lay(const Pulley& pulley, const Vector& a_mm, const Vector& b_mm, const Vector& side_mm) const {
    place(mjOBJ_SITE, model->site_pos, "a", a_mm);
    place(mjOBJ_SITE, model->site_pos, "b", b_mm);
    place(mjOBJ_SITE, model->site_pos, "side", side_mm);
    for (const char* name : {"cylinder", "sphere"}) {
      place(mjOBJ_GEOM, model->geom_pos, name, pulley.center_mm);
      model->geom_size[3 * mj_name2id(model.get(), mjOBJ_GEOM, name)] = pulley.radius_mm / mm_per_m;
    }
    const auto q = Eigen::Quaterniond::FromTwoVectors(Vector::UnitZ(), pulley.axis);
    mjtNum* turn = model->geom_quat + 4 * mj_name2id(model.get(), mjOBJ_GEOM, "cylinder");
    turn[0] = q.w();
    Eigen::Map<Eigen::Vector3d>(turn + 1) = q.vec();
    mj_forward(model.get(), data.get());
  }
  void expectSame(Tendon tendon, const Way& way) const {
    EXPECT_NEAR(way.length_mm, data->ten_length[tendon] * mm_per_m, 1e-8);
    const mjtNum* gradient = data->ten_J + static_cast<std::ptrdiff_t>(tendon) * model->nv;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(-way.start_direction[i], gradient[i], 1e-9);
      EXPECT_NEAR(way.end_direction[i], gradient[3 + i], 1e-9);
    }
  }

  struct Delete {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
    void operator()(mjData* d) const { mj_deleteData(d); }
  };
  std::unique_ptr<mjModel, Delete> model;
  std::unique_ptr<mjData, Delete> data;
};

Vector randomVector(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST_F(MujocoTendons, TakeTheSameWay) {
  RandomStream random(1, "mujoco");
  int wound_count = 0;
  for (int i = 0; i < 1000; ++i) {
    Pulley pulley = {randomVector(random, 100), randomVector(random, 1).normalized(), random.uniform(20, 80), {}};
    const Vector a = pulley.center_mm + randomVector(random, 200), b = pulley.center_mm + randomVector(random, 200);
    lay(pulley, a, b, {0, 0, 0});
    const Way way = wayPast(pulley, a, b);
    wound_count += way.wound ? 1 : 0;
    expectSame(over_cylinder, way);
    pulley.axis.setZero();
    expectSame(over_sphere, wayPast(pulley, a, b));
  }
  EXPECT_GT(wound_count, 150);
}

TEST_F(MujocoTendons, TakeTheSameSide) {
  RandomStream random(2, "mujoco");
  int wound_count = 0;
  for (int i = 0; i < 1000; ++i) {
    Pulley pulley = {randomVector(random, 100), randomVector(random, 1).normalized(), random.uniform(20, 80), {}};
    const Vector across = pulley.axis.unitOrthogonal();
    const auto at = [&](double angle_rad, double least_radii, double most_radii) -> Vector {
      const Vector out = Eigen::AngleAxisd(angle_rad, pulley.axis) * across;
      return pulley.center_mm + pulley.radius_mm * random.uniform(least_radii, most_radii) * out + random.uniform(-50, 50) * pulley.axis;
    };
    // Both arcs are shorter than 180 degrees: the points are two radii away and at least 60 degrees apart.
    const double pi = std::numbers::pi, start_rad = random.uniform(0, 2 * pi);
    const Vector a = at(start_rad, 2, 4), b = at(start_rad + random.uniform(pi / 3, 5 * pi / 3), 2, 4);
    pulley.side_mm = at(random.uniform(0, 2 * pi), 1.5, 3);
    lay(pulley, a, b, *pulley.side_mm);
    const Way way = wayPast(pulley, a, b);
    wound_count += way.wound ? 1 : 0;
    expectSame(over_cylinder_with_side, way);
  }
  EXPECT_GT(wound_count, 150);
}

}  // namespace
}  // namespace musclesim
