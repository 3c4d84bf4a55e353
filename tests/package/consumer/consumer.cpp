#include <musclesim/musclesim.h>

int main() {
  musclesim::Simulation simulation;
  simulation.build("rig");
  simulation.start("built", {1.0});
  simulation.step();
  return simulation.stepCount() == 1 ? 0 : 1;
}
