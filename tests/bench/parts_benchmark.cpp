/// Cost of the parts of a step, measured with google-benchmark. The target parts_benchmark exists if that library is installed.
#include <benchmark/benchmark.h>

#include <memory>

#include "../../simulation/chain/chain_bundle.h"
#include "../../simulation/chain/step_problem.h"
#include "../../simulation/chain/tiled_matrix.h"
#include "../../simulation/contacts.h"
#include "simulation/step_comparison.h"

using namespace musclesim;

namespace {

/// An arm in `si` that has moved for 0.1 s.
std::unique_ptr<Simulation> movingArm(int muscle_count, const std::string& parameter = "") {
  SimulationOptions options;
  options.step_s = 8e-4;
  options.parameters.set("arm.muscle_count", static_cast<double>(muscle_count), "benchmark");
  if (!parameter.empty()) options.parameters.setFromText(parameter, "benchmark");
  auto simulation = std::make_unique<Simulation>(std::move(options));
  simulation->build("arm");
  RandomStream random(1, "benchmark");
  Action command;
  for (int i = 0; i < muscle_count; ++i) command.push_back(random.uniform());
  simulation->robot().step(command);
  for (int i = 0; i < 125; ++i) simulation->step();
  return simulation;
}

void wholeStep(benchmark::State& state, const std::string& parameter) {
  const auto simulation = movingArm(static_cast<int>(state.range(0)), parameter);
  for (auto _ : state) simulation->step();
}
BENCHMARK_CAPTURE(wholeStep, contacts, "physics.contacts=on")->Arg(1)->Arg(10)->Arg(30);
BENCHMARK_CAPTURE(wholeStep, no_contacts, "physics.contacts=off")->Arg(1)->Arg(10)->Arg(30);
BENCHMARK_CAPTURE(wholeStep, viscous, "muscle.joint_friction=viscous")->Arg(1)->Arg(10)->Arg(30);
BENCHMARK_CAPTURE(wholeStep, line, "muscle.model=line")->Arg(1)->Arg(10)->Arg(30);

void collision(benchmark::State& state) {
  const auto simulation = movingArm(static_cast<int>(state.range(0)));
  Contacts contacts(simulation->world(), simulation->space(), 0);
  for (auto _ : state) contacts.collide(simulation->world().revision());
}
BENCHMARK(collision)->Arg(1)->Arg(10)->Arg(30);

void registering(benchmark::State& state) {
  const auto simulation = movingArm(static_cast<int>(state.range(0)));
  chain::Model model;
  for (auto _ : state) benchmark::DoNotOptimize(chain::registerModel(*simulation, model));
}
BENCHMARK(registering)->Arg(10);

/// Reading all bodies from ODE and writing them back.
void gatherAndScatter(benchmark::State& state) {
  const auto simulation = movingArm(static_cast<int>(state.range(0)));
  chain::Model model;
  chain::registerModel(*simulation, model);
  for (auto _ : state) {
    model.bodies.gather();
    model.bodies.scatter();
  }
}
BENCHMARK(gatherAndScatter)->Arg(10)->Arg(30);

/// Makes the rows of all joints.
void jointRows(benchmark::State& state) {
  const auto simulation = movingArm(static_cast<int>(state.range(0)));
  chain::Model model;
  chain::registerModel(*simulation, model);
  model.bodies.gather();
  chain::JointRows rows;
  for (auto _ : state)
    for (chain::Chain& chain : model.chains)
      for (chain::JointModel& joint : chain.joints) {
        chain::makeRows(joint, model.bodies, 8e-4, {0.4, 0.4}, rows);
        benchmark::DoNotOptimize(rows);
      }
}
BENCHMARK(jointRows)->Arg(10)->Arg(30);

/// Elimination and back substitution of four chains of the given number of beads, each with the three rows of its start.
void fourChains(benchmark::State& state) {
  const auto bead_count = static_cast<int>(state.range(0));
  RandomStream random(1, "benchmark");
  chain::ChainBundle<4> bundle({bead_count, bead_count, bead_count, bead_count});
  bundle.reserve(3);
  for (int lane = 0; lane < 4; ++lane) {
    bundle.setInertia(lane, {0.1, 0.02});
    for (int joint = 0; joint < bead_count; ++joint) {
      chain::JointRows rows;
      rows.row_count = joint + 1 < bead_count ? 6 : 3;
      const bool slider = joint % 2 == 0;
      for (int row = 0; row < rows.row_count; ++row) {
        rows.softness[row] = 1e-3;
        const bool holds = row < 3;
        for (int i = 0; i < 6; ++i) {
          const bool zero = i < 3 ? slider == holds : slider && holds;
          const bool one = holds && i == (slider ? 3 + row : row);
          rows.jacobian[0][row][i] = one ? 1 : zero || (holds && i < 3) ? 0 : random.normal();
          rows.jacobian[1][row][i] = (slider && !holds && i >= 3 ? 1 : -1) * rows.jacobian[0][row][i];
        }
      }
      bundle.setJoint(lane, joint, rows, 8e-4);
      bundle.setFreeMotion(lane, joint, chain::Vector6::Ones());
    }
    for (int row = 0; row < 3; ++row) {
      double jacobian[6];
      for (double& entry : jacobian) entry = random.normal();
      bundle.addBorder(lane, row, 0, jacobian);
    }
  }
  bundle.makeBlocks();
  for (auto _ : state) {
    bundle.eliminate();
    bundle.substitute();
    benchmark::DoNotOptimize(bundle.largestVelocity());
  }
}
BENCHMARK(fourChains)->Arg(8)->Arg(12);

/// One linear solve of the active set that eliminates all chains again.
void linearSolve(benchmark::State& state) {
  const auto simulation = movingArm(static_cast<int>(state.range(0)));
  const PhysicsSettings& physics = simulation->physics();
  Contacts contacts(simulation->world(), simulation->space(), physics.contact_friction_N * physics.force_per_N);
  contacts.collide(simulation->world().revision());
  chain::Model model;
  chain::registerModel(*simulation, model);
  chain::StepProblem problem(model);
  model.bodies.gather();
  chain::StepProblem::Conditions conditions;
  conditions.h_s = simulation->internalStepS();
  conditions.gravity = simulation->world().gravityMmPerS2();
  conditions.force_per_N = physics.force_per_N;
  conditions.friction_force = contacts.frictionLimit();
  conditions.reduction = {0.4, 0.4};
  conditions.contact_reduction = 0.4;
  conditions.world_softness = conditions.contact_softness = dWorldGetCFM(simulation->world());
  if (!problem.begin(conditions, contacts.points())) return state.SkipWithError("the problem cannot be set up");
  for (auto _ : state) {
    for (std::size_t row = 0; row < problem.rows().size(); ++row) problem.changed(static_cast<int>(row));
    problem.solve(problem.rows());
  }
}
BENCHMARK(linearSolve)->Arg(10)->Arg(30);

/// Factorising and solving a full matrix of the given number of rows.
void denseCore(benchmark::State& state) {
  const auto size = static_cast<int>(state.range(0));
  chain::TiledMatrix matrix;
  std::vector<double> x(static_cast<std::size_t>(size) + chain::tile_width, 1.0);
  for (auto _ : state) {
    matrix.reset(size);
    for (int j = 0; j < size; ++j)
      for (int i = j; i < size; ++i) matrix.add(i, j, i == j ? size : 1.0 / (1 + i - j));
    matrix.factorise();
    matrix.solve(x.data());
  }
}
BENCHMARK(denseCore)->Arg(51)->Arg(100)->Arg(200)->Arg(300);

}  // namespace

BENCHMARK_MAIN();
