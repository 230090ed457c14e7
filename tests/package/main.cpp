// A program outside the tree that uses the installed package: consumer <device file>.
#include <cstdio>
#include <exception>
#include <variant>

#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/six_psu.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const deflect::Mechanism device = deflect::read_mechanism(argv[1]);
    const auto& shape = std::get<deflect::SixPsu>(device.kinematics);

    const deflect::Pose pose = deflect::centred_pose(shape, device.workspace.nominal_slider);
    const deflect::Configuration configuration = deflect::configure(device, pose);

    std::printf("%s: %zu legs\n", device.name.c_str(), configuration.legs.size());
    for (const deflect::Actuator& actuator : configuration.actuators)
      std::printf("%s: %.3f mm\n", actuator.name.c_str(), 1e3 * actuator.value);
    return configuration.legs.size() == 6 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
